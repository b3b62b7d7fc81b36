// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/replay.h"

#include "core/rig.h"
#include "src/files/disk/sha256.h"
#include "src/files/recording/description.h"
#include "src/files/rig/rig_file.h"
#include "src/fleet/content.h"
#include "src/fleet/stretch.h"
#include "src/fleet/stretch_result.h"
#include "src/fleet/stretch_tables.h"
#include "src/fleet/task_name.h"
#include "src/images/image_frames.h"
#include "src/replay/tag_finder.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace fidservo::fleet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class StretchTasks {
  public:
    StretchTasks(const ReplayRequest& request, const Rig& rig, ImageFrames& frames,
                 const std::vector<Stretch>& stretches, const ResultStore& store)
        : request_(request),
          rig_(rig),
          frames_(frames),
          stretches_(stretches),
          store_(store),
          rig_content_(content_of_files(files_of_rig(request.rig_file))) {}

    TaskEnd work(std::size_t task) const {
        const Stretch& stretch = stretches_[task];
        const std::string content = content_of_stretch(stretch);
        const ResultName name = name_of(stretch, content);
        if (auto end = end_if_there(store_, name)) return *std::move(end);
        Json result = head_of(stretch, content, name);
        result["images"] = search(stretch);
        if (content_of_stretch(stretch) != content)
            return {.outcome = Outcome::undone, .text = "its images changed while they were searched"};
        return publish(name, result, "");
    }

    /// Whether a stretch has its result, made from the images as they are now.
    TaskEnd look(std::size_t task) const {
        const Stretch& stretch = stretches_[task];
        if (auto end = end_if_there(store_, name_of(stretch, content_of_stretch(stretch))))
            return *std::move(end);
        return {.outcome = Outcome::undone, .text = "it has no result"};
    }

    TaskEnd say_crash(std::size_t task, std::string_view signal) const {
        const Stretch& stretch = stretches_[task];
        const std::string content = content_of_stretch(stretch);
        const ResultName name = name_of(stretch, content);
        Json result = head_of(stretch, content, name);
        result["status"] = "failed";
        result["reason"] = why_crashed(signal);
        return publish(name, result, why_crashed(signal));
    }

  private:
    /// Calls with each frame of a stretch, as ImageFrames gives it.
    template <class Take>
    void each_frame(const Stretch& stretch, Take take) const {
        frames_.seek(stretch.series, stretch.first);
        for (std::size_t k = 0; stretch.is_open || k < stretch.count; ++k) {
            auto frame = frames_.next();
            if (!frame || (stretch.is_open && frame->series != stretch.series)) return;
            take(*std::move(frame));
        }
    }

    /// Of a video its file; of images what they are read from, page and bits, and when they were taken.
    std::string content_of_stretch(const Stretch& stretch) const {
        const ImageFrames::Series series = frames_.series()[stretch.series];
        if (series.is_video) return sha256_of_file(series.name);
        std::string all, last_content;
        fs::path last;
        each_frame(stretch, [&](const ImageFrame& frame) {
            if (frame.file != last) last_content = sha256_of_file(frame.file);
            last = frame.file;
            all += fmt::format("{} {} {} {} {}\n", last_content, frame.page, frame.bits,
                               frame.time_ns ? fmt::format("{}", *frame.time_ns) : "-", frame.from_recording);
        });
        return sha256(all);
    }

    ResultName name_of(const Stretch& stretch, const std::string& content) const {
        const TagPrint& print = request_.reading.print;
        const Json inputs{{"kind", "replay"},
                          {"content", content},
                          {"first", stretch.first},
                          {"count", stretch.count},
                          {"rig", rig_content_},
                          {"rig_is_given", request_.rig_is_given},
                          {"family", print.family->name},
                          {"border_cells", print.border_cells},
                          {"inverted", print.inverted},
                          {"mirrored", request_.reading.mirrored},
                          {"program", this_program()}};
        return {stretch.stem(), sha256(inputs.dump())};
    }

    Json head_of(const Stretch& stretch, const std::string& content, const ResultName& name) const {
        return {{"format", result_format},
                {"task",
                 {{"kind", "replay"},
                  {"input", stretch.noted},
                  {"first", stretch.first},
                  {"last", stretch.count == 0 ? Json() : Json(stretch.first + stretch.count - 1)},
                  {"content", content}}},
                {"rig", {{"name", rig_.name}, {"content", rig_content_}}},
                {"program", this_program()},
                {"effort", nullptr},
                {"key", name.key},
                {"status", "done"}};
    }

    Json search(const Stretch& stretch) const {
        TagFinder finder(request_.rig_is_given ? rig_.camera : std::nullopt, request_.reading);
        Json images = Json::array();
        const auto series = frames_.series();
        each_frame(stretch, [&](ImageFrame frame) {
            // Of images given by name the series has the first one's name.
            const std::string& whole = series[frame.series].name;
            const std::string path = frame.file.string().starts_with(whole) ? whole : frame.file.string();
            if (load(frame)) {
                images.push_back(frame_json(finder(std::move(frame)), ""));
                return;
            }
            const std::string damage = as_noted(frame.damage, path, noted_path(path));
            images.push_back(frame_json({{}, std::move(frame), {}}, damage));
        });
        return images;
    }

    TaskEnd publish(const ResultName& name, const Json& result, std::string why) const {
        return publish_result(store_, name, result.dump(-1, ' ', false, Json::error_handler_t::replace),
                              std::move(why));
    }

    const ReplayRequest& request_;
    const Rig& rig_;
    ImageFrames& frames_;
    const std::vector<Stretch>& stretches_;
    const ResultStore& store_;
    std::string rig_content_;
};

/// The results of tasks that other shares were to make; empty: not all of them are there.
std::optional<std::map<std::size_t, std::string>> made_by_others(const StretchTasks& tasks, std::size_t count,
                                                                 const FleetEnd& own,
                                                                 const RunOptions& options) {
    std::vector<std::size_t> others;
    for (std::size_t task = 0; task < count; ++task)
        if (!own.done.contains(task)) others.push_back(task);
    std::map<std::size_t, std::string> files;
    const TaskWork look{.work = [&](std::size_t task) { return tasks.look(task); },
                        .say_crash = [](std::size_t, std::string_view) { return TaskEnd(); }};
    run_in_processes(others, look, worker_options(options), [&](std::size_t task, const TaskEnd& end) {
        if (end.outcome == Outcome::was_made) files[task] = end.file;
    });
    if (files.size() < others.size()) return std::nullopt;
    return files;
}

/// Whether the results' folder has a file for each stretch: a look at names alone.
bool may_be_all_there(const fs::path& folder, const std::vector<Stretch>& stretches) {
    std::set<std::string> stems;
    for (const auto& entry : fs::directory_iterator(folder))
        stems.insert(stem_of_result(entry.path().filename().string()));
    return std::ranges::all_of(stretches,
                               [&](const Stretch& stretch) { return stems.contains(stretch.stem()); });
}

}  // namespace

int replay_fleet(const ReplayRequest& request, const Rig& rig) {
    ImageFrames frames(request.inputs, {.name_times = request.name_times});
    for (const std::string& note : frames.notes()) spdlog::info("{}", note);
    frames.pause();
    const std::vector<Stretch> stretches = stretches_of(frames.series());
    const ResultStore store = open_store(request.run);
    const StretchTasks tasks(request, rig, frames, stretches, store);
    const TaskWork work{.work = [&](std::size_t task) { return tasks.work(task); },
                        .say_crash = [&](std::size_t task,
                                         std::string_view signal) { return tasks.say_crash(task, signal); }};
    const auto name_of = [&](std::size_t task) {
        return fmt::format("{}, from image {}", frames.series()[stretches[task].series].name,
                           stretches[task].first);
    };
    FleetEnd own = run_fleet(store, request.run, "stretches of images", stretches.size(), work, name_of);
    if (own.exit_code != 0 || !may_be_all_there(store.folder(), stretches)) return own.exit_code;
    auto others = made_by_others(tasks, stretches.size(), own, request.run);
    if (!others) return own.exit_code;
    own.done.merge(*others);
    write_replay_tables(request.run.out, store.folder(), frames, stretches, own.done, rig.fiducials->side_mm);
    return own.exit_code;
}

}  // namespace fidservo::fleet

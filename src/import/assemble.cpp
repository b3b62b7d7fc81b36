// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/assemble.h"

#include "core/input_error.h"
#include "src/files/rig/plate_file.h"
#include "src/import/assemble_stage.h"
#include "src/import/signal_times.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

void add_detections(SignalSource& source, const ImportMap& map, Assembled& made) {
    if (map.detections.empty()) return;
    std::map<std::string, TimedSignal> signals;
    for (const auto& [name, choice] : map.detections) {
        const std::string_view unit = name == "tag_id" || name == refined_title ? ""
                                      : name.size() > 4                         ? "px^2"
                                                                                : "px";
        signals[name] = source.timed(choice, unit, true);
    }
    const TimedSignal& ids = signals.at("tag_id");
    for (const auto& [name, signal] : signals)
        if (signal.time_ns != ids.time_ns)
            map.detections.at(name).where->fail(fmt::format("{}: has other times than tag_id", name));
    const auto value = [&](std::string_view title, std::size_t row) {
        return signals.at(std::string(name_of_title(title))).values[row];
    };
    const bool has_covariances = signals.contains("p0_xx"),
               has_refined = signals.contains(std::string(refined_title));
    for (std::size_t row = 0; row < ids.values.size(); ++row) {
        TagDetection tag;
        tag.time_ns = ids.time_ns[row];
        constexpr double most_id = 1e6;
        const double id = ids.values[row];
        if (!(id >= 0.0 && id <= most_id) || id != std::floor(id))
            throw InputError(fmt::format("{}: {}: value {}: {} is no tag's number", ids.log->file.string(),
                                         ids.signal->name, row + 1, id));
        tag.tag_id = static_cast<int>(id);
        for (std::size_t k = 0; k < 4; ++k)
            tag.corners_px[k] = {value(corner_titles[2 * k], row), value(corner_titles[2 * k + 1], row)};
        if (std::ranges::any_of(tag.corners_px, [](const auto& corner) { return !corner.allFinite(); }))
            throw InputError(
                fmt::format("{}: the detection {} lacks a corner", ids.log->file.string(), row + 1));
        if (has_refined && !std::isnan(value(refined_title, row)))
            tag.is_refined = value(refined_title, row) != 0.0;
        if (has_covariances && !std::isnan(value(covariance_titles.front(), row))) {
            CornerCovariances covariances;
            for (std::size_t k = 0; k < 4; ++k) {
                const double xy = value(covariance_titles[3 * k + 1], row);
                covariances[k] << value(covariance_titles[3 * k], row), xy, xy,
                    value(covariance_titles[3 * k + 2], row);
            }
            tag.covariances_px2 = covariances;
        }
        made.recording.detections.push_back(tag);
    }
    made.notes.push_back(fmt::format("detections: {} of {}", ids.values.size(), ids.log->file.string()));
}

const LoggedCamera& find_camera(const std::vector<Log>& logs, const std::string& name,
                                const YamlValue& where) {
    std::string names;
    for (const Log& log : logs)
        for (const LoggedCamera& camera : log.cameras) {
            if (camera.name == name) return camera;
            names += (names.empty() ? "" : ", ") + camera.name;
        }
    where.fail(fmt::format("{}: there is no such camera; there {}", name,
                           names.empty() ? "is none" : "are " + names));
}

void add_camera(const std::vector<Log>& logs, SignalSource& source, const ImportMap& map, Assembled& made) {
    if (!map.camera) return;
    made.camera = &find_camera(logs, map.camera->images, *map.camera->where);
    made.frame_times_ns = source.on_recording_clock(made.camera->times_ns, map.camera->clock);
    for (TimeNs& time : made.frame_times_ns) time += nanoseconds(map.camera->offset_s);
    const auto before = std::ranges::adjacent_find(made.frame_times_ns, std::greater_equal<>());
    if (before != made.frame_times_ns.end())
        map.camera->where->fail(fmt::format("images: {}: times do not rise: {} ns, then {} ns",
                                            map.camera->images, *before, *(before + 1)));
    if (!map.camera->info.empty()) {
        for (const Log& log : logs)
            if (const auto text = log.texts.find(map.camera->info); text != log.texts.end())
                made.camera_info = text->second;
        if (made.camera_info.empty())
            map.camera->where->fail(fmt::format("info: {}: there is no such CameraInfo", map.camera->info));
    }
    made.notes.push_back(fmt::format("frames: {} of {}", made.frame_times_ns.size(), made.camera->name));
}

}  // namespace

Assembled assemble(const std::vector<Log>& logs, const ImportMap& map) {
    Assembled made;
    made.recording = map.stated;
    made.origin = map.origin;
    made.origin.program = this_program();
    made.decimals.fill(-1);
    SignalSource source(logs, map);
    made.notes = source.notes();
    add_stage(source, map, made);
    add_detections(source, map, made);
    add_camera(logs, source, map, made);
    if (made.recording.tick_s == 0.0)
        throw InputError(fmt::format("{}: recording.tick_s: missing: there are no columns that tell it",
                                     map.file.string()));
    if (!map.plate.empty()) made.recording.plate = load_plate(map.plate).tags;
    return made;
}

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/frame_looks.h"

#include "core/parallel.h"
#include "gap/budget.h"
#include "src/images/grey_range.h"
#include "src/images/image_frame.h"
#include "vision/images/image_file.h"
#include "vision/tags/tag_appearance.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using Detections = std::vector<const TagDetection*>;

/// By the frame that they are in.
std::map<TimeNs, Detections> by_frame(const Recording& recording) {
    std::map<TimeNs, Detections> frames;
    for (const TagDetection& detection : recording.detections)
        frames[detection.time_ns].push_back(&detection);
    return frames;
}

/// How far a tag has moved since the frame before, px; 0 where it was not seen there.
double moved_px(const Detections& before, const Detections& now) {
    double most = 0.0;
    for (const TagDetection* tag : now) {
        const auto same = std::ranges::find(before, tag->tag_id, &TagDetection::tag_id);
        if (same != before.end()) most = std::max(most, (tag->corners_px[0] - (*same)->corners_px[0]).norm());
    }
    return most;
}

std::vector<TagAppearance> looks_of(const Detections& detections, const cv::Mat& image) {
    std::vector<TagAppearance> looks;
    for (const TagDetection* tag : detections) looks.push_back(vision::tag_appearance(image, *tag));
    return looks;
}

/// A frame that is to be measured.
struct Task {
    std::size_t recording;
    std::filesystem::path file;
    Detections detections;
    int bits = 16;  ///< of samples of more than 8 bits, in all frames of the recording
    std::vector<TagAppearance> looks = {};
    bool is_readable = true;
};

void measure(Task& task) {
    ImageFrame frame{.name = task.file.string(), .file = task.file, .bits = task.bits};
    task.is_readable = load(frame);
    if (task.is_readable) task.looks = looks_of(task.detections, frame.decoded);
}

/// One range for the frames of a recording.
void decide_bits(std::span<Task> tasks) {
    std::vector<DeepImage> deep;
    for (const Task& task : tasks)
        if (const auto pages = vision::list_pages(task.file); pages && pages->front().is_deep)
            deep.push_back({task.file, pages->front().page});
    const int bits = levels_of(deep).bits();
    for (Task& task : tasks) task.bits = bits;
}

}  // namespace

std::vector<FrameName> chosen_frames(const Recording& recording, std::size_t most) {
    const std::map<TimeNs, Detections> detections = by_frame(recording);
    struct Choice {
        const FrameName* frame;
        double moved_px;
    };
    std::vector<Choice> open;
    const Detections* before = nullptr;
    for (const FrameName& frame : recording.frames) {
        const auto here = detections.find(frame.time_ns);
        if (here != detections.end())
            open.push_back({&frame, before == nullptr ? 0.0 : moved_px(*before, here->second)});
        before = here == detections.end() ? nullptr : &here->second;
    }
    std::set<const FrameName*> chosen;
    const auto choose_evenly = [&](std::size_t number) {
        number = std::min(number, open.size());
        for (std::size_t k = 0; k < number; ++k) chosen.insert(open[k * open.size() / number].frame);
    };
    if (open.size() <= most) {
        choose_evenly(most);
    } else {
        choose_evenly(most - most / 2);
        std::erase_if(open, [&](const Choice& choice) { return chosen.contains(choice.frame); });
        std::ranges::stable_sort(open, std::greater{}, &Choice::moved_px);
        open.resize(most / 2);
        choose_evenly(most / 2);
    }
    std::vector<FrameName> frames;
    for (const FrameName& frame : recording.frames)
        if (chosen.contains(&frame)) frames.push_back(frame);
    return frames;
}

void add_appearances(Recording& recording, TimeNs time_ns, const cv::Mat& image) {
    Detections here;
    for (auto tag = recording.detections.rbegin(); tag != recording.detections.rend(); ++tag)
        if (tag->time_ns == time_ns) here.push_back(&*tag);
    for (const TagAppearance& look : looks_of(here, image)) recording.appearances.push_back(look);
}

std::vector<std::string> measure_frames(std::span<Recording> recordings,
                                        std::span<const std::filesystem::path> folders,
                                        const std::function<bool()>& interrupted) {
    constexpr std::size_t most_frames = 1200;
    std::vector<std::string> notes;
    const auto with_frames =
        std::ranges::count_if(recordings, [](const Recording& one) { return !one.frames.empty(); });
    std::vector<Task> tasks;
    for (std::size_t k = 0; k < recordings.size(); ++k) {
        const Recording& recording = recordings[k];
        if (recording.frames.empty()) continue;
        if (recording.detections.empty()) {
            notes.push_back(
                fmt::format("{}: image: frames are not judged without cam0/detections.csv; fidservo replay "
                            "finds the tags",
                            recording.name));
            continue;
        }
        const std::map<TimeNs, Detections> detections = by_frame(recording);
        const std::size_t first = tasks.size();
        for (const FrameName& frame :
             chosen_frames(recording, most_frames / static_cast<std::size_t>(with_frames)))
            tasks.push_back({.recording = k,
                             .file = folders[k] / "cam0" / "data" / frame.filename,
                             .detections = detections.at(frame.time_ns)});
        decide_bits(std::span(tasks).subspan(first));
    }
    parallel_for(tasks.size(), [&](std::size_t k) {
        if (interrupted && interrupted()) throw gap::BudgetEnded(gap::Ended::interrupted);
        measure(tasks[k]);
    });
    std::map<std::size_t, std::size_t> missing;
    for (Task& task : tasks) {
        std::vector<TagAppearance>& all = recordings[task.recording].appearances;
        all.insert(all.end(), task.looks.begin(), task.looks.end());
        if (!task.is_readable) ++missing[task.recording];
    }
    for (const auto& [k, count] : missing)
        notes.push_back(fmt::format(
            "{}: image: {} of the frames that cam0/data.csv lists are not there or cannot be read",
            recordings[k].name, count));
    return notes;
}

}  // namespace fidservo::diagnose

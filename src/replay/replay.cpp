// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/replay/replay.h"

#include "core/camera/camera_parameters.h"
#include "src/images/ordered_work.h"
#include "src/process/progress.h"
#include "src/replay/replay_tables.h"
#include "src/replay/tag_finder.h"
#include "vision/displacement.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/utility.hpp>

namespace fidservo {

namespace {

/// While it lives, OpenCV works in the thread that calls it: with an image a core, its own threads would only
/// take the cores from each other.
class OpenCvInCallersThread {
  public:
    OpenCvInCallersThread() { cv::setNumThreads(1); }
    ~OpenCvInCallersThread() { cv::setNumThreads(before_); }
    OpenCvInCallersThread(const OpenCvInCallersThread&) = delete;
    OpenCvInCallersThread& operator=(const OpenCvInCallersThread&) = delete;

  private:
    int before_ = cv::getNumThreads();
};

}  // namespace

ReplayCount replay(ImageFrames& frames, double tag_side_mm, const std::filesystem::path& folder,
                   unsigned threads, const std::optional<CameraParameters>& camera,
                   const vision::TagReading& reading) {
    const OpenCvInCallersThread one_image_a_core;
    std::map<std::size_t, vision::DisplacementTracker> trackers;  // by series
    ReplayTables tables(folder, frames.is_one_timed_series());
    Progress progress("images", frames.size());
    ReplayCount count{.images = ImageTally(frames.missing()), .tags = 0, .sample = {}};
    const auto make_worker = [&] {
        return [finder = TagFinder(camera, reading)](ImageFrame frame) mutable {
            return load(frame) ? finder(std::move(frame)) : FrameResult{{}, std::move(frame), {}};
        };
    };
    const auto take = [&](const FrameResult& result) {
        count.images.add(result.frame);
        progress.advance();
        if (!result.frame.damage.empty()) return;
        auto& tracker = trackers.try_emplace(result.frame.series, tag_side_mm).first->second;
        std::vector<std::string> detections;
        for (const TagDetection& tag : result.tags) detections.push_back(detection_row(tag));
        tables.add(result.frame, detections, tracker.add(result.refined));
        count.tags += result.tags.size();
        count.sample.offer(result.grey, result.tags.size(), !result.frame.from_recording);
    };
    run_in_order([&] { return frames.next(); }, make_worker, take, threads);
    tables.close();
    progress.finish();
    return count;
}

}  // namespace fidservo

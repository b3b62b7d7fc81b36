#include "src/replay/replay.h"

#include "core/camera_parameters.h"
#include "core/input_error.h"
#include "core/result.h"
#include "src/images/ordered_work.h"
#include "src/progress.h"
#include "src/recording/durable_file.h"
#include "src/recording/layout.h"
#include "src/recording/row_format.h"
#include "src/replay/tag_finder.h"
#include "vision/displacement.h"

#include <map>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

namespace fidservo {

namespace {

void check(const Status& status) {
    if (!status) throw RunFault(status.error().text);
}

DurableFile create(const std::filesystem::path& file) {
    auto created = DurableFile::create(file);
    if (!created) throw RunFault(created.error().text);
    return *std::move(created);
}

/// A field that holds any file name: quoted where it must be.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
    return quoted + '"';
}

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

class ReplayTables {
  public:
    ReplayTables(const std::filesystem::path& folder, bool with_times)
        : with_times_(with_times),
          detections_(create(folder / "detections.csv")),
          displacements_(create(folder / "displacements.csv")) {
        const std::string key = fmt::format("#{},tag_id", with_times ? time_title : "image");
        check(detections_.append(
            fmt::format("{},{}\n", key, corners_header(CornerColumns::places_and_covariances))));
        check(displacements_.append(key + ",dx [um],dy [um],dx_std [um],dy_std [um]\n"));
    }

    void add(const FrameResult& result, const std::vector<vision::Displacement>& displacements) {
        const std::string key =
            with_times_ ? fmt::format("{}", result.frame.time_ns.value()) : csv_field(result.frame.name);
        std::string text;
        for (const TagDetection& tag : result.tags) {
            text += fmt::format("{},{}", key, tag.tag_id);
            append_corners(text, tag, CornerColumns::places_and_covariances);
            text += '\n';
        }
        check(detections_.append(text));
        text.clear();
        for (const vision::Displacement& tag : displacements)
            text += fmt::format("{},{},{:.3f},{:.3f},{:.3f},{:.3f}\n", key, tag.tag_id, tag.moved_um.x(),
                                tag.moved_um.y(), tag.std_um.x(), tag.std_um.y());
        check(displacements_.append(text));
    }

    void close() {
        check(detections_.close());
        check(displacements_.close());
    }

  private:
    bool with_times_;
    DurableFile detections_;
    DurableFile displacements_;
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
            return load(frame)
                       ? finder(std::move(frame))
                       : FrameResult{.frame = std::move(frame), .grey = {}, .tags = {}, .refined = {}};
        };
    };
    const auto take = [&](const FrameResult& result) {
        count.images.add(result.frame);
        progress.advance();
        if (!result.frame.damage.empty()) return;
        auto& tracker = trackers.try_emplace(result.frame.series, tag_side_mm).first->second;
        tables.add(result, tracker.add(result.refined));
        count.tags += result.tags.size();
        count.sample.offer(result.grey, result.tags.size());
    };
    run_in_order([&] { return frames.next(); }, make_worker, take, threads);
    tables.close();
    progress.finish();
    return count;
}

}  // namespace fidservo

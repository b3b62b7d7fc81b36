// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/camera_images.h"

#include "core/input_error.h"
#include "src/files/rig/tag_print_keys.h"
#include "src/images/image_frames.h"
#include "src/images/image_tally.h"
#include "src/images/ordered_work.h"
#include "src/replay/unread_tags.h"
#include "vision/tags/tag_detector.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr std::size_t most_views = 120;  ///< more take long and tell little
constexpr std::size_t most_frames_a_burst = 16, most_bursts = 12;

/// R.m.s. way of the corners of the tags that both show; nothing if they do not show the same tags.
std::optional<double> way_px(const calib::TargetImage& a, const calib::TargetImage& b) {
    if (a.found.size() != b.found.size() || a.found.empty()) return std::nullopt;
    double squares = 0.0;
    for (std::size_t k = 0; k < a.found.size(); ++k) {
        if (a.found[k].tag_id != b.found[k].tag_id) return std::nullopt;
        for (std::size_t c = 0; c < 4; ++c)
            squares += (a.found[k].corners_px[c] - b.found[k].corners_px[c]).squaredNorm();
    }
    return std::sqrt(squares / (4.0 * static_cast<double>(a.found.size())));
}

void demand_tags_of(const CameraTarget& target, const calib::TargetImage& image) {
    for (const TagDetection& tag : image.found)
        if (std::ranges::none_of(target.tags, [&](const PlateTag& of) { return of.id == tag.tag_id; }))
            throw InputError(fmt::format(
                "{}: shows the tag {}, which the target does not have ({}, tags {} to {})", image.name,
                tag.tag_id, target.text, target.tags.front().id, target.tags.back().id));
}

/// What is in images without a tag of the target, and how the target would have to be given.
std::string instead_of_target(const FrameSample& sample, const CameraTarget& target) {
    const vision::TagReading tried{target.print()};
    const vision::OtherReadings others = vision::try_other_readings(sample.greys(), tried);
    if (others.better.empty()) return what_was_seen_text(others, tried);
    const vision::TriedReading& best = others.better.front();
    const TagPrint april_grid_print{.border_cells = 2};
    const std::string how = best.reading.mirrored ? "mirror the images"
                            : best.reading.print == april_grid_print
                                ? "give the AprilGrid, --grid or --target"
                                : fmt::format("give a rig file whose fiducials have {}",
                                              tag_print_yaml(best.reading.print, ", "));
    return fmt::format("{} would be found: {}", tags_text(best), how);
}

/// Sorts images into views and bursts as they come.
class Collector {
  public:
    Collector(const CameraTarget& target, CalibrationImages& images) : target_(target), images_(images) {}

    void take(calib::TargetImage image) {
        ++images_.images;
        if (images_.width_px == 0) {
            images_.width_px = image.grey.cols;
            images_.height_px = image.grey.rows;
        }
        if (image.grey.cols != images_.width_px || image.grey.rows != images_.height_px)
            throw InputError(fmt::format("{}: {} x {} px: the images before it have {} x {} px", image.name,
                                         image.grey.cols, image.grey.rows, images_.width_px,
                                         images_.height_px));
        if (!target_.is_rigs_plate) demand_tags_of(target_, image);
        if (image.found.empty()) {
            ++images_.without_target;
            return;
        }
        collect_burst(image);
        constexpr double least_way = 0.005;  // of the image's width
        const auto way = images_.views.empty() ? std::nullopt : way_px(images_.views.back(), image);
        if (!way || *way > least_way * images_.width_px) images_.views.push_back(std::move(image));
    }

    void end() {
        std::erase_if(images_.bursts, [](const auto& burst) { return burst.size() < 2; });
        const std::size_t every = (images_.views.size() + most_views - 1) / most_views;
        if (every < 2) return;
        std::vector<calib::TargetImage> fewer;
        for (std::size_t k = 0; k < images_.views.size(); k += every) fewer.push_back(images_.views[k]);
        images_.views = std::move(fewer);
    }

  private:
    /// A frame at rest joins the burst of the frame before it.
    void collect_burst(const calib::TargetImage& image) {
        constexpr double at_rest_px = 0.1;
        const auto way = before_ ? way_px(*before_, image) : std::nullopt;
        auto& bursts = images_.bursts;
        if (way && *way < at_rest_px) {
            if (bursts.back().size() < most_frames_a_burst) bursts.back().push_back(image.grey);
        } else if (bursts.empty() || bursts.back().size() >= 2) {
            if (bursts.size() < most_bursts) bursts.push_back({image.grey});
        } else {
            bursts.back() = {image.grey};
        }
        before_ = image;
    }

    const CameraTarget& target_;
    CalibrationImages& images_;
    std::optional<calib::TargetImage> before_;
};

}  // namespace

CalibrationImages read_calibration_images(const std::vector<std::filesystem::path>& inputs,
                                          const CameraTarget& target) {
    ImageFrames frames(inputs, {.one_range = true});
    ImageTally tally(frames.missing());
    CalibrationImages images;
    Collector collector(target, images);
    FrameSample sample;
    const vision::TagReading reading{target.print()};
    const auto make_worker = [&] {
        return [machine = vision::TagDetector(vision::machine_camera_options(reading)),
                thorough = vision::TagDetector(vision::thorough_options(reading))](ImageFrame frame) mutable {
            if (!load(frame)) return std::pair(std::move(frame), calib::TargetImage{});
            calib::TargetImage image{frame.name, frame.decoded, {}};
            vision::TagDetector& detector = frame.from_recording ? machine : thorough;
            image.found = detector.detect(image.grey, frame.time_ns.value_or(0));
            return std::pair(std::move(frame), std::move(image));
        };
    };
    const auto take = [&](const std::pair<ImageFrame, calib::TargetImage>& result) {
        tally.add(result.first);
        if (!result.first.damage.empty()) return;
        sample.offer(result.second.grey, result.second.found.size());
        collector.take(result.second);
    };
    run_in_order([&] { return frames.next(); }, make_worker, take,
                 std::max(1u, std::thread::hardware_concurrency()));
    if (tally.read() == 0) throw InputError(tally.first_reason());
    images.notes = frames.notes();
    for (const std::string& note : tally.notes()) images.notes.push_back(note);
    if (tally.read() < tally.all()) images.notes.push_back(tally.text());
    collector.end();
    if (images.views.empty())
        throw InputError(fmt::format("{}: no tag of the target ({}) is in any of its {} image{}: {}",
                                     inputs.front().string(), target.text, images.images,
                                     images.images == 1 ? "" : "s", instead_of_target(sample, target)));
    return images;
}

std::vector<cv::Mat> read_burst(const std::filesystem::path& folder) {
    ImageFrames frames({folder}, {.one_range = true});
    std::vector<cv::Mat> burst;
    while (const auto frame = frames.next()) {
        burst.push_back(decode(*frame).clone());
        if (burst.back().size() != burst.front().size())
            throw InputError(fmt::format("{}: is not as large as the images before it", frame->name));
    }
    if (burst.size() < 2)
        throw InputError(fmt::format("{}: noise needs two frames at rest or more", folder.string()));
    return burst;
}

}  // namespace fidservo

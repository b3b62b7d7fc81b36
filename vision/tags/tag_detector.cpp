// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_detector.h"

#include <algorithm>
#include <numbers>
#include <tuple>

extern "C" {
#include <apriltag/apriltag.h>
}

#include "core/demand.h"
#include "vision/tags/contrast_regions.h"
#include "vision/tags/quad.h"
#include "vision/tags/tag_book.h"
#include "vision/tags/tag_pattern.h"

#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

/// The library counts pixel edges at integers, we count pixel centres.
constexpr double library_pixel_centre = 0.5;

/// Images smaller than this in either direction cannot hold a tag; the library does not expect them.
constexpr int smallest_image_px = 10;

/// The part of a large image outside of which no search finds an edge. An image of usual size is searched as
/// it is: a part of it would give the same tags, but its corners with another rounding.
cv::Rect part_to_search(const cv::Mat& view, const TagDetectorOptions& options) {
    constexpr std::size_t usual_px = 1U << 24U;
    constexpr int magnified = 2;  // an edge's contrast by the cubic magnification, times this at most
    const cv::Rect all(0, 0, view.cols, view.rows);
    if (view.total() <= usual_px) return all;
    return contrast_box(
        view, std::max(1, options.magnify ? options.min_contrast / magnified : options.min_contrast));
}

/// Those of `more` that are not among the tags yet.
void add_new(std::vector<TagDetection>& tags, const std::vector<TagDetection>& more) {
    for (const TagDetection& tag : more)
        if (std::none_of(tags.begin(), tags.end(), [&](const TagDetection& other) {
                return same_place(tag.corners_px, other.corners_px);
            }))
            tags.push_back(tag);
}

/// Those of `more` that are not among the tags yet, or fit the image better than the one that is.
void add_better(const cv::Mat& image, std::vector<TagDetection>& tags,
                const std::vector<TagDetection>& more) {
    const auto explained = [&](const TagDetection& tag) {
        return explained_contrast(image, tag.corners_px, tag_pattern(tag.print, tag.tag_id));
    };
    for (const TagDetection& tag : more) {
        const auto same = std::find_if(tags.begin(), tags.end(), [&](const TagDetection& other) {
            return same_place(tag.corners_px, other.corners_px);
        });
        if (same == tags.end())
            tags.push_back(tag);
        else if (explained(tag) > explained(*same))
            *same = tag;
    }
}

/// Moves all sides outwards, roughly.
void widen(TagDetection& tag, double by_px) {
    const Eigen::Vector2d centre = centre_of(tag.corners_px);
    for (Eigen::Vector2d& corner : tag.corners_px)
        corner += std::numbers::sqrt2 * by_px * (corner - centre).normalized();
}

}  // namespace

TagDetectorOptions machine_camera_options(const TagReading& reading) {
    TagDetectorOptions options;
    options.reading = reading;
    return options;
}

TagDetectorOptions thorough_options(const TagReading& reading) {
    TagDetectorOptions options;
    options.reading = reading;
    options.min_contrast = 5;
    options.magnify = true;
    return options;
}

bool by_id_from_left(const TagDetection& a, const TagDetection& b) {
    return std::tuple(a.tag_id, centre_of(a.corners_px).x()) <
           std::tuple(b.tag_id, centre_of(b.corners_px).x());
}

struct TagDetector::Impl {
    explicit Impl(const TagDetectorOptions& with) : options(with) {
        detector->quad_decimate = static_cast<float>(options.decimation);
    }

    /// One run of the library; `magnification` tells how much larger the image is than the original.
    std::vector<TagDetection> search(const cv::Mat& image, TimeNs time_ns, const cv::Point& origin,
                                     double magnification) {
        image_u8_t view{image.cols, image.rows, static_cast<int>(image.step[0]), image.data};
        const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> found(
            apriltag_detector_detect(detector.get(), &view), apriltag_detections_destroy);
        std::vector<TagDetection> tags;
        for (int k = 0; k < zarray_size(found.get()); ++k) {
            apriltag_detection_t* seen = nullptr;
            zarray_get(found.get(), k, static_cast<void*>(&seen));
            TagDetection tag;
            tag.time_ns = time_ns;
            tag.tag_id = seen->id;
            tag.corrected_bits = seen->hamming;
            tag.decision_margin = seen->decision_margin;
            tag.print = options.reading.print;
            std::array<Eigen::Vector2d, 4> corners_px;
            for (std::size_t c = 0; c < 4; ++c)
                corners_px[c] =
                    Eigen::Vector2d(seen->p[c][0], seen->p[c][1]) / magnification +
                    Eigen::Vector2d(origin.x - library_pixel_centre, origin.y - library_pixel_centre);
            tag.corners_px = options.reading.mirrored ? mirrored(corners_px) : corners_px;
            tags.push_back(tag);
        }
        return tags;
    }

    TagDetectorOptions options;
    LeastExplained least = least_explained(*options.reading.print.family);
    std::shared_ptr<apriltag_family_t> book = shared_tag_book(
        options.reading,
        std::min(options.max_corrected_bits, most_correctable_bits(*options.reading.print.family)));
    LibraryDetector detector = library_detector({&book, 1}, options.min_contrast);
};

TagDetector::TagDetector(const TagDetectorOptions& options) : impl_(std::make_unique<Impl>(options)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::detect(const cv::Mat& image, TimeNs time_ns, const cv::Rect& region) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    const cv::Rect whole(0, 0, image.cols, image.rows);
    cv::Rect part = region.empty() ? whole : (region & whole);
    const auto is_too_small = [&] {
        return part.width < smallest_image_px || part.height < smallest_image_px;
    };
    if (is_too_small()) return {};
    part = part_to_search(image(part), impl_->options) + part.tl();
    if (is_too_small()) return {};

    const TagPrint& print = impl_->options.reading.print;
    const cv::Mat view = image(part);
    std::vector<TagDetection> tags = impl_->search(view, time_ns, part.tl(), 1.0);
    if (impl_->options.magnify) {
        cv::Mat larger;
        cv::resize(view, larger, {}, 2.0, 2.0, cv::INTER_CUBIC);
        add_new(tags, impl_->search(larger, time_ns, part.tl(), 2.0));
        if (print.border_cells == 2) {
            // The squares between an AprilGrid's tags touch their corners; wider paper tears them apart.
            if (print.inverted)
                cv::erode(larger, larger, cv::Mat());
            else
                cv::dilate(larger, larger, cv::Mat());
            std::vector<TagDetection> thinner = impl_->search(larger, time_ns, part.tl(), 2.0);
            for (TagDetection& tag : thinner) widen(tag, 0.5);
            add_better(image, tags, thinner);
        }
    }
    std::erase_if(tags, [&](const TagDetection& tag) {
        return !is_convincing(image, tag.corners_px, tag_pattern(tag.print, tag.tag_id), impl_->least);
    });
    std::sort(tags.begin(), tags.end(), by_id_from_left);
    return tags;
}

}  // namespace fidservo::vision

#include "vision/tag_detector.h"

#include <algorithm>
#include <numbers>
#include <tuple>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include "core/demand.h"
#include "vision/quad.h"
#include "vision/tag_pattern.h"

#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

/// The library counts pixel edges at integers, we count pixel centres.
constexpr double library_pixel_centre = 0.5;

/// Images smaller than this in either direction cannot hold a tag; the library does not expect them.
constexpr int smallest_image_px = 10;

/// Those of `more` that are not among the tags yet.
void add_new(std::vector<TagDetection>& tags, const std::vector<TagDetection>& more) {
    for (const TagDetection& tag : more)
        if (std::none_of(tags.begin(), tags.end(), [&](const TagDetection& other) {
                return same_place(tag.corners_px, other.corners_px);
            }))
            tags.push_back(tag);
}

/// Moves all sides outwards, roughly.
void widen(TagDetection& tag, double by_px) {
    const Eigen::Vector2d centre = centre_of(tag.corners_px);
    for (Eigen::Vector2d& corner : tag.corners_px)
        corner += std::numbers::sqrt2 * by_px * (corner - centre).normalized();
}

using Family = std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)>;

/// The library's code book, its cells moved inwards to make room for a wider border.
Family family_with_border(int border_cells) {
    FIDSERVO_DEMAND(border_cells == 1 || border_cells == 2);
    Family family(tag36h11_create(), tag36h11_destroy);
    const int wider = border_cells - 1;
    family->width_at_border += 2 * wider;
    family->total_width += 2 * wider;
    for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
        family->bit_x[bit] += wider;
        family->bit_y[bit] += wider;
    }
    return family;
}

}  // namespace

TagDetectorOptions machine_camera_options() {
    return {};
}

TagDetectorOptions thorough_options() {
    TagDetectorOptions options;
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
        apriltag_detector_add_family_bits(detector.get(), family.get(), options.max_corrected_bits);
        detector->nthreads = 1;
        detector->quad_decimate = static_cast<float>(options.decimation);
        detector->quad_sigma = 0.0F;  // with decimation 1 the library would blur the caller's own image
        detector->qtp.min_white_black_diff = options.min_contrast;
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
            tag.border_cells = options.border_cells;
            for (std::size_t c = 0; c < 4; ++c)
                tag.corners_px[c] =
                    Eigen::Vector2d(seen->p[c][0], seen->p[c][1]) / magnification +
                    Eigen::Vector2d(origin.x - library_pixel_centre, origin.y - library_pixel_centre);
            tags.push_back(tag);
        }
        return tags;
    }

    TagDetectorOptions options;
    Family family = family_with_border(options.border_cells);
    std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)> detector{
        apriltag_detector_create(), apriltag_detector_destroy};
};

TagDetector::TagDetector(const TagDetectorOptions& options) : impl_(std::make_unique<Impl>(options)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::detect(const cv::Mat& image, TimeNs time_ns, const cv::Rect& region) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    const cv::Rect whole(0, 0, image.cols, image.rows);
    const cv::Rect part = region.empty() ? whole : (region & whole);
    if (part.width < smallest_image_px || part.height < smallest_image_px) return {};

    const cv::Mat view = image(part);
    std::vector<TagDetection> tags = impl_->search(view, time_ns, part.tl(), 1.0);
    if (impl_->options.magnify) {
        cv::Mat larger;
        cv::resize(view, larger, {}, 2.0, 2.0, cv::INTER_CUBIC);
        add_new(tags, impl_->search(larger, time_ns, part.tl(), 2.0));
        if (impl_->options.border_cells == 2) {
            // The squares between an AprilGrid's tags touch their corners; a wider white tears them apart.
            cv::dilate(larger, larger, cv::Mat());
            std::vector<TagDetection> thinner = impl_->search(larger, time_ns, part.tl(), 2.0);
            for (TagDetection& tag : thinner) widen(tag, 0.5);
            add_new(tags, thinner);
        }
    }
    std::erase_if(tags, [&](const TagDetection& tag) {
        return explained_contrast(image, tag.corners_px, tag_pattern(tag.tag_id, tag.border_cells)) <
               impl_->options.min_explained_contrast;
    });
    std::sort(tags.begin(), tags.end(), by_id_from_left);
    return tags;
}

}  // namespace fidservo::vision

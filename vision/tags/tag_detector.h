// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fiducials of any family (core/tag_families.h) in a grey image, found with libapriltag.
#include "core/detection.h"
#include "core/time.h"
#include "vision/tags/tag_book.h"

#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Trade-offs between speed and sensitivity. The two presets below suit most uses.
struct TagDetectorOptions {
    /// Contrast in grey levels below which a neighbourhood holds no edge. 30 is twelve times as fast as the
    /// library's 5 on a frame of the machine's camera, at the same precision.
    int min_contrast = 30;
    /// Factor (>= 1) by which the image is reduced for the search of quads; above 1 the corners depend on
    /// focus.
    double decimation = 1.0;
    /// Code bits that may differ from the code book; never more than most_correctable_bits().
    int max_corrected_bits = 2;
    /// How tags are read; tags printed otherwise are not found.
    TagReading reading = {};
    /// Search a second time at twice the resolution, for tags whose bits are about two pixels wide or less.
    bool magnify = false;
};

/// For the machine's own camera: tags are large and well lit, and every frame must be done in time.
TagDetectorOptions machine_camera_options(const TagReading& reading = {});

/// For arbitrary photographs: finds every tag that can be read, however small, at some ten times the cost.
TagDetectorOptions thorough_options(const TagReading& reading = {});

/// The order in which detections are listed: by id, then from left to right.
bool by_id_from_left(const TagDetection& a, const TagDetection& b);

/// Finds tags. It holds working memory: use one detector per thread; different detectors are independent.
class TagDetector {
  public:
    /// A detector with these options.
    explicit TagDetector(const TagDetectorOptions& options = machine_camera_options());
    ~TagDetector();
    /// Leaves the other one empty.
    TagDetector(TagDetector&&) noexcept;
    /// Leaves the other one empty.
    TagDetector& operator=(TagDetector&&) noexcept;

    /// Every tag in the image whose pattern explains enough of it (least_explained()), by_id_from_left. An id
    /// is listed twice if the image has it twice. Corners in px, pixel centres at integers (the library's own
    /// are at +0.5), with the library's precision; tag_refinement.h improves it.
    /// @param image    CV_8UC1; not modified
    /// @param time_ns  middle of the exposure, passed on to the detections
    /// @param region   where to look; empty: everywhere. It is cut to the image.
    std::vector<TagDetection> detect(const cv::Mat& image, TimeNs time_ns, const cv::Rect& region = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision

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

/// How hard to look. Use one of the two presets below unless you know better.
struct TagDetectorOptions {
    /// Contrast in grey levels below which a neighbourhood holds no edge. 30 is twelve times as fast as the
    /// library's 5 on a frame of the machine's camera, at the same precision.
    int min_contrast = 30;
    /// The quad search runs on an image this much smaller (>= 1); corners then move with focus.
    double decimation = 1.0;
    /// Code bits that may differ from the code book; never more than most_correctable_bits().
    int max_corrected_bits = 2;
    /// Tags that are printed otherwise are not seen.
    TagReading reading = {};
    /// Look again at twice the resolution, for tags whose bits are about two pixels wide or less.
    bool magnify = false;
};

/// For the machine's own camera: large, well lit tags, every frame in time.
TagDetectorOptions machine_camera_options(const TagReading& reading = {});

/// For arbitrary photographs: every tag that can be read, however small, at some ten times the cost.
TagDetectorOptions thorough_options(const TagReading& reading = {});

/// The order in which detections are listed: by id, then from left to right.
bool by_id_from_left(const TagDetection& a, const TagDetection& b);

/// Finds tags. Holds working memory: use one detector a thread; different detectors are independent.
class TagDetector {
  public:
    /// A detector that looks as the options say.
    explicit TagDetector(const TagDetectorOptions& options = machine_camera_options());
    ~TagDetector();
    /// Takes over all that the other has.
    TagDetector(TagDetector&&) noexcept;
    /// Takes over all that the other has.
    TagDetector& operator=(TagDetector&&) noexcept;

    /// Every tag in the image whose pattern explains enough of it (least_explained()), by_id_from_left. The
    /// same id may come twice: then it is there twice. Corners in px, pixel centres at integers (the
    /// library's own are at +0.5), as precise as the library's: tag_refinement.h does better.
    /// @param image    CV_8UC1; not modified
    /// @param time_ns  middle of the exposure, passed on to the detections
    /// @param region   where to look; empty: everywhere. It is cut to the image.
    std::vector<TagDetection> detect(const cv::Mat& image, TimeNs time_ns, const cv::Rect& region = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision

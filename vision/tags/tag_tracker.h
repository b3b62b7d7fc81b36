// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Follows tags from frame to frame: the image is searched only where a tag is expected, and as a whole only
// when one is lost.
#include "vision/tags/tag_alignment.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// How a tag was found, cheapest first.
enum class FoundBy { tracking, region_search, full_search };

struct FoundTag {
    TagDetection detection;  ///< corners accurate to half a pixel
    FoundBy found_by;
};

struct TrackedTag {
    RefinedTag tag;  ///< `explained` is 0 where the refinement failed
    FoundBy found_by;
};

/// The motion of the tags in the image since the last frame, as predicted from the stage's sensors.
struct PictureMotion {
    Eigen::Vector2d shift_px;
    double uncertainty_px;  ///< largest expected error of the shift
    Eigen::Vector2d during_exposure_px = Eigen::Vector2d::Zero();
};

struct TagTrackerOptions {
    TagDetectorOptions detector = machine_camera_options();
    AlignmentOptions alignment;
    RefinementOptions refinement;
    /// Number of frames after which the whole image is searched for tags that have come into view; 0: only
    /// when a tag is lost or none is known.
    int look_around_every = 0;
};

/// Finds tags where they are expected (align_tag()); if that fails, with libapriltag in the region around; if
/// that fails, too, in the whole image. Ids are not taken over from the frame before, but read again in every
/// frame. A tag whose expected place is not wholly inside the image counts as having left the view and is not
/// searched for in the whole image, unless no other tag is seen. It holds working memory: use one tracker per
/// thread.
class TagTracker {
  public:
    explicit TagTracker(const TagTrackerOptions& options = {});

    /// Every tag of the last frame that is still in view, and tags that a search for lost ones has found.
    /// @param image   CV_8UC1
    /// @param motion  empty: constant velocity, from the last two frames
    std::vector<TrackedTag> track(const cv::Mat& image, TimeNs time_ns,
                                  const std::optional<PictureMotion>& motion = {});

    /// Finds tags whose places are predicted from the plate's geometry; does not use or change the tracker's
    /// memory.
    std::vector<FoundTag> find(const cv::Mat& image, TimeNs time_ns,
                               const std::vector<ExpectedTag>& expected);

    /// Forgets the last frame, so that the whole of the next one is searched.
    void forget() { *this = TagTracker(options_); }

  private:
    struct Followed {
        TagDetection last;
        std::optional<Eigen::Vector2d> velocity_px_per_s;
    };
    std::vector<ExpectedTag> predict(TimeNs time_ns, const std::optional<PictureMotion>& motion) const;
    void remember(const std::vector<TrackedTag>& tags);

    TagTrackerOptions options_;
    TagDetector detector_;
    std::vector<Followed> followed_;
    double blur_px_;  ///< blur of the tag that was refined last
    int frames_since_full_search_ = 0;
};

}  // namespace fidservo::vision

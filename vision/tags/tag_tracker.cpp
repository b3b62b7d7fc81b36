// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_tracker.h"

#include "vision/tags/quad.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::vision {
namespace {

using CornersPx = std::array<Eigen::Vector2d, 4>;

constexpr double any_reach_px = std::numeric_limits<double>::infinity();

bool is_known(const std::vector<FoundTag>& tags, const TagDetection& tag) {
    return std::any_of(tags.begin(), tags.end(), [&](const FoundTag& other) {
        return same_place(other.detection.corners_px, tag.corners_px);
    });
}

/// Border and quiet zone of the expected tag, wherever within its reach it is.
cv::Rect region_of(const ExpectedTag& expected) {
    constexpr double quiet_zone = 0.2;  // of the side
    Eigen::Vector2d low = expected.corners_px[0], high = low;
    for (const Eigen::Vector2d& corner : expected.corners_px) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    const double side_px = (high - low).maxCoeff();
    const double room_px = quiet_zone * side_px + std::min(expected.reach_px, 0.5 * side_px);
    const Eigen::Vector2i first = (low.array() - room_px).floor().cast<int>();
    const Eigen::Vector2i size = (high - low).array().ceil().cast<int>() + static_cast<int>(2 * room_px) + 1;
    return {first.x(), first.y(), size.x(), size.y()};
}

bool wholly_inside(const cv::Mat& image, const CornersPx& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Eigen::Vector2d& corner) { return can_sample(image, corner); });
}

bool outside(const cv::Mat& image, const ExpectedTag& expected) {
    const double room_px = std::min(expected.reach_px, 0.5 * longest_side_px(expected.corners_px));
    return std::any_of(expected.corners_px.begin(), expected.corners_px.end(), [&](const Eigen::Vector2d& c) {
        return c.x() < -room_px || c.y() < -room_px || c.x() > image.cols - 1 + room_px ||
               c.y() > image.rows - 1 + room_px;
    });
}

RefinedTag refine(const cv::Mat& image, const FoundTag& found, const RefinementOptions& options) {
    constexpr double aligned_std_px = 0.3;  // of align_tag's corners
    if (const auto refined = refine_tag(image, found.detection, options)) return *refined;
    if (found.found_by != FoundBy::tracking) return unrefined(found.detection);
    RefinedTag tag =
        tag_of_corners(found.detection, CornerCovariance::Identity() * (aligned_std_px * aligned_std_px));
    tag.explained = 0.0;
    return tag;
}

}  // namespace

TagTracker::TagTracker(const TagTrackerOptions& options)
    : options_(options), detector_(options.detector), blur_px_(options.refinement.blur_px) {}

std::vector<FoundTag> TagTracker::find(const cv::Mat& image, TimeNs time_ns,
                                       const std::vector<ExpectedTag>& expected) {
    std::vector<FoundTag> found;
    bool lost = expected.empty();
    for (const ExpectedTag& tag : expected) {
        if (outside(image, tag)) continue;
        const auto aligned = align_tag(image, time_ns, tag, options_.alignment);
        if (aligned && !is_known(found, *aligned)) {
            found.push_back({*aligned, FoundBy::tracking});
            continue;
        }
        bool is_there = false;
        for (const TagDetection& seen : detector_.detect(image, time_ns, region_of(tag))) {
            is_there = is_there || seen.tag_id == tag.tag_id;
            if (!is_known(found, seen)) found.push_back({seen, FoundBy::region_search});
        }
        lost = lost || (!is_there && wholly_inside(image, tag.corners_px));
    }
    if (!lost && !found.empty()) return found;
    for (const TagDetection& seen : detector_.detect(image, time_ns))
        if (!is_known(found, seen)) found.push_back({seen, FoundBy::full_search});
    return found;
}

std::vector<ExpectedTag> TagTracker::predict(TimeNs time_ns,
                                             const std::optional<PictureMotion>& motion) const {
    constexpr double least_uncertainty_px = 2.0;
    std::vector<ExpectedTag> expected;
    for (const Followed& tag : followed_) {
        Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();
        double reach_px = any_reach_px;
        if (motion) {
            shift_px = motion->shift_px;
            reach_px = motion->uncertainty_px + least_uncertainty_px;
        } else if (tag.velocity_px_per_s) {
            shift_px = *tag.velocity_px_per_s * seconds(time_ns - tag.last.time_ns);
        }
        ExpectedTag next{tag.last.tag_id, tag.last.corners_px, reach_px};
        for (Eigen::Vector2d& corner : next.corners_px) corner += shift_px;
        expected.push_back(next);
    }
    return expected;
}

void TagTracker::remember(const std::vector<TrackedTag>& tags) {
    std::vector<Followed> now;
    for (const TrackedTag& tag : tags) {
        const TagDetection& seen = tag.tag.detection;
        Followed next{seen, {}};
        const Followed* nearest = nullptr;
        double least_px = any_reach_px;
        for (const Followed& before : followed_) {
            if (before.last.tag_id != seen.tag_id || before.last.time_ns >= seen.time_ns) continue;
            const double way_px = (centre_of(before.last.corners_px) - centre_of(seen.corners_px)).norm();
            if (way_px > least_px) continue;
            least_px = way_px;
            nearest = &before;
        }
        if (nearest != nullptr)
            next.velocity_px_per_s = (centre_of(seen.corners_px) - centre_of(nearest->last.corners_px)) /
                                     seconds(seen.time_ns - nearest->last.time_ns);
        now.push_back(next);
    }
    followed_ = std::move(now);
}

std::vector<TrackedTag> TagTracker::track(const cv::Mat& image, TimeNs time_ns,
                                          const std::optional<PictureMotion>& motion) {
    std::vector<FoundTag> found = find(image, time_ns, predict(time_ns, motion));
    const bool searched = std::any_of(
        found.begin(), found.end(), [](const FoundTag& tag) { return tag.found_by == FoundBy::full_search; });
    frames_since_full_search_ = searched ? 0 : frames_since_full_search_ + 1;
    if (options_.look_around_every > 0 && frames_since_full_search_ >= options_.look_around_every) {
        frames_since_full_search_ = 0;
        for (const TagDetection& seen : detector_.detect(image, time_ns))
            if (!is_known(found, seen)) found.push_back({seen, FoundBy::full_search});
    }
    RefinementOptions refinement = options_.refinement;
    refinement.blur_px = blur_px_;
    if (motion) refinement.motion_px = motion->during_exposure_px;
    std::vector<TrackedTag> tags;
    tags.reserve(found.size());
    for (const FoundTag& tag : found) {
        tags.push_back({refine(image, tag, refinement), tag.found_by});
        if (tags.back().tag.blur_px > 0.0) blur_px_ = tags.back().tag.blur_px;
    }
    remember(tags);
    return tags;
}

}  // namespace fidservo::vision

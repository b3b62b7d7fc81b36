// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/displacement.h"

#include "core/demand.h"
#include "core/units.h"

#include <algorithm>
#include <iterator>

namespace fidservo::vision {
namespace {

/// Mean side in px and its standard deviation.
struct MeanSide {
    double mean_px, std_px;
};

MeanSide mean_side_of(const RefinedTag& tag) {
    const auto& corners = tag.detection.corners_px;
    double sum_px = 0.0;
    Eigen::Matrix<double, 1, 8> gradient = Eigen::Matrix<double, 1, 8>::Zero();
    for (int k = 0; k < 4; ++k) {
        const int next = (k + 1) % 4;
        const Eigen::Vector2d side = corners[next] - corners[k];
        sum_px += side.norm();
        gradient.segment<2>(2 * next) += 0.25 * side.normalized().transpose();
        gradient.segment<2>(2 * k) -= 0.25 * side.normalized().transpose();
    }
    const double variance = gradient * tag.covariance_px2 * gradient.transpose();
    return {0.25 * sum_px, std::sqrt(variance)};
}

}  // namespace

DisplacementTracker::DisplacementTracker(double tag_side_mm) : tag_side_mm_(tag_side_mm) {
    FIDSERVO_DEMAND(tag_side_mm > 0);
}

TagPlace tag_place(const RefinedTag& tag) {
    const MeanSide side = mean_side_of(tag);
    return {tag.detection.time_ns, tag.detection.tag_id, tag.centre_px, tag.centre_covariance_px2.diagonal(),
            side.mean_px,          side.std_px};
}

std::vector<Displacement> DisplacementTracker::add(const std::vector<RefinedTag>& frame) {
    std::vector<TagPlace> places;
    std::transform(frame.begin(), frame.end(), std::back_inserter(places), tag_place);
    return add(places);
}

std::vector<Displacement> DisplacementTracker::add(const std::vector<TagPlace>& frame) {
    std::vector<Displacement> moved;
    for (const TagPlace& tag : frame) {
        const auto same_id = [&tag](const TagPlace& other) { return other.tag_id == tag.tag_id; };
        if (std::count_if(frame.begin(), frame.end(), same_id) > 1) continue;

        const auto origin = std::find_if(origins_.begin(), origins_.end(),
                                         [&tag](const Origin& of) { return of.tag_id == tag.tag_id; });
        if (origin == origins_.end()) {
            origins_.push_back({tag.tag_id, tag.centre_px, tag.variance_px2,
                                um_from_mm(tag_side_mm_) / tag.side_px, tag.side_std_px / tag.side_px});
            moved.push_back({tag.time_ns, tag.tag_id, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
            continue;
        }
        const Eigen::Vector2d moved_um = (tag.centre_px - origin->centre_px) * origin->um_per_px;
        const Eigen::Vector2d centres_um2 =
            (tag.variance_px2 + origin->variance_px2) * (origin->um_per_px * origin->um_per_px);
        const Eigen::Vector2d scale_um2 = (moved_um * origin->relative_scale_std).cwiseAbs2();
        moved.push_back({tag.time_ns, tag.tag_id, moved_um, (centres_um2 + scale_um2).cwiseSqrt()});
    }
    return moved;
}

}  // namespace fidservo::vision

#include "vision/displacement.h"

#include "core/demand.h"
#include "core/units.h"

#include <algorithm>

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

std::vector<Displacement> DisplacementTracker::add(const std::vector<RefinedTag>& frame) {
    std::vector<Displacement> moved;
    for (const RefinedTag& tag : frame) {
        const int id = tag.detection.tag_id;
        const auto same_id = [id](const RefinedTag& other) { return other.detection.tag_id == id; };
        if (std::count_if(frame.begin(), frame.end(), same_id) > 1) continue;

        const Eigen::Vector2d& now_px = tag.centre_px;
        const Eigen::Matrix2d& covariance_px2 = tag.centre_covariance_px2;
        const auto origin = std::find_if(origins_.begin(), origins_.end(),
                                         [id](const Origin& of) { return of.tag_id == id; });
        if (origin == origins_.end()) {
            const MeanSide side = mean_side_of(tag);
            origins_.push_back({id, now_px, covariance_px2, um_from_mm(tag_side_mm_) / side.mean_px,
                                side.std_px / side.mean_px});
            moved.push_back({tag.detection.time_ns, id, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
            continue;
        }
        const Eigen::Vector2d moved_um = (now_px - origin->centre_px) * origin->um_per_px;
        const Eigen::Vector2d centres_um2 =
            (covariance_px2 + origin->covariance_px2).diagonal() * (origin->um_per_px * origin->um_per_px);
        const Eigen::Vector2d scale_um2 = (moved_um * origin->relative_scale_std).cwiseAbs2();
        moved.push_back({tag.detection.time_ns, id, moved_um, (centres_um2 + scale_um2).cwiseSqrt()});
    }
    return moved;
}

}  // namespace fidservo::vision

#include "vision/tag_refinement.h"

#include "vision/edge_fit.h"
#include "vision/quad.h"

#include <algorithm>

#include <Eigen/LU>

namespace fidservo::vision {
namespace {

constexpr double cells_per_side = 8.0;
constexpr double least_side_px = 30.0;
constexpr double widest_strip_px = 5.0;

/// The side from corner k to corner k + 1, white outside.
EdgeGuess guess_of_side(const std::array<Eigen::Vector2d, 4>& corners, std::size_t k) {
    const Eigen::Vector2d& from = corners[k];
    const Eigen::Vector2d& to = corners[(k + 1) % 4];
    const double length = (to - from).norm();
    const Eigen::Vector2d along = (to - from) / length;
    const Eigen::Vector2d inwards = corners[(k + 2) % 4] - from;
    Eigen::Vector2d normal(-along.y(), along.x());
    if (normal.dot(inwards) > 0) normal = -normal;
    const double cell = length / cells_per_side;
    const double half_width = std::clamp(0.5 * cell, 1.5, widest_strip_px);
    return {0.5 * (from + to), along, normal, length - 2 * std::max(half_width + 1.0, 0.02 * length),
            half_width};
}

struct Line {
    EdgeGuess guess;
    EdgeFit fit;
    /// a . p = b for the points p of the line.
    Eigen::RowVector2d a() const { return (guess.normal - fit.slope * guess.along).transpose(); }
    double b() const { return a().dot(guess.middle_px.transpose()) + fit.offset_px; }
    /// d b / d (offset, slope) at a point of the line, a held fixed.
    Eigen::RowVector2d b_sensitivity(const Eigen::Vector2d& at) const {
        return {1.0, guess.along.dot(at - guess.middle_px)};
    }
};

/// The mean of the corners, which is the centre up to perspective.
Eigen::Matrix2d centre_covariance_px2(const CornerCovariance& corners) {
    Eigen::Matrix<double, 2, 8> mean;
    for (int k = 0; k < 4; ++k) mean.block<2, 2>(0, 2 * k) = 0.25 * Eigen::Matrix2d::Identity();
    return mean * corners * mean.transpose();
}

}  // namespace

Result<RefinedTag> refine_tag(const cv::Mat& image, const TagDetection& found,
                              const RefinementOptions& /*options*/) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    std::array<Line, 4> lines;
    RefinedTag refined{found, CornerCovariance::Zero()};
    double shortest_px = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k) {
        if ((found.corners_px[(k + 1) % 4] - found.corners_px[k]).norm() < least_side_px)
            return failure(Reason::occluded, "the tag is too small for its edges to be measured");
        const EdgeGuess guess = guess_of_side(found.corners_px, k);
        const Result<EdgeFit> fit = fit_edge(image, guess);
        if (!fit) return tl::make_unexpected(fit.error());
        lines[k] = {guess, *fit};
        refined.explained = std::min(refined.explained, fit->explained);
        refined.blur_px += fit->blur_px / 4;
        shortest_px = std::min(shortest_px, guess.length_px);
    }

    // Corner k lies on the sides k - 1 and k. All corners together are linear in the eight edge parameters.
    Eigen::Matrix<double, 8, 8> corners_by_edges = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix<double, 8, 8> edge_covariance = Eigen::Matrix<double, 8, 8>::Zero();
    for (int k = 0; k < 4; ++k) {
        const int before = (k + 3) % 4;
        Eigen::Matrix2d both;
        both << lines[before].a(), lines[k].a();
        const Eigen::Matrix2d inverse = both.inverse();
        const Eigen::Vector2d corner = inverse * Eigen::Vector2d(lines[before].b(), lines[k].b());
        if (!corner.allFinite() ||
            (corner - found.corners_px[k]).norm() > std::max(2.0, shortest_px / cells_per_side))
            return failure(Reason::occluded, "the tag's border does not end where its code says");
        refined.detection.corners_px[k] = corner;
        corners_by_edges.block<2, 2>(2 * k, 2 * before) =
            inverse.col(0) * lines[before].b_sensitivity(corner);
        corners_by_edges.block<2, 2>(2 * k, 2 * k) = inverse.col(1) * lines[k].b_sensitivity(corner);
        edge_covariance.block<2, 2>(2 * k, 2 * k) = lines[k].fit.covariance;
    }
    RefinedTag measured =
        tag_of_corners(refined.detection, corners_by_edges * edge_covariance * corners_by_edges.transpose());
    measured.explained = refined.explained;
    measured.blur_px = refined.blur_px;
    return measured;
}

RefinedTag tag_of_corners(const TagDetection& corners, const CornerCovariance& covariance_px2) {
    return {corners, covariance_px2, centre_px(corners), centre_covariance_px2(covariance_px2)};
}

RefinedTag unrefined(const TagDetection& found) {
    constexpr double library_std_px = 0.2;
    RefinedTag tag = tag_of_corners(found, CornerCovariance::Identity() * (library_std_px * library_std_px));
    tag.explained = 0.0;
    return tag;
}

Eigen::Vector2d centre_px(const TagDetection& tag) {
    return centre_of(tag.corners_px);
}

}  // namespace fidservo::vision

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/scratch_path.h"

#include "core/demand.h"
#include "plant/view/gaussian.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::plant::view {

namespace {

Eigen::Vector2d left_normal(const Eigen::Vector2d& along) {
    return {-along.y(), along.x()};
}

/// Part of start + k slope, k = 0.., that lies in [low, high].
struct Range {
    double first, last;
};
Range where_between(double low, double high, double start, double slope) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (std::abs(slope) < 1e-12) {
        return start < low || start > high ? Range{infinity, -infinity} : Range{-infinity, infinity};
    }
    const double a = (low - start) / slope, b = (high - start) / slope;
    return {std::min(a, b), std::max(a, b)};
}

}  // namespace

ScratchPath::ScratchPath(std::span<const Eigen::Vector2d> points_px, double width_px, double sigma_px)
    : half_width_(0.5 * width_px), sigma_(sigma_px), edge_(EdgeProfile::gaussian(sigma_px)) {
    FIDSERVO_DEMAND(points_px.size() >= 2);
    constexpr double sharpest_turn_cos = -0.5;
    for (std::size_t k = 0; k + 1 < points_px.size(); ++k) {
        const Eigen::Vector2d step = points_px[k + 1] - points_px[k];
        const double length = step.norm();
        FIDSERVO_DEMAND(length > 0.0);
        const Eigen::Vector2d along = step / length;
        pieces_.push_back(
            {points_px[k], along, length, 0.0, {points_px[k], along}, {points_px[k + 1], -along}});
    }
    for (std::size_t k = 0; k + 1 < pieces_.size(); ++k) {
        Piece &before = pieces_[k], &after = pieces_[k + 1];
        const double turn_cos = before.along.dot(after.along);
        if (turn_cos < sharpest_turn_cos) continue;
        const Eigen::Vector2d forward = (before.along + after.along).normalized();
        before.end.inward = -forward;
        after.start.inward = forward;
        const double overhang = half_width_ * std::sqrt((1.0 - turn_cos) / (1.0 + turn_cos));
        before.overhang = std::max(before.overhang, overhang);
        after.overhang = std::max(after.overhang, overhang);
    }
    half_extent_px_.setZero();
    for (const Piece& piece : pieces_) {
        const double margin = half_width_ + piece.overhang + edge_.reach_px();
        for (const Eigen::Vector2d& point : {piece.start.point, piece.end.point}) {
            half_extent_px_ = half_extent_px_.cwiseMax(point.cwiseAbs() + Eigen::Vector2d::Constant(margin));
        }
    }
}

/// The piece's strip, kept on the inward side of a cut.
double ScratchPath::cut_strip(double offset, const Cut& cut, const Piece& piece,
                              const Eigen::Vector2d& place) const {
    const double inside = cut.inward.dot(place - cut.point);
    if (inside >= edge_.reach_px()) return edge_(half_width_ - offset) - edge_(-half_width_ - offset);
    if (inside <= -edge_.reach_px()) return 0.0;
    const double correlation = -left_normal(piece.along).dot(cut.inward);
    const double k = inside / sigma_;
    return bivariate_normal_cdf((half_width_ - offset) / sigma_, k, correlation) -
           bivariate_normal_cdf((-half_width_ - offset) / sigma_, k, correlation);
}

double ScratchPath::cover(const Piece& piece, const Eigen::Vector2d& place) const {
    const double offset = left_normal(piece.along).dot(place - piece.from);
    const double strip = edge_(half_width_ - offset) - edge_(-half_width_ - offset);
    return cut_strip(offset, piece.start, piece, place) + cut_strip(offset, piece.end, piece, place) - strip;
}

void ScratchPath::cover(double du, double dv, std::span<float> coverage) const {
    std::fill(coverage.begin(), coverage.end(), 0.0F);
    const auto last_pixel = static_cast<double>(coverage.size()) - 1.0;
    for (const Piece& piece : pieces_) {
        const Eigen::Vector2d start = Eigen::Vector2d(du, dv) - piece.from;
        const Eigen::Vector2d normal = left_normal(piece.along);
        const double across = half_width_ + edge_.reach_px(), beyond = piece.overhang + edge_.reach_px();
        const Range n = where_between(-across, across, normal.dot(start), normal.x());
        const Range t =
            where_between(-beyond, piece.length + beyond, piece.along.dot(start), piece.along.x());
        const double first = std::max({n.first, t.first, 0.0}), last = std::min({n.last, t.last, last_pixel});
        for (double k = std::ceil(first); k <= last; k += 1.0) {
            coverage[static_cast<std::size_t>(k)] +=
                static_cast<float>(cover(piece, Eigen::Vector2d(du + k, dv)));
        }
    }
    for (float& value : coverage) value = std::clamp(value, 0.0F, 1.0F);
}

void ScratchPath::cover_at(std::span<const double> du, std::span<const double> dv,
                           std::span<float> coverage) const {
    std::fill(coverage.begin(), coverage.end(), 0.0F);
    for (const Piece& piece : pieces_) {
        const Eigen::Vector2d normal = left_normal(piece.along);
        const double across = half_width_ + edge_.reach_px(), beyond = piece.overhang + edge_.reach_px();
        for (std::size_t k = 0; k < coverage.size(); ++k) {
            const Eigen::Vector2d place(du[k], dv[k]);
            const Eigen::Vector2d start = place - piece.from;
            const double t = piece.along.dot(start);
            if (std::abs(normal.dot(start)) > across || t < -beyond || t > piece.length + beyond) continue;
            coverage[k] += static_cast<float>(cover(piece, place));
        }
    }
    for (float& value : coverage) value = std::clamp(value, 0.0F, 1.0F);
}

}  // namespace fidservo::plant::view

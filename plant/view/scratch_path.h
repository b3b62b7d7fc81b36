// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A scratch: a strip of constant width along a polyline, after blur and pixel integration.
#include "plant/view/edge_profile.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// The path is a series of strips. Neighbouring ones meet on the line that bisects their angle (a mitre), and
/// the first and the last end square, so that the pieces do not overlap and their coverages add up. A piece
/// is the strip cut by a line at each end, and a blurred strip cut by a line is the difference of two
/// bivariate normals: exact for a Gaussian. Where the path turns by more than 120 degrees the strips end
/// square and overlap. A path that crosses itself is counted twice within a blur of the crossing's edges, and
/// at most 1.
class ScratchPath {
  public:
    /// @param points_px  at least two, successive ones distinct, relative to the path's centre
    /// @param sigma_px  standard deviation of blur and pixel together
    ScratchPath(std::span<const Eigen::Vector2d> points_px, double width_px, double sigma_px);

    /// Half the size in px of the image box outside which nothing is covered.
    Eigen::Vector2d half_extent_px() const { return half_extent_px_; }

    /// Coverage of the pixels (du, dv), (du + 1, dv), ... relative to the path's centre, in px.
    void cover(double du, double dv, std::span<float> coverage) const;

    /// Coverage of the pixels at places (du, dv) relative to the path's centre, in px.
    void cover_at(std::span<const double> du, std::span<const double> dv, std::span<float> coverage) const;

  private:
    /// The line that cuts a strip off; the remaining side is that of the inward normal.
    struct Cut {
        Eigen::Vector2d point, inward;
    };
    struct Piece {
        Eigen::Vector2d from, along;  ///< unit vector
        double length;
        double overhang;  ///< how far the mitres extend beyond the ends
        Cut start, end;
    };
    double cut_strip(double offset, const Cut& cut, const Piece& piece, const Eigen::Vector2d& place) const;
    double cover(const Piece& piece, const Eigen::Vector2d& place) const;

    double half_width_, sigma_;
    EdgeProfile edge_;
    std::vector<Piece> pieces_;
    Eigen::Vector2d half_extent_px_;
};

}  // namespace fidservo::plant::view

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A rectangle of black and white cells at any angle: the shape of fiducials, pads and lines.
#include "plant/view/edge_profile.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// Which cells of a grid are inked, row by row, y downwards.
struct CellPattern {
    int columns = 1;
    int rows = 1;
    std::vector<std::uint8_t> inked = {1};
};

/// The coverage of pixels by the inked cells of a grid. In the grid's own frame the coverage is a sum over
/// cells of products of edge profiles in x and y, so corners are exact for an upright grid; for a turned one
/// edges are exact and corners within 0.1 % of the contrast (the pixel's square is not separable in the
/// turned frame).
class CellGrid {
  public:
    static constexpr int max_cells = 10;  ///< along a side

    /// @param size_px  of the whole grid along its own axes
    /// @param angle_rad  of its x axis in the image, from u towards v
    /// @param edge  the profile of an edge at that angle
    CellGrid(CellPattern pattern, const Eigen::Vector2d& size_px, double angle_rad,
             std::shared_ptr<const EdgeProfile> edge);

    /// Half the size in px of the image box outside which nothing is covered.
    Eigen::Vector2d half_extent_px() const;

    /// Coverage of the pixels (du, dv), (du + 1, dv), ... relative to the grid's centre, in px.
    void cover(double du, double dv, std::span<float> coverage) const;

    /// Coverage of the pixels at places (du, dv) relative to the grid's centre, in px.
    void cover_at(std::span<const double> du, std::span<const double> dv, std::span<float> coverage) const;

  private:
    /// A position along one axis where at most one edge is within reach.
    struct Side {
        int first;  ///< index of the cell before the edge, or of the only one
        bool has_edge;
        double beyond;  ///< fraction of the pixel beyond the edge
    };
    Side side(double place_px, double cell_px, double per_cell, int cells) const;
    double covered_by_few(double x_px, double y_px) const;

    /// How much of a pixel lies in each of a few successive cells along one axis.
    struct Weights {
        int first;  ///< index of the first cell; -1: before the grid
        int count;
        double weight[max_cells + 2];
        double room_behind,
            room_ahead;  ///< distance in px before the weights change, while count is 1

        /// Steps along the axis after which the weights must be found anew; at least 1.
        double steps_to_change(double px_per_step) const;
    };
    Weights weights(double place_px, double cell_px, int cells) const;
    double covered(const Weights& across, const Weights& down) const;
    double cell(int column, int row) const { return padded_[(row + 1) * (columns_ + 2) + column + 1]; }

    int columns_, rows_;
    std::vector<float> padded_;  ///< the pattern with a rim of empty cells
    Eigen::Vector2d size_px_, cell_px_, per_cell_;
    double cos_, sin_;
    std::shared_ptr<const EdgeProfile> edge_;
};

}  // namespace fidservo::plant::view

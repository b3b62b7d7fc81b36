// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/cell_grid.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fidservo::plant::view {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

int floor_of(double x) {
    const auto whole = static_cast<int>(x);
    return whole - (x < whole ? 1 : 0);
}

}  // namespace

CellGrid::CellGrid(CellPattern pattern, const Eigen::Vector2d& size_px, double angle_rad,
                   std::shared_ptr<const EdgeProfile> edge)
    : columns_(pattern.columns),
      rows_(pattern.rows),
      padded_(static_cast<std::size_t>(pattern.columns + 2) * (pattern.rows + 2), 0.0F),
      size_px_(size_px),
      cell_px_(size_px.x() / pattern.columns, size_px.y() / pattern.rows),
      per_cell_(cell_px_.cwiseInverse()),
      cos_(std::cos(angle_rad)),
      sin_(std::sin(angle_rad)),
      edge_(std::move(edge)) {
    FIDSERVO_DEMAND(columns_ <= max_cells && rows_ <= max_cells);
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            padded_[(row + 1) * (columns_ + 2) + column + 1] = pattern.inked[row * columns_ + column];
        }
    }
}

Eigen::Vector2d CellGrid::half_extent_px() const {
    const Eigen::Vector2d half = 0.5 * size_px_ + Eigen::Vector2d::Constant(edge_->reach_px());
    const double c = std::abs(cos_), s = std::abs(sin_);
    return {c * half.x() + s * half.y(), s * half.x() + c * half.y()};
}

CellGrid::Weights CellGrid::weights(double place_px, double cell_px, int cells) const {
    const double reach = edge_->reach_px();
    const double per_cell = 1.0 / cell_px;
    // Edges first_edge .. last_edge (edge k lies before cell k) are within reach.
    const int first_edge = std::clamp(-floor_of((reach - place_px) * per_cell), 0, cells + 1);
    const int last_edge = std::clamp(floor_of((place_px + reach) * per_cell), -1, cells);
    Weights result{};
    result.first = first_edge - 1;
    result.count = 1;
    if (last_edge < first_edge) {
        result.weight[0] = 1.0;
        result.room_behind = first_edge == 0 ? unlimited : place_px - reach - (first_edge - 1) * cell_px;
        result.room_ahead = first_edge > cells ? unlimited : first_edge * cell_px - reach - place_px;
        return result;
    }
    double beyond_last = 1.0;
    for (int k = first_edge; k <= last_edge; ++k) {
        const double beyond = (*edge_)(place_px - k * cell_px);
        result.weight[k - first_edge] = beyond_last - beyond;
        beyond_last = beyond;
    }
    result.count = last_edge - first_edge + 2;
    result.weight[result.count - 1] = beyond_last;
    return result;
}

double CellGrid::Weights::steps_to_change(double px_per_step) const {
    if (px_per_step == 0.0) return unlimited;
    if (count > 1) return 1.0;
    const double room = px_per_step > 0.0 ? room_ahead : room_behind;
    return 1.0 + std::floor(std::max(room, 0.0) / std::abs(px_per_step));
}

double CellGrid::covered(const Weights& across, const Weights& down) const {
    double sum = 0.0;
    for (int j = 0; j < down.count; ++j) {
        double row_sum = 0.0;
        for (int i = 0; i < across.count; ++i) {
            row_sum += across.weight[i] * cell(across.first + i, down.first + j);
        }
        sum += down.weight[j] * row_sum;
    }
    return sum;
}

CellGrid::Side CellGrid::side(double place_px, double cell_px, double per_cell, int cells) const {
    const int edge = std::clamp(floor_of(place_px * per_cell + 0.5), 0, cells);
    const double distance = place_px - edge * cell_px;
    const double reach = edge_->reach_px();
    if (distance <= -reach) return {edge - 1, false, 0.0};
    if (distance >= reach) return {edge, false, 0.0};
    return {edge - 1, true, (*edge_)(distance)};
}

/// covered() where cells are so large that at most four of them meet within reach.
double CellGrid::covered_by_few(double x_px, double y_px) const {
    const Side x = side(x_px, cell_px_.x(), per_cell_.x(), columns_);
    const Side y = side(y_px, cell_px_.y(), per_cell_.y(), rows_);
    const float* const here = padded_.data() + (y.first + 1) * (columns_ + 2) + x.first + 1;
    const auto along_x = [&](const float* cells) -> double {
        if (!x.has_edge) return cells[0];
        return (1.0 - x.beyond) * cells[0] + x.beyond * cells[1];
    };
    if (!y.has_edge) return along_x(here);
    return (1.0 - y.beyond) * along_x(here) + y.beyond * along_x(here + columns_ + 2);
}

void CellGrid::cover_at(std::span<const double> du, std::span<const double> dv,
                        std::span<float> coverage) const {
    const bool cells_are_large = cell_px_.minCoeff() >= 2.0 * edge_->reach_px();
    const Eigen::Vector2d outside = 0.5 * size_px_ + Eigen::Vector2d::Constant(edge_->reach_px());
    for (std::size_t k = 0; k < coverage.size(); ++k) {
        const double across = cos_ * du[k] + sin_ * dv[k], down = cos_ * dv[k] - sin_ * du[k];
        coverage[k] = 0.0F;
        if (std::abs(across) >= outside.x() || std::abs(down) >= outside.y()) continue;
        const double x = across + 0.5 * size_px_.x(), y = down + 0.5 * size_px_.y();
        coverage[k] = static_cast<float>(
            cells_are_large ? covered_by_few(x, y)
                            : covered(weights(x, cell_px_.x(), columns_), weights(y, cell_px_.y(), rows_)));
    }
}

void CellGrid::cover(double du, double dv, std::span<float> coverage) const {
    const double x0 = cos_ * du + sin_ * dv + 0.5 * size_px_.x();
    const double y0 = -sin_ * du + cos_ * dv + 0.5 * size_px_.y();
    const auto pixels = static_cast<double>(coverage.size());
    Weights across{}, down{};
    double across_until = 0.0, down_until = 0.0;
    for (double k = 0.0; k < pixels;) {
        if (k >= across_until) {
            across = weights(x0 + cos_ * k, cell_px_.x(), columns_);
            across_until = k + across.steps_to_change(cos_);
        }
        if (k >= down_until) {
            down = weights(y0 - sin_ * k, cell_px_.y(), rows_);
            down_until = k + down.steps_to_change(-sin_);
        }
        const double end = std::min({across_until, down_until, pixels});
        std::fill_n(coverage.begin() + static_cast<std::ptrdiff_t>(k), static_cast<std::size_t>(end - k),
                    static_cast<float>(covered(across, down)));
        k = end;
    }
}

}  // namespace fidservo::plant::view

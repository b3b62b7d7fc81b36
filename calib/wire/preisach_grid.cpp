// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/preisach_grid.h"

#include "core/demand.h"

#include <algorithm>

namespace fidservo::calib {

namespace {

/// The part of cell i that lies below an input.
double covered(const PreisachGrid& grid, std::size_t i, double input) {
    return std::clamp((input - node_of(grid, i)) / grid.step, 0.0, 1.0);
}

std::size_t cell_below(const PreisachGrid& grid, double input) {
    const double position = (input - grid.low) / grid.step;
    return static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(grid.nodes - 2)));
}

}  // namespace

FodTable table_of_density(const PreisachGrid& grid, std::span<const double> weights) {
    FIDSERVO_DEMAND(grid.nodes >= 2 && weights.size() == cell_count(grid));
    std::vector<double> nodes(grid.nodes), triangle;
    for (std::size_t i = 0; i < grid.nodes; ++i) nodes[i] = node_of(grid, i);
    triangle.reserve(grid.nodes * (grid.nodes + 1) / 2);
    std::vector<double> column(grid.nodes, 0.0);  // sum of w_pq over p < i, per q
    for (std::size_t i = 0; i < grid.nodes; ++i) {
        double sum = 0.0;
        triangle.push_back(sum);
        for (std::size_t q = 0; q < i; ++q) {
            column[q] += weights[cell_index(i - 1, q)];
            triangle.push_back(sum += column[q]);
        }
    }
    return {std::move(nodes), std::move(triangle)};
}

SwitchedCells::SwitchedCells(const PreisachGrid& grid, double first_input)
    : grid_(grid),
      frame_({grid.low, node_of(grid, grid.nodes - 1)}, {0.0, 0.0, 0.0}),
      memory_(preisach_start(frame_, first_input)) {}

void SwitchedCells::move(double input) {
    preisach_step(frame_, memory_, input);
}

void SwitchedCells::shares(std::span<double> per_cell) const {
    FIDSERVO_DEMAND(per_cell.size() == cell_count(grid_));
    std::fill(per_cell.begin(), per_cell.end(), 0.0);
    double valley = grid_.low;
    for (const PreisachLoop& loop : memory_.loops) {
        add(loop.peak_degC, valley, loop.valley_degC, per_cell);
        valley = loop.valley_degC;
    }
    add(memory_.last_peak_degC, valley, memory_.temp_degC, per_cell);
}

/// Adds the fraction of each cell with relays that switch off between `from` and `to` and on below `peak`.
void SwitchedCells::add(double peak, double from, double to, std::span<double> per_cell) const {
    if (to <= grid_.low || to <= from) return;
    const std::size_t last_q = cell_below(grid_, to), last_p = cell_below(grid_, peak);
    for (std::size_t q = cell_below(grid_, from); q <= last_q; ++q) {
        const double width = covered(grid_, q, to) - covered(grid_, q, from);
        per_cell[cell_index(q, q)] += width;
        for (std::size_t p = q + 1; p <= last_p; ++p)
            per_cell[cell_index(p, q)] += width * covered(grid_, p, peak);
    }
}

}  // namespace fidservo::calib

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A Preisach density on the grid of a FodTable (core/preisach.h), and which part of it an input has switched
// on.
//
// The table f(a, b) is the sum of the weights of all relays that switch on at most at a and off at most at b:
//
//     f(t_i, t_j) = sum over p < i, q < j of w_pq,        w_pq >= 0,  q <= p
//
// w_pq is distributed uniformly over the cell [t_p, t_p+1] x [t_q, t_q+1]; on the diagonal, where the table
// is linear in the lower triangle of a cell, it lies on the line a = b: these are relays without hysteresis,
// the reversible part. The model's output is then linear in the weights: the sum of w_pq times the share of
// the cell that is on.
#include "core/preisach.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::calib {

/// n equally spaced nodes, in the unit of the input.
struct PreisachGrid {
    double low;
    double step;
    std::size_t nodes;  ///< >= 2
};

inline double node_of(const PreisachGrid& grid, std::size_t i) {
    return grid.low + grid.step * static_cast<double>(i);
}

inline std::size_t cell_count(const PreisachGrid& grid) {
    return (grid.nodes - 1) * grid.nodes / 2;
}

/// Index of a cell: rows of equal upper switching input p, and q <= p within a row.
inline std::size_t cell_index(std::size_t p, std::size_t q) {
    return p * (p + 1) / 2 + q;
}

/// The table that corresponds to the weights; f(low, low) = 0.
FodTable table_of_density(const PreisachGrid& grid, std::span<const double> weights);

/// Tracks which part of each cell an input has switched on, from negative saturation on.
class SwitchedCells {
  public:
    SwitchedCells(const PreisachGrid& grid, double first_input);

    void move(double input);

    /// The fraction of each cell that is on, 0..1.
    void shares(std::span<double> per_cell) const;

  private:
    void add(double peak, double from, double to, std::span<double> per_cell) const;

    PreisachGrid grid_;
    FodTable frame_;  ///< without density: only its memory is used
    PreisachMemory memory_;
};

}  // namespace fidservo::calib

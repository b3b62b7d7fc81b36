// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/preisach_plane.h"

#include <algorithm>

namespace fidservo::reference {

namespace {

/// Mass of the strips above the stair at an index.
double above_mm(const PreisachPlane& plane, const std::vector<Stair>& stairs, std::size_t index) {
    if (index == 0) return plane.always_on_mm();
    const Stair& outer = stairs[index - 1];
    return outer.outer_mm + plane.strip_mm(stairs[index].peak_degC, outer.peak_degC, outer.valley_degC);
}

}  // namespace

PreisachPlane::PreisachPlane(const FodTable& table)
    : cells_(table.nodes() - 1),
      low_degC_(table.low_degC()),
      step_degC_(table.step_degC()),
      always_on_mm_(table.node_mm(0, 0)),
      row_mass_mm_(cells_ * (cells_ + 1)),
      diagonal_mass_mm_(cells_) {
    for (std::size_t row = 0; row < cells_; ++row) {
        double mass_mm = table.node_mm(row + 1, 0) - table.node_mm(row, 0);
        for (std::size_t column = 0; column <= row; ++column) {
            row_mass_mm_[row * (cells_ + 1) + column] = mass_mm;
            if (column < row)
                mass_mm += table.node_mm(row + 1, column + 1) - table.node_mm(row, column + 1) -
                           table.node_mm(row + 1, column) + table.node_mm(row, column);
        }
        diagonal_mass_mm_[row] = table.node_mm(row + 1, row + 1) - table.node_mm(row + 1, row);
    }
}

std::size_t PreisachPlane::cell_of(double temp_degC) const {
    const auto cell = static_cast<std::ptrdiff_t>((temp_degC - low_degC_) / step_degC_);
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(cell, 0, static_cast<std::ptrdiff_t>(cells_) - 1));
}

double PreisachPlane::strip_mm(double low_degC, double high_degC, double down_degC) const {
    if (high_degC <= low_degC) return 0.0;
    const std::size_t column = cell_of(down_degC);
    const double column_share = (down_degC - edge_of(column)) / step_degC_;
    const std::size_t last_row = cell_of(high_degC);
    double mass_mm = 0.0;
    for (std::size_t row = cell_of(low_degC); row <= last_row; ++row) {
        const double bottom = std::max(low_degC, edge_of(row));
        const double top = std::min(high_degC, edge_of(row + 1));
        const double row_share = (top - bottom) / step_degC_;
        const double* const left_mm = &row_mass_mm_[row * (cells_ + 1)];
        if (row > column) {
            mass_mm += row_share * (left_mm[column] + column_share * (left_mm[column + 1] - left_mm[column]));
        } else {
            const double on_line = std::max(0.0, std::min(top, down_degC) - bottom) / step_degC_;
            mass_mm += row_share * left_mm[row] + on_line * diagonal_mass_mm_[row];
        }
    }
    return mass_mm;
}

Staircase heated_to(const PreisachPlane& plane, double temp_degC) {
    constexpr std::size_t usual_depth = 64;
    const double there = std::clamp(temp_degC, plane.low_degC(), plane.high_degC());
    Staircase staircase;
    staircase.stairs.reserve(usual_depth);
    staircase.stairs.push_back({there, there, 0.0});
    return staircase;
}

void move_to(const PreisachPlane& plane, Staircase& staircase, double temp_degC) {
    std::vector<Stair>& stairs = staircase.stairs;
    const double there = std::clamp(temp_degC, plane.low_degC(), plane.high_degC());
    const double here = stairs.back().valley_degC;
    if (there > here) {
        if (stairs.back().peak_degC > here) {
            stairs.back().outer_mm = above_mm(plane, stairs, stairs.size() - 1);
            stairs.push_back({there, there, 0.0});
        }
        while (stairs.size() > 1 && stairs[stairs.size() - 2].peak_degC <= there) stairs.pop_back();
        stairs.back() = {there, there, 0.0};
    } else if (there < here) {
        while (stairs.size() > 1 && stairs[stairs.size() - 2].valley_degC >= there) stairs.pop_back();
        stairs.back().valley_degC = there;
    }
}

double contraction_mm(const PreisachPlane& plane, const Staircase& staircase) {
    const std::vector<Stair>& stairs = staircase.stairs;
    const Stair& last = stairs.back();
    return above_mm(plane, stairs, stairs.size() - 1) +
           plane.strip_mm(plane.low_degC(), last.peak_degC, last.valley_degC);
}

}  // namespace fidservo::reference

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's hysteresis as Preisach's relays on their half plane.
//
// A relay (a, b), b <= a, switches on when the temperature rises above a, off when it falls below b. The
// contraction is the mass of the relays that are on. The table of first-order descending curves gives the
// masses: f(a, b) is the mass of the relays with a' <= a and b' <= b. So a cell of the grid off the diagonal
// holds the mixed second difference of its four nodes, spread evenly (f bilinear); a cell on the diagonal,
// where f is linear on its lower triangle, holds its mass on the diagonal line itself, relays without
// hysteresis; and relays that are already on at the table's lowest b lie on that edge.
//
// The relays that are on lie below a staircase of the remembered extrema, outermost first:
//
//     step k:  peak_{k+1} < a <= peak_k,  b <= valley_k
//
// and the contraction is the sum of the masses of its strips. Source: Mayergoyz, "Mathematical Models of
// Hysteresis", Springer, 1991, chapter 1 (geometric interpretation).
#include "core/preisach.h"

#include <cstddef>
#include <vector>

namespace fidservo::reference {

/// The mass of the relays in mm of contraction, on a regular grid. Immutable.
class PreisachPlane {
  public:
    explicit PreisachPlane(const FodTable& table);

    /// Mass in mm of the relays with low < a <= high and b <= down, all in degC within the grid.
    double strip_mm(double low_degC, double high_degC, double down_degC) const;

    double low_degC() const { return low_degC_; }
    double high_degC() const { return low_degC_ + step_degC_ * static_cast<double>(cells_); }
    double always_on_mm() const { return always_on_mm_; }

  private:
    std::size_t cell_of(double temp_degC) const;
    double edge_of(std::size_t cell) const { return low_degC_ + step_degC_ * static_cast<double>(cell); }

    std::size_t cells_;
    double low_degC_, step_degC_;
    double always_on_mm_;
    /// [row * (cells + 1) + column]: mass of the row's relays with b up to the column's lower edge
    std::vector<double> row_mass_mm_;
    std::vector<double> diagonal_mass_mm_;
};

/// One stair: the relays with a between the next stair's peak and this one's are on if b <= valley.
struct Stair {
    double peak_degC;
    double valley_degC;
    double outer_mm;  ///< mass of the strips of all outer stairs; not kept for the last one
};

/// What the relays remember. The last stair's valley is the present temperature; while heating, its peak is,
/// too.
struct Staircase {
    std::vector<Stair> stairs;
};

/// Relays after heating from negative saturation.
Staircase heated_to(const PreisachPlane& plane, double temp_degC);

/// Moves monotonically to a temperature, which is clamped to the grid.
void move_to(const PreisachPlane& plane, Staircase& staircase, double temp_degC);

/// Mass in mm of the relays that are on.
double contraction_mm(const PreisachPlane& plane, const Staircase& staircase);

}  // namespace fidservo::reference

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The classical Preisach model of the shape-memory-alloy wire: temperature -> contraction.
//
// It is given as a table of first-order descending (FOD) curves, f(a, b) = contraction after heating from
// negative saturation to the peak temperature a and cooling to b <= a. With the remembered maxima
// M1 > M2 > ... and minima m1 < m2 < ... (a pair is wiped out when the temperature passes it), and
// m0 = negative saturation,
//
//     x = sum over k of  f(Mk, mk) - f(Mk, mk-1)                          (the published stage, eq. 8)
//
// While heating, the present temperature is the last maximum and contributes f(T, T) - f(T, m_last).
// Source: Mayergoyz, "Mathematical Models of Hysteresis", 1991, and the publication on the stage.
#include <cstddef>
#include <optional>
#include <vector>

namespace fidservo {

/// The FOD curves f(a, b), in mm, at the nodes of a regular grid of temperatures. Between nodes they are
/// interpolated bilinearly; in a cell on the diagonal a = b, linearly on the triangle b <= a. Temperatures
/// outside the grid are clamped to it. Immutable.
class FodTable {
  public:
    /// @param nodes_degC  n ascending, equally spaced temperatures, n >= 2
    /// @param lower_triangle_mm  f(nodes[i], nodes[j]) for i = 0..n-1, j = 0..i, row by row (n(n+1)/2 values)
    FodTable(std::vector<double> nodes_degC, std::vector<double> lower_triangle_mm);

    /// f(peak, temp) in mm; temp is clamped to at most peak.
    double contraction_mm(double peak_degC, double temp_degC) const;

    /// The first temperature of the grid.
    double low_degC() const { return low_degC_; }
    /// The last temperature of the grid.
    double high_degC() const { return high_degC_; }
    /// Distance between neighbouring nodes of the grid.
    double step_degC() const { return step_degC_; }
    /// How many temperatures the grid has.
    std::size_t nodes() const { return nodes_; }
    /// f at positive saturation: the full stroke.
    double stroke_mm() const { return contraction_mm(high_degC_, high_degC_); }
    /// f at two nodes, which are given by their indices in the grid.
    double node_mm(std::size_t peak, std::size_t temp) const { return square_mm_[peak * nodes_ + temp]; }

  private:
    std::size_t nodes_;
    double low_degC_, high_degC_, step_degC_, nodes_per_degC_;
    std::vector<double> square_mm_;  ///< full square, row = peak; above the diagonal f(a, a)
};

/// One remembered loop: heated to `peak`, then cooled to `valley`.
struct PreisachLoop {
    double peak_degC;       ///< where it was turned from heating to cooling
    double valley_degC;     ///< where it was turned from cooling to heating
    double contraction_mm;  ///< of this and all outer loops together
};

/// What the wire remembers. A plain value: copying it is a snapshot.
struct PreisachMemory {
    std::vector<PreisachLoop> loops;  ///< outermost first; peaks fall, valleys rise
    double temp_degC;                 ///< present temperature
    double last_peak_degC;  ///< maximum from which the wire cools now; equal to temp_degC while heating
    double contraction_mm;  ///< present contraction
};

/// A wire heated from negative saturation to `temp_degC`. Room for the usual depth of memory is reserved, so
/// that steps do not allocate.
PreisachMemory preisach_start(const FodTable& table, double temp_degC);

/// Moves the wire to a new temperature (monotonically from the present one). Amortised constant cost: each
/// step pushes at most one loop, and loops that are passed are dropped for good.
/// @return the contraction in mm
double preisach_step(const FodTable& table, PreisachMemory& memory, double temp_degC);

/// The contraction in mm that a monotonic move to `temp_degC` would give, without moving.
double preisach_peek(const FodTable& table, const PreisachMemory& memory, double temp_degC);

/// The inverse model: the temperature in degC, nearest to the present one, at which a monotonic move reaches
/// `contraction_mm`. Empty if the table's temperature range cannot reach it.
std::optional<double> preisach_inverse(const FodTable& table, const PreisachMemory& memory,
                                       double contraction_mm);

}  // namespace fidservo

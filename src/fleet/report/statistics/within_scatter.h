// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The scatter of the diagnoses of a unit that does not change, beyond their own standard errors.
//
//     y_ut = level_u + e_ut,   e_ut ~ N(0, phi_u (s_ut^2 + sigma^2)),   nu / phi_u ~ chi^2(nu)
//
// s is the diagnosis's own standard error; sigma an additional scatter, common to all units (room temperature
// changes, fits end in neighbouring minima); phi the factor, of mean about 1, by which the variance of unit u
// differs from that of other units. The level is eliminated by the restricted likelihood, which uses only the
// m = n - 1 contrasts of a unit's n diagnoses:
//
//     log L_u = log G((nu + m)/2) - log G(nu/2) - m/2 log(pi nu) - 1/2 sum log v_t - 1/2 log sum 1/v_t
//               - (nu + m)/2 log(1 + S_u/nu),     v = s^2 + sigma^2,   S_u = sum (y - mean)^2 / v
//
// If some diagnoses of a unit do not name the quantity, the likelihood has their factors of censored.h, the
// level is integrated out numerically, and phi is summed over. Units without a diagnosis that names the
// quantity give no information.
//
// If many units have changed at one time, the series of each unit is cut there, and each part counts as a
// separate unit (common_changes.h).
//
// sigma maximises the log likelihood summed over units; nu the sum over units and quantities. A unit is
// judged with the scatter of the other units, since its own drift would otherwise count as scatter. Sources:
// restricted likelihood: Patterson, Thompson, Biometrika 58, 1971; scales that are drawn from an inverse
// chi^2: Smyth, Stat. Appl. Genet. Mol. Biol. 3, 2004.
#include "src/fleet/report/statistics/point.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::fleet {

/// The scatter of a unit that does not change.
struct Scatter {
    double std = 0.0;      ///< sigma, floors
    double degrees = 0.0;  ///< nu; 0: nothing is known about phi in advance
};

/// The values of phi over which sums are taken instead of integrals.
inline constexpr std::array scatter_scales{0.25, 0.5, 1.0, 2.0, 4.0};

/// The logarithms of their weights, by the density of log(phi) with nu / phi ~ chi^2(nu); for nu = 0 all are
/// equal.
std::array<double, scatter_scales.size()> log_weights_of_scales(double degrees);

/// The scatter of one quantity in all units.
class WithinScatter {
  public:
    /// The points of a unit, divided into stretches within each of which its level is constant.
    using Stretches = std::vector<std::vector<Point>>;

    /// @param units  by time
    explicit WithinScatter(std::span<const Stretches> units);

    /// The scatter from all units.
    /// @param common  result of common_scatter()
    Scatter of_all(const Scatter& common) const;
    /// The scatter from all units but one, and without those left out.
    Scatter without(std::size_t unit, const Scatter& common) const;
    /// Leaves a unit out from now on, since it was found to change.
    void leave_out(std::size_t unit);

  private:
    void add_to_last_unit(const std::vector<Point>& stretch);

    friend Scatter common_scatter(std::span<const WithinScatter> quantities,
                                  std::span<const std::optional<std::size_t>> unit);
    static Scatter best(const std::vector<double>& sum, double contrasts, const Scatter& common);

    std::vector<std::vector<double>> of_unit_;  ///< log L_u over the grid of sigma and nu
    std::vector<double> contrasts_of_unit_;
    std::vector<double> unnamed_of_unit_,
        /// For each unit, the number of points that are not named, and the sum of their variances.
        unnamed_variance_of_unit_;
    std::vector<double> sum_;
    double contrasts_ = 0.0;
};

/// The scatter estimated from all quantities together. nu is used for every quantity, since how much phi
/// differs between units depends on units and rooms rather than on effects. It maximises the sum of the log
/// likelihoods over quantities, each with its own most likely sigma, and is at most the total number of
/// contrasts. sigma is used for quantities with fewer than ten contrasts in other units. If all quantities
/// together have fewer than ten contrasts, but there are ten diagnoses of other units that do not name the
/// quantity, sigma is the r.m.s. standard deviation of these points as normal distributions (as_normal()).
/// @param unit  of each quantity the number of the unit that is to be judged and does not count; none where
/// it
///              has no such unit
Scatter common_scatter(std::span<const WithinScatter> quantities,
                       std::span<const std::optional<std::size_t>> unit);

}  // namespace fidservo::fleet

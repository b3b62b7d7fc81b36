// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// By how much a unit that does not change scatters from one diagnosis to the next beyond what each
// diagnosis says that it is uncertain by.
//
//     y_ut = level_u + e_ut,   e_ut ~ N(0, phi_u (s_ut^2 + sigma^2)),   nu / phi_u ~ chi^2(nu)
//
// s is the diagnosis's own standard error; sigma what comes to it in every unit (rooms are warmer and colder,
// fits end in neighbouring valleys); phi how much more or less a unit scatters than others, of mean about 1.
// The level is removed by using its contrasts alone (restricted likelihood), of which there are m = n - 1:
//
//     log L_u = log G((nu + m)/2) - log G(nu/2) - m/2 log(pi nu) - 1/2 sum log v_t - 1/2 log sum 1/v_t
//               - (nu + m)/2 log(1 + S_u/nu),     v = s^2 + sigma^2,   S_u = sum (y - mean)^2 / v
//
// Where some diagnoses of a unit do not name the quantity, their factors are those of censored.h, the level
// is integrated over numerically, and phi is summed over. Units of which no diagnosis names it say nothing.
//
// Where many units have changed at one time, each stretch between is as if of a unit of its own
// (common_changes.h).
//
// sigma maximises the sum over units; nu that over all quantities, too. A unit is judged by what the others
// say: were it to drift, its own drift would pass for scatter. Sources: restricted likelihood: Patterson,
// Thompson, Biometrika 58, 1971; scales that are drawn from an inverse chi^2: Smyth, Stat. Appl. Genet. Mol.
// Biol. 3, 2004.
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
    double degrees = 0.0;  ///< nu; 0: the scale has no prior knowledge
};

/// The values of phi over which sums are taken instead of integrals.
inline constexpr std::array scatter_scales{0.25, 0.5, 1.0, 2.0, 4.0};

/// The logarithms of their weights, by the density of log(phi) with nu / phi ~ chi^2(nu); for nu = 0 all are
/// equal.
std::array<double, scatter_scales.size()> log_weights_of_scales(double degrees);

/// The scatter of one quantity in all units.
class WithinScatter {
  public:
    /// The points of a unit in stretches, in each of which it has one level.
    using Stretches = std::vector<std::vector<Point>>;

    /// @param units  by time
    explicit WithinScatter(std::span<const Stretches> units);

    /// The scatter from all units.
    /// @param common  of common_scatter()
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

/// What all quantities together say. nu is that of every quantity: how far units' scales differ is a matter
/// of units and rooms rather than of effects. It maximises the sum over quantities, each with its own
/// likeliest sigma, and is at most the number of all contrasts. sigma is that of quantities that others than
/// the unit hardly have, of fewer than ten contrasts. Where there are no ten of all quantities, but ten
/// diagnoses of others that name nothing, units scatter by no more than what those pass over: sigma is their
/// std.
/// @param unit  of each quantity the number of the unit that is to be judged and does not count; none where
/// it
///              has no such unit
Scatter common_scatter(std::span<const WithinScatter> quantities,
                       std::span<const std::optional<std::size_t>> unit);

}  // namespace fidservo::fleet

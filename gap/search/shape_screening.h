// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which effect with a shape of its own explains most beside all smooth ones.
//
// Errors e of windows w change nearly linearly with sizes: e + J x of all that is there already, e + J x + c
// y with another setting, whose shape is a point of its grid. What that gains over the best x alone follows
// without a fit, from the normal equations of the windows weighted as their loss is (gap/fit/fit.h):
//
//     H = J' W J + P,  x = -H^-1 J' W e,   h = c' W c + p - c' W J H^-1 J' W c,   g = c' W (e + J x)
//     gain = g^2 / (2 h) at y = -g / h,  or less where that is beyond a bound
//
// P and p expect sizes of a few typical ones. Source: orthogonal forward regression, Chen, Billings, Luo,
// International Journal of Control 50, 1989.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// A candidate at a point of its grid, as large as it says.
struct GridPoint {
    const Candidate* candidate;
    std::vector<double> shape;
};

/// All points of their grids.
std::vector<GridPoint> grid_of(std::span<const Candidate* const> candidates);

/// A setting to begin a fit from.
struct ScreenedShape {
    const Candidate* candidate;
    plant::EffectSetting setting;  ///< at the size y, within its bounds
    double gain;                   ///< loss that it saves, to first order
};

/// Whether a candidate has parameters that say neither how large it is nor what it may be without.
bool has_a_shape(const Candidate& candidate);

/// A setting as large as some typical ones: 0 is none, 1 as the candidate's shape states it.
plant::EffectSetting of_size(const Candidate& candidate, const std::vector<double>& shape,
                             double typical_sizes);

/// Of each candidate the point that gains most, best first.
/// @param predict   errors with some settings beside what is known
/// @param windows, counted  of which the loss is
/// @param others    settings that may change their sizes and shapes freely
/// @param scale_floors, expected_sizes  as FitOptions
std::vector<ScreenedShape> screened_shapes(const Predict& predict, std::span<const Window> windows,
                                           const Wanted& counted, const Hypothesis& others,
                                           std::span<const GridPoint> grid, double scale_floors,
                                           double expected_sizes);

}  // namespace fidservo::gap

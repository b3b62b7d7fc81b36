// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Screening: which effects with shape parameters would save most loss in addition to all smooth effects.
//
// Changes x of the parameters of the present explanation change its errors e nearly linearly, to e + J x; a
// further setting of size y, whose shape is a point of its grid, changes them to e + J x + c y. The loss that
// it saves compared with the best x alone follows without a fit, from normal equations with the windows'
// weights W in the loss (gap/fit/fit.h):
//
//     H = J' W J + P,  x = -H^-1 J' W e,   h = c' W c + p - c' W J H^-1 J' W c,   g = c' W (e + J x)
//     gain = g^2 / (2 h) at y = -g / h,  or less where that is beyond a bound
//
// P and p are the precisions of the prior, with a standard deviation of a few typical sizes about zero.
// Source: orthogonal forward regression, Chen, Billings, Luo, International Journal of Control 50, 1989.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// A candidate at a point of its grid, with the sizes stated there.
struct GridPoint {
    const Candidate* candidate;
    std::vector<double> shape;
};

/// All points of the candidates' grids.
std::vector<GridPoint> grid_of(std::span<const Candidate* const> candidates);

/// A candidate with a setting from which its fit may begin.
struct ScreenedShape {
    const Candidate* candidate;
    plant::EffectSetting setting;  ///< at the size y, within its bounds
    double gain;                   ///< loss saved in addition to those before it, with errors linearised
};

/// Whether a candidate has parameters that are neither sizes nor choices nor optional.
bool has_a_shape(const Candidate& candidate);

/// A setting with this many typical sizes: 0 is no effect, 1 the sizes stated in `shape`.
plant::EffectSetting of_size(const Candidate& candidate, const std::vector<double>& shape,
                             double typical_sizes);

/// Forward selection: the candidates in the order in which each saves most loss in addition to those before
/// it, at the best point of its grid. Candidates that save nothing are left out.
/// @param predict   errors under what is known, with the given settings in addition
/// @param windows, counted  the windows whose loss is to be reduced
/// @param others  settings of the present explanation, all of whose parameters may change
/// @param scale_floors, expected_sizes  as in FitOptions
std::vector<ScreenedShape> screened_shapes(const Predict& predict, std::span<const Window> windows,
                                           const Wanted& counted, const Hypothesis& others,
                                           std::span<const GridPoint> grid, double scale_floors,
                                           double expected_sizes);

}  // namespace fidservo::gap

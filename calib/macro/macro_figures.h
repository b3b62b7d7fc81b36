// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The usual parameters of a macro stage, K, tau, a0, delta, F and b, from the fitted speeds, and their
// required accuracy.
#include "calib/heterogeneity.h"
#include "calib/macro/macro_fit.h"

namespace fidservo::calib {

enum class MacroFigure { gain, time_constant, zone_offset, zone_slope, friction, drive_offset };
inline constexpr int macro_figure_count = 6;
using MacroFigures = Eigen::Matrix<double, macro_figure_count, 1>;
using MacroFigureGradient = Eigen::Matrix<double, macro_figure_count, macro_parameter_count>;

/// @param unit_V  the command at which the effective voltage is 1 V
/// @param threshold_V  of the dead zone, at which a0 is stated
MacroFigures figures_of(const MacroMotion& motion, double unit_V, double threshold_V);

/// Derivatives of the figures by the parameters, central differences.
MacroFigureGradient figure_gradient(const MacroMotion& motion, double unit_V, double threshold_V);

/// The standard errors above which a figure is refused as useless: a fifth of its value for gain, time
/// constant and slope; 0.2 V for the effective voltage at the threshold; a fifth of the driving command for
/// friction and offset.
MacroFigures largest_useful_std(const MacroFigures& value, double fastest_mm_per_s, double drive_V);

}  // namespace fidservo::calib

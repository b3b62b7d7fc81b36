// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numbers that mean the same in several rooms. docs/constants.md says why each has its value.
#include <cstddef>
#include <numbers>

namespace fidservo::gap {

/// In a whole.
inline constexpr double percent = 100.0;
/// The larger part of 1, which is to it as the smaller part is to the larger.
inline constexpr double golden_section = std::numbers::phi - 1.0;

/// The variance of a uniform distribution is its width squared, divided by this; so is that of what rounding
/// hides, in steps squared.
inline constexpr double uniform_divisor = 12.0;

/// Two rows, frames or points of a grid follow each other if they are not more than so many steps apart.
inline constexpr double most_steps_apart = 1.5;
/// A longer pause is an interruption.
inline constexpr double longest_pause_s = 0.1;
/// Rows over which a velocity, a rate or an offset is found at a glance.
inline constexpr std::size_t glance_rows = 20;

/// What shares of a gap, of a gain or of anything else are called: nearly all of it, the larger part, a small
/// part, hardly any, next to none.
inline constexpr double nearly_all = 0.9, larger_part = 0.5, small_part = 0.1, hardly_any = 0.05,
                        next_to_none = 1e-3;

/// How many of the best of many are tried more closely: where each takes long, usually, and where it takes
/// little.
inline constexpr std::size_t narrow_beam = 3, beam = 4, wide_beam = 8;

/// Standard deviations up to which a difference may be chance.
inline constexpr double chance_stds = 3.0;
/// Mean square error, in floors squared, above which a signal is clearly off.
inline constexpr double clearly_off_square = 4.0;

/// A margin about places on the rail.
inline constexpr double margin_mm = 1.0;

/// What is divided by, or compared with, is at least this.
inline constexpr double next_to_nothing = 1e-9, least_positive = 1e-300;
/// Step of numerical derivatives with respect to a position.
inline constexpr double trial_mm = 0.01;
/// Linear corrections of something nearly linear.
inline constexpr int linear_rounds = 2;

}  // namespace fidservo::gap

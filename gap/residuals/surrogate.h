// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Flexible models (surrogates) of the errors of a part of the signal chain, which name no effect: any
// function of velocity, any function of position, any periodic function of position, and so on. Each is a
// group of regression columns (gap/fit/regression.h). For the carriage the columns describe forces that its
// prediction lacks (gap/balance/carriage_forces.h), for the tags displacements of corners in the image.
#include "gap/balance/period_search.h"
#include "gap/evidence.h"
#include "gap/fit/regression.h"
#include "gap/numbers.h"

#include <string_view>
#include <vector>

namespace fidservo::gap {

/// A quantity on which the remaining errors may depend.
enum class Dependence : std::uint8_t {
    velocity,
    direction,
    position,
    position_period,  ///< period of a force along the rail
    reading_period,   ///< period of the reading itself along the rail
    acceleration,
    command,
    command_change,  ///< the change from the command before to the present one
    command_period,  ///< period in the command, as from a converter's steps
    nothing,         ///< constant errors
    time,
    temperature,
    temperature_before,  ///< temperature behind first-order lags of several time constants
    minor_loops,         ///< on minor loops only: gap/residuals/minor_loops.h
    contraction,         ///< in proportion to the platform's contraction; for tags, any function of it
    contraction_before,  ///< contraction behind a first-order lag of the wire
    platform_place,      ///< any function of the platform's position, the same for heating and cooling
    turns_of_wire,       ///< the contraction since the wire's last reversal
    macro_command,
    position_friction,  ///< a friction that depends on the position
    position_drive,     ///< a periodic dependence of the drive's force on the position
    way_friction,       ///< a friction that depends on the distance covered so far
    standing,           ///< only where the carriage stands: gap/residuals/held_carriage.h
    image_place,
    plate_place,
    plate_turn,  ///< a displacement across the motion in proportion to the position on the plate
    tag_size,
    tag_itself,     ///< a constant displacement of its own for each tag
    motion_by_row,  ///< a tag's motion in the image, by row: gap/residuals/sheared_tags.h
    /// in proportion to velocity: fewer degrees of freedom than `velocity`, which is any function of it
    velocity_share,
    command_share,     ///< in proportion to the command
    position_share,    ///< in proportion to the position
    image_share,       ///< in proportion to the place in the image, from its middle
    warmth_over_time,  ///< the wire's response to heat that changes over time
};

/// The quantity's name in reports; velocity_share has the same name as velocity, and so on.
std::string_view name_of(Dependence dependence);

/// Numbers of hats over what changes slowly, over the wire's states, the platform's places, velocities or
/// commands, and places on the rail.
inline constexpr std::size_t slow_hats = 6, wire_hats = 8, platform_hats = 10, force_hats = 12,
                             rail_hats = 16;
/// Factors that make columns of one group about equally large, since a ridge restrains them together.
inline constexpr double hundredth = 1.0 / percent, thousandth = 1e-3;

struct Surrogate {
    Signal signal;
    std::vector<Column> columns;    ///< the columns' groups are values of Dependence
    std::vector<Column> nuisances;  ///< columns for the initial state of each window
    /// The errors to be explained, and the windows with their ranges in `errors`; empty if both are those of
    /// the signal.
    Errors errors{};
    std::vector<Window> windows{};
    double period_mm = 0.0;  ///< period of Dependence::position_period and reading_period
    /// Groups that explain at least this fraction of what the best group explains count as equally good,
    /// since its lead may be chance. Among these, the group with the fewest columns is preferred.
    double as_good = usually_as_good;
};

/// Whether positions of different recordings may have different zeros: positions were recorded, not counts
/// from an end stop.
bool has_own_zeros(const Evidence& evidence);

/// The distance covered since a recording's first row, for each row of every recording, mm.
std::vector<std::vector<double>> ways_gone_mm(const Evidence& evidence);

/// The surrogate for the forces that the encoder's errors show to be lacking. If recordings have different
/// zeros, periodic columns have a separate phase for each recording; both halves of the data must then have
/// windows of every recording.
/// @param edge_V  as in gap/balance/carriage_forces.h
/// @param period  a possible period of the position; 0 mm: none
Surrogate carriage_surrogate(const Evidence& evidence, const Errors& errors, double edge_V,
                             const PositionPeriod& period);

/// The surrogate for the Hall reading's errors; Surrogate::errors and windows are set.
Surrogate platform_surrogate(const Evidence& evidence, const Errors& errors);

/// The surrogate for the tags' errors. Dependences on a scalar quantity shift the tags along the stage's
/// motion; each window's mean shift in this direction is a nuisance parameter.
/// @param errors  of the tags, in which a period along the rail is searched for
Surrogate tag_surrogate(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap

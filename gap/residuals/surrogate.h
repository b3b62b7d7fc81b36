// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Flexible models of what may be wrong with a stretch of the signal chain, without a name for it: any
// function of velocity, any function of position, any periodic function of position, and so on, each a group
// of columns for gap/fit/regression.h. What acts on the carriage is compared with the forces that its
// prediction lacks (gap/balance/carriage_forces.h). What acts on the image is a pattern of corners.
#include "gap/balance/period_search.h"
#include "gap/evidence.h"
#include "gap/fit/regression.h"

#include <string_view>
#include <vector>

namespace fidservo::gap {

/// What a remainder may depend on.
enum class Dependence : std::uint8_t {
    velocity,
    direction,
    position,
    position_period,  ///< of a force
    reading_period,   ///< of the reading itself
    acceleration,
    command,
    command_change,  ///< what came before the command that is in force
    command_period,  ///< the steps of a converter
    nothing,         ///< a constant
    time,
    temperature,
    temperature_before,  ///< as bodies of some time constants remember it
    minor_loops,         ///< between the wire's end states: gap/residuals/minor_loops.h
    contraction,         ///< of the platform, in proportion to it; of tags, any function of it
    contraction_before,  ///< the wire follows itself with a lag
    platform_place,      ///< any function of it, the same for heating and cooling
    turns_of_wire,       ///< the way since the wire turned
    macro_command,
    position_friction,  ///< a friction that depends on the place
    position_drive,     ///< a periodic share of what the drive pushes with
    way_friction,       ///< a friction that depends on the way gone so far
    standing,           ///< gap/residuals/held_carriage.h
    image_place,
    plate_place,
    plate_turn,  ///< a displacement across the motion in proportion to the place on the plate
    tag_size,
    tag_itself,        ///< a displacement of its own for each tag
    motion_by_row,     ///< of a tag in the image: gap/residuals/sheared_tags.h
    velocity_share,    ///< in proportion to it, where any function of it has too much freedom to be seen
    command_share,     ///< likewise
    position_share,    ///< likewise
    image_share,       ///< likewise of the place in the image, from its middle
    warmth_over_time,  ///< what the wire does with a warmth that changes in time
};

/// Those in proportion to a quantity have the name of any function of it.
std::string_view name_of(Dependence dependence);

struct Surrogate {
    Signal signal;
    std::vector<Column> columns;    ///< group: a Dependence
    std::vector<Column> nuisances;  ///< of the state at a window's start
    Errors errors{};                ///< that the columns are to explain, where they are not the signal's
    double period_mm = 0.0;         ///< of Dependence::position_period and reading_period
    /// Groups that add this share of what the best one adds, whose lead may be chance, are as good, and of
    /// those the one of fewest columns is preferred.
    double as_good = 0.8;
};

/// Whether each recording may count places from a zero of its own, as where positions were recorded in place
/// of counts from an end stop.
bool has_own_zeros(const Evidence& evidence);

/// Way gone from a recording's first row on, row by row of every recording, mm.
std::vector<std::vector<double>> ways_gone_mm(const Evidence& evidence);

/// Of the forces that the encoder's errors lack. Waves have a phase in each recording where zeros differ: a
/// half must then have stretches of each run.
/// @param edge_V  gap/balance/carriage_forces.h
/// @param period  that position may have; of 0 mm: none
Surrogate carriage_surrogate(const Evidence& evidence, const Errors& errors, double edge_V,
                             const PositionPeriod& period);

/// Of the Hall reading's errors.
Surrogate platform_surrogate(const Evidence& evidence);

/// Of the tags' errors. What has no room of its own here shifts them along the stage's motion; each window's
/// mean along it is a nuisance. @param errors  that the period is looked for in
Surrogate tag_surrogate(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap

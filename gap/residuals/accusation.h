// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The block of the signal chain that causes errors, without naming an effect.
//
// Hall sensor and tags both measure the platform's position, encoder and tags both the carriage's, and the
// tags are predicted from the readings of Hall sensor and encoder. A sensor with a false reading therefore
// causes errors in two predictions: that of its own reading, and that of the tags, along the stage's motion
// only. An actuator causes errors only in the prediction of what it drives (and of the position between two
// counts, which shows weakly in the tags), a camera only in the tags.
#include "gap/evidence.h"
#include "gap/fit/gap_size.h"
#include "gap/residuals/surrogate.h"

#include <optional>
#include <span>
#include <string_view>

namespace fidservo::gap {

/// The pattern of prediction errors. All numbers are r.m.s. errors relative to those expected of a perfect
/// model; 0 for signals that were not recorded.
struct Pattern {
    std::array<double, signal_count> floors{};
    double tag_along = 0.0;    ///< of the component of the tags' corners along the stage's motion
    double tag_across = 0.0;   ///< of the corners' other seven components
    double tag_at_rest = 0.0;  ///< along the motion, in windows in which both stages stand
    /// The sensor whose false readings displace the tags (gap/residuals/false_readings.h).
    std::optional<Signal> displacing = {};
    /// Whether the Hall reading is at its floor under the rig file without any effect, so that the sensor is
    /// not to blame.
    bool is_hall_right = false;
};

Pattern pattern_of(const Evidence& evidence, std::span<const SignalGap> gaps, const Errors& errors);

/// The sensor, encoder or hall, whose false reading causes the pattern: it is off its floor, and its error
/// displaces the tags, whose own errors are along the stage's motion and hardly in other components.
std::optional<Signal> false_sensor(const Pattern& pattern);

/// Whether the tags' errors are only a consequence of the carriage's wrong model: the carriage's predicted
/// position between two counts is wrong.
bool tags_are_innocent(const Pattern& pattern);

/// The part of the rig to which a block belongs: the carriage, the platform on it, or the camera and what it
/// sees.
enum class Stage { macro, micro, camera };

Stage stage_of(std::string_view block);

/// The block of the signal chain that probably causes a signal's errors.
/// @param signal  the signal whose errors are to be explained
/// @param dependence  the quantity on which its errors depend most, if any was found
std::string_view accused_block(const Pattern& pattern, Signal signal, std::optional<Dependence> dependence);

}  // namespace fidservo::gap

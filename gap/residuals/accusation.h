// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which block of the signal chain errors accuse, without a name for what is wrong there.
//
// Hall and tags measure the same place of the platform, encoder and tags the same place of the carriage; the
// tags are predicted from what Hall and encoder have read. So a sensor that reads falsely spoils two
// predictions, its own and the tags', these along the stage's motion alone; an actuator spoils only the
// prediction of what it drives (and the place between two counts, which the tags show a little); a camera
// only the tags.
#include "gap/evidence.h"
#include "gap/fit/gap_size.h"
#include "gap/residuals/surrogate.h"

#include <optional>
#include <span>
#include <string_view>

namespace fidservo::gap {

/// What is left, r.m.s., over what is expected under the truth; 0 for signals that were not recorded.
struct Pattern {
    std::array<double, signal_count> floors{};
    double tag_along = 0.0;    ///< of the tags' corners along the stage's motion
    double tag_across = 0.0;   ///< of their other seven coordinates
    double tag_at_rest = 0.0;  ///< along it too, in windows over which the stages stand
};

Pattern pattern_of(const Evidence& evidence, std::span<const SignalGap> gaps, const Errors& errors);

/// The sensor whose false reading would leave the pattern: encoder or hall.
std::optional<Signal> false_sensor(const Pattern& pattern);

/// Whether the tags are off only because the carriage's place between two counts is.
bool tags_are_innocent(const Pattern& pattern);

/// What a block is of: the carriage, the platform on it, or what is seen from there.
enum class Stage { macro, micro, camera };

Stage stage_of(std::string_view block);

/// @param signal  that is furthest from its floor, or of the false sensor
/// @param dependence  what its errors depend on first, if anything was found
std::string_view accused_block(const Pattern& pattern, Signal signal, std::optional<Dependence> dependence);

}  // namespace fidservo::gap

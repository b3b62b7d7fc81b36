// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A period along the rail in the tags' errors.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whose place a wave goes by.
enum class WaveOf {
    carriage,  ///< as of the encoder's reading
    camera,    ///< of carriage and platform together
};

/// The period along the rail, mm, of the wave that would explain most of the tags' errors along the stage's
/// motion; 0 where there are none. Linear periodogram over 1 mm to 50 mm (Lomb,
/// Scargle), windows weighted as in gap/fit/score.h; of the carriage with each window's mean free, which its
/// start decides.
/// @param errors  of the tags are used where they are not NaN
double strongest_tag_period_mm(const Evidence& evidence, const Errors& errors,
                               WaveOf wave = WaveOf::carriage);

}  // namespace fidservo::gap

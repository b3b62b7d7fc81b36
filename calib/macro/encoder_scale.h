// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The resolution of an encoder, from positions of the carriage at rest that the camera measured far more
// precisely than the encoder does.
//
// A count c at the position y means c - 1/2 <= u y + v <= c + 1/2 with u = 1 / resolution and v = -zero u, up
// to the noise of y (rounding_likelihood.h). The values (u, v) that are compatible with n stands form a
// polygon that shrinks with 1 / n, not with 1 / sqrt(n), so that least squares would be worse. The estimate
// is the mean of the posterior under a flat prior, its standard errors are the posterior's standard
// deviations, both by numerical integration. They are widened if the positions accumulate at the edges of
// their counts, as those of a drive do that stops as soon as a count is reached.

#include "core/result.h"

#include <span>

namespace fidservo::calib {

/// The carriage at rest.
struct EncoderStand {
    double count;
    double carriage_mm;
    double std_mm;
};

struct EncoderScale {
    double resolution_mm;  ///< plate mm along the stage's axis per count
    double resolution_std_mm;
    double zero_mm;  ///< carriage position at which the unrounded count is 0
    double zero_std_mm;
    double middle_mm;  ///< mean position of the stands
    /// Standard error of a carriage position from the encoder at middle_mm, without its rounding.
    double middle_std_mm;
    double excess_count;  ///< how far the worst stand lies outside its count; 0 if counts are evenly spaced
    bool fits;            ///< whether the excess can be noise of the measured places
};

/// Fails with Reason::not_identifiable with fewer than 4 stands or stands over fewer than 20 counts.
Result<EncoderScale> fit_encoder_scale(std::span<const EncoderStand> stands);

}  // namespace fidservo::calib

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How long an encoder's count is, from stands of the carriage whose places the camera knows far better than
// the encoder.
//
// A count c at the place y says c - 1/2 <= u y + v <= c + 1/2 with u = 1 / resolution and v = -zero u, up to
// the noise of y (rounding_likelihood.h). The uncertainty left by n stands over a way L is a polygon in (u,
// v) that shrinks with 1 / n, not with 1 / sqrt(n), and least squares would be worse. The estimate is the
// mean of the posterior under a flat prior, its standard errors are the posterior's standard deviations, both
// by numerical integration, widened where places pile up at the edges of their counts, as they do where a
// drive stops as soon as its count is reached.

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
    double zero_mm;  ///< carriage place whose exact count is 0
    double zero_std_mm;
    double middle_mm;      ///< of the stands
    double middle_std_mm;  ///< standard error of the carriage's place by encoder there, its rounding aside
    double excess_count;   ///< how far the worst stand lies outside its count: 0 if counts are evenly spaced
    bool fits;             ///< whether that can be noise of the places
};

/// Fails with Reason::not_identifiable with fewer than 4 stands or stands over fewer than 20 counts.
Result<EncoderScale> fit_encoder_scale(std::span<const EncoderStand> stands);

}  // namespace fidservo::calib

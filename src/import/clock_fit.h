// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Offset and rate between two clocks, from a motion that appears in signals on both.
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace fidservo::imports {

/// A signal with increasing times, s, on its own clock.
struct MotionTrack {
    std::vector<double> time_s;
    std::vector<double> value;
};

/// Time on the reference's clock = t + offset + rate 1e-6 (t - t_first), with t_first the track's first time.
struct ClockFit {
    double offset_s = 0.0, offset_std_s = 0.0;
    double rate_ppm = 0.0, rate_std_ppm = 0.0;
    /// Correlation of the two signals after the fit; negative if one of them is inverted.
    double correlation = 0.0;
};

/// Finds the lag of largest correlation r among the lags at which the tracks overlap by at least half of the
/// shorter one, then minimises the squares of x(s(t)) - a y(t) - b over offset, rate, a and b (Gauss-Newton),
/// with x the reference, y the track and s(t) the fitted time. Standard errors include the factor (1 + rho) /
/// (1 - rho) on the variances for the residuals' correlation rho from sample to sample.
///
/// Valid for rates by which the tracks drift apart by less than their motion's time scale. The error says why
/// there is no result: too few samples, no motion, no common motion (the largest correlation over all lags is
/// not significant at 1 %), another lag whose correlation is not significantly lower (Fisher's z, 1 %), as in
/// a periodic motion, or a standard error of the offset above the motion's time scale.
tl::expected<ClockFit, std::string> fit_clock(const MotionTrack& track, const MotionTrack& reference);

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Offset and rate between two clocks, from a motion that appears in signals on both.
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace fidservo::imports {

/// A signal on its own clock; times rise, s.
struct MotionTrack {
    std::vector<double> time_s;
    std::vector<double> value;
};

/// Time on the reference's clock = t + offset + rate 1e-6 (t - t_first), with t_first the track's first time.
struct ClockFit {
    double offset_s = 0.0, offset_std_s = 0.0;
    double rate_ppm = 0.0, rate_std_ppm = 0.0;
    /// Correlation of the two signals after the fit; negative where one is inverted.
    double correlation = 0.0;
};

/// Looks for the lag of largest correlation r over lags that leave half of the shorter track in common, then
/// for the least squares of x(s(t)) - a y(t) - b over offset, rate, a and b (Gauss-Newton). Standard
/// deviations count the residuals' correlation from sample to sample, (1 + rho) / (1 - rho).
///
/// Valid for rates by which the tracks drift apart by less than their motion's time scale. The error says
/// why there is no answer: too few samples, no motion, no common motion (the correlation is not above what
/// independent signals of as many independent samples reach once in 100 looks over all lags), another lag
/// whose correlation is not significantly lower (Fisher's z, one in 100), as in a periodic motion, or an
/// offset that is less certain than the motion's time scale.
tl::expected<ClockFit, std::string> fit_clock(const MotionTrack& track, const MotionTrack& reference);

}  // namespace fidservo::imports

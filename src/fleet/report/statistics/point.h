// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A value of one quantity of one unit at one time, in floors: 0 is the rig file's value, 1 a deviation that
// alone causes a gap as large as the noise floor.

namespace fidservo::fleet {

/// The natural logarithm of the least odds, 19 to 1, with which a finding is reported.
inline constexpr double least_log_odds = 2.944438979166440;

/// One diagnosis.
struct Point {
    double time_weeks;  ///< in a time scale that all points share
    /// Floors. If the diagnosis does not name the quantity, value is 0 and std that of diagnoses that do.
    double value, std;
    /// If the diagnosis does not name the quantity: the size from which it would have been named, floors;
    /// otherwise 0.
    double limit = 0.0;

    bool named() const { return limit == 0.0; }
};

/// A value with its standard error, floors.
struct Level {
    double value = 0.0, std = 0.0;
    /// If positive, there is no value; the true value plus an error of standard deviation `std` is within
    /// +-limit.
    double limit = 0.0;

    bool named() const { return limit == 0.0; }
};

}  // namespace fidservo::fleet

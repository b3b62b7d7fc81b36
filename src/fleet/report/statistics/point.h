// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is known of one quantity of one unit at one time, in floors: 0 is what the rig file says, 1 what by
// itself makes a gap as large as the noise floor.

namespace fidservo::fleet {

/// One diagnosis.
struct Point {
    double time_weeks;  ///< since any time that all points share
    /// Floors. Of one that does not name the quantity the value is 0, and the std that of those that do.
    double value, std;
    /// Of one that does not name it: it saw nothing of this size or more, floors; otherwise 0.
    double limit = 0.0;

    bool named() const { return limit == 0.0; }
};

/// A value with its standard error, floors.
struct Level {
    double value = 0.0, std = 0.0;
    /// Above 0: there is no value, but the true one and an error of `std` together are within this.
    double limit = 0.0;

    bool named() const { return limit == 0.0; }
};

}  // namespace fidservo::fleet

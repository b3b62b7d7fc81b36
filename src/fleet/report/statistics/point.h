// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is known of one quantity of one unit at one time, in floors: 0 is what the rig file says, 1 what by
// itself makes a gap as large as the noise floor.

namespace fidservo::fleet {

/// One diagnosis.
struct Point {
    double time_weeks;  ///< since any time that all points share
    double value, std;  ///< floors
    /// Whether the diagnosis named it. Of one that it did not, the value is 0 and the std that of all sizes
    /// that it could have passed over.
    bool named = true;
};

/// A value with its standard error, floors.
struct Level {
    double value = 0.0, std = 0.0;
};

}  // namespace fidservo::fleet

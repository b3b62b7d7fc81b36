// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well the reference model under the commands of a recording reproduces its readings.
#include "core/recording.h"
#include "reference/reference_rig.h"

namespace fidservo::reference {

/// Model readings minus recorded ones, and the same expected from noise and rounding alone.
struct Residual {
    double encoder_rms_count = 0.0;      ///< position before rounding minus recorded count
    double encoder_largest_count = 0.0;  ///< up to 1/2 is rounding
    double count_rms = 0.0;              ///< counts of the model minus recorded ones
    double hall_rms_lsb = 0.0;
    double hall_expected_rms_lsb = 0.0;
    double hall_rms_std_lsb = 0.0;  ///< standard deviation of the r.m.s.

    double hall_sigma() const { return (hall_rms_lsb - hall_expected_rms_lsb) / hall_rms_std_lsb; }
};

/// Simulates the recording's commands. The position within the first count is unknown: the one that minimises
/// the largest encoder residual is used.
Residual residual(const RigModel& model, const Recording& recording);

}  // namespace fidservo::reference

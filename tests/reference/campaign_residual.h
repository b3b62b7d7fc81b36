// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well the reference model, fed with the commands of a recording, follows its readings.
#include "core/recording.h"
#include "reference/reference_rig.h"

namespace fidservo::reference {

/// Model readings minus recorded ones, and what noise and rounding alone would leave.
struct Residual {
    double encoder_rms_count = 0.0;      ///< position before rounding minus recorded count
    double encoder_largest_count = 0.0;  ///< up to 1/2 is rounding
    double count_rms = 0.0;              ///< counts of the model minus recorded ones
    double hall_rms_lsb = 0.0;
    double hall_expected_rms_lsb = 0.0;
    double hall_rms_std_lsb = 0.0;  ///< by which the r.m.s. scatters about its expected value

    double hall_sigma() const { return (hall_rms_lsb - hall_expected_rms_lsb) / hall_rms_std_lsb; }
};

/// Runs the recording's commands. Where in its first count the carriage stood is not known: the start that
/// keeps the largest encoder residual smallest is taken.
Residual residual(const RigModel& model, const Recording& recording);

}  // namespace fidservo::reference

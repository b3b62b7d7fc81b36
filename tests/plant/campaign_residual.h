// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well a plant, fed with the commands of a recording, follows its readings.
#include "core/recording.h"
#include "plant/stage_plant.h"

namespace fidservo::plant {

/// How the carriage's motion under the recorded commands compares with the recorded counts.
struct EncoderResidual {
    double largest = 0.0;       ///< |position - recorded|, counts; up to 1/2 is rounding
    double position_rms = 0.0;  ///< the same, r.m.s.
    int wrong_counts = 0;       ///< ticks at which the simulated reading is not the recorded one
    double count_rms = 0.0;     ///< simulated - recorded reading
};

/// Where in the first count the carriage stood is not known. The place that keeps the largest residual
/// smallest is a convex problem, as the start only shifts the motion: a golden-section search.
EncoderResidual best_encoder_residual(const StagePlant& plant, const Recording& recording);

/// How the recorded Hall readings scatter about those that a wire that starts cold would give without noise.
struct HallResidual {
    double rms_lsb = 0.0;
    double expected_rms_lsb = 0.0;  ///< of noise and rounding alone
    double rms_std_lsb = 0.0;       ///< by which the former scatters about the latter

    /// Residual beyond the floor, in standard deviations.
    double sigma() const { return (rms_lsb - expected_rms_lsb) / rms_std_lsb; }
};

HallResidual hall_residual(const StagePlant& plant, const Recording& recording);

}  // namespace fidservo::plant

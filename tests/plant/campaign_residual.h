// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well a plant under the commands of a recording reproduces its readings.
#include "core/recording.h"
#include "plant/stage_plant.h"

namespace fidservo::plant {

/// The carriage's simulated motion under the recorded commands, compared with the recorded counts.
struct EncoderResidual {
    double largest = 0.0;       ///< |position - recorded|, counts; up to 1/2 is rounding
    double position_rms = 0.0;  ///< the same, r.m.s.
    int wrong_counts = 0;       ///< ticks at which the simulated reading is not the recorded one
    double count_rms = 0.0;     ///< simulated - recorded reading
};

/// The residual for the best initial position, as the position within the first count is unknown. Finding the
/// one that minimises the largest residual is a convex problem, since it only shifts the motion; it is solved
/// by golden-section search.
EncoderResidual best_encoder_residual(const StagePlant& plant, const Recording& recording);

/// The scatter of the recorded Hall readings about the noise-free ones of a wire that starts cold.
struct HallResidual {
    double rms_lsb = 0.0;
    double expected_rms_lsb = 0.0;  ///< from noise and rounding alone
    double rms_std_lsb = 0.0;       ///< standard deviation of rms_lsb

    /// The residual in excess of the floor, in standard deviations.
    double sigma() const { return (rms_lsb - expected_rms_lsb) / rms_std_lsb; }
};

HallResidual hall_residual(const StagePlant& plant, const Recording& recording);

}  // namespace fidservo::plant

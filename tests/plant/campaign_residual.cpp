// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/campaign_residual.h"

#include "tests/campaign.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::plant {

namespace {

EncoderResidual encoder_residual(const StagePlant& plant, const Recording& recording, double start_mm) {
    StageState state = start(plant, start_mm, 1, EncoderOrigin::end_of_travel);
    EncoderResidual residual;
    double count_squares = 0.0, position_squares = 0.0;
    for (const StageRow& row : recording.rows) {
        const auto reading = sample(plant.encoder, state.encoder, state.axis.position_mm);
        const double count_error = static_cast<double>(reading) - row.encoder_count;
        const double position_error =
            state.axis.position_mm / plant.encoder.resolution_mm - row.encoder_count;
        residual.largest = std::max(residual.largest, std::abs(position_error));
        residual.wrong_counts += count_error != 0.0;
        count_squares += count_error * count_error;
        position_squares += position_error * position_error;
        advance(plant.axis, state.axis, row.macro_command_V);
    }
    const double ticks = static_cast<double>(recording.rows.size());
    residual.count_rms = std::sqrt(count_squares / ticks);
    residual.position_rms = std::sqrt(position_squares / ticks);
    return residual;
}

}  // namespace

EncoderResidual best_encoder_residual(const StagePlant& plant, const Recording& recording) {
    const auto residual_at = [&](double start_count) {
        const double start_mm = start_count * plant.encoder.resolution_mm;
        return encoder_residual(
            plant, recording,
            std::clamp(start_mm, plant.axis.parameters.low_mm, plant.axis.parameters.high_mm));
    };
    const double shrink = 1.0 / std::numbers::phi;
    double low = recording.rows.front().encoder_count - 0.5;
    double high = recording.rows.front().encoder_count + 0.5;
    constexpr double resolution_count = 1e-6;
    while (high - low > resolution_count) {
        const double left = high - shrink * (high - low);
        const double right = low + shrink * (high - low);
        if (residual_at(left).largest < residual_at(right).largest)
            high = right;
        else
            low = left;
    }
    return residual_at(0.5 * (low + high));
}

HallResidual hall_residual(const StagePlant& plant, const Recording& recording) {
    const HallSensor& hall = plant.micro->hall;
    MicroStageState state = start(*plant.micro, 1);
    double squares = 0.0, expected = 0.0, variance = 0.0;
    for (const StageRow& row : recording.rows) {
        const double mean_lsb = mean_reading_lsb(hall, state.position_mm);
        const auto statistics = testing::rounded_gaussian(mean_lsb, hall.parameters.noise_lsb);
        squares += (row.hall_adc - mean_lsb) * (row.hall_adc - mean_lsb);
        expected += statistics.mean;
        variance += statistics.variance;
        advance(*plant.micro, state, row.micro_command_V);
    }
    const double ticks = static_cast<double>(recording.rows.size());
    const double expected_rms = std::sqrt(expected / ticks);
    return {std::sqrt(squares / ticks), expected_rms, std::sqrt(variance) / ticks / (2.0 * expected_rms)};
}

}  // namespace fidservo::plant

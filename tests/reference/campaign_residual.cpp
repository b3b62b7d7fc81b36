// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/reference/campaign_residual.h"

#include "tests/campaign.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace fidservo::reference {

namespace {

/// The carriage's deviation from the recorded counts.
struct EncoderError {
    double squares = 0.0, count_squares = 0.0, largest = 0.0;
};

EncoderError encoder_error(const RigModel& carriage_only, std::span<const StageRow> rows, double start_mm) {
    State state = start(carriage_only, start_mm, 1);
    EncoderError error;
    for (const StageRow& row : rows) {
        const double place = state.carriage.position_mm * carriage_only.departures.encoder.scale /
                             carriage_only.encoder_resolution_mm;
        const double count = static_cast<double>(sample(carriage_only, state).encoder_count);
        error.squares += (place - row.encoder_count) * (place - row.encoder_count);
        error.count_squares += (count - row.encoder_count) * (count - row.encoder_count);
        error.largest = std::max(error.largest, std::abs(place - row.encoder_count));
        advance(carriage_only, state, row.macro_command_V, 0.0);
    }
    return error;
}

/// The start only shifts the whole path, unless there are end stops: it is estimated from a path with any
/// start, and the path from the estimate is checked.
EncoderError best_encoder_error(const RigModel& model, std::span<const StageRow> rows) {
    RigModel carriage_only = model;
    carriage_only.platform.reset();
    carriage_only.camera.reset();
    const double count_mm = model.encoder_resolution_mm / model.departures.encoder.scale;
    double start_mm =
        std::clamp(rows.front().encoder_count * count_mm, model.carriage.low_mm, model.carriage.high_mm);
    for (int round = 0; round < 2; ++round) {
        State state = start(carriage_only, start_mm, 1);
        double low = 0.0, high = 0.0;
        bool first = true;
        for (const StageRow& row : rows) {
            const double difference = row.encoder_count - state.carriage.position_mm / count_mm;
            low = first ? difference : std::min(low, difference);
            high = first ? difference : std::max(high, difference);
            first = false;
            advance(carriage_only, state, row.macro_command_V, 0.0);
        }
        const double shift = std::clamp(0.5 * (low + high), -1.0, 1.0);
        start_mm = std::clamp(start_mm + shift * count_mm, model.carriage.low_mm, model.carriage.high_mm);
    }
    return encoder_error(carriage_only, rows, start_mm);
}

}  // namespace

Residual residual(const RigModel& model, const Recording& recording) {
    const std::span<const StageRow> rows = recording.rows;
    const auto ticks = static_cast<double>(rows.size());
    const EncoderError encoder = best_encoder_error(model, rows);
    Residual result;
    result.encoder_rms_count = std::sqrt(encoder.squares / ticks);
    result.count_rms = std::sqrt(encoder.count_squares / ticks);
    result.encoder_largest_count = encoder.largest;

    const HallParameters& hall = model.platform->hall;
    State state = start(model, rows.front().encoder_count * model.encoder_resolution_mm, 1);
    double squares = 0.0, expected = 0.0, variance = 0.0;
    for (const StageRow& row : rows) {
        const HallInput input{truth(model, state).platform_mm, state.macro_V,
                              static_cast<double>(state.tick) * model.tick_s};
        const double lsb_V = hall.adc_range_V / static_cast<double>(1 << hall.adc_bits);
        const double mean_lsb = hall_volts(hall, model.departures.hall, input) / lsb_V;
        const auto statistics = testing::rounded_gaussian(mean_lsb, hall.noise_lsb);
        squares += (row.hall_adc - mean_lsb) * (row.hall_adc - mean_lsb);
        expected += statistics.mean;
        variance += statistics.variance;
        advance(model, state, row.macro_command_V, row.micro_command_V);
    }
    result.hall_rms_lsb = std::sqrt(squares / ticks);
    result.hall_expected_rms_lsb = std::sqrt(expected / ticks);
    result.hall_rms_std_lsb = std::sqrt(variance) / ticks / (2.0 * result.hall_expected_rms_lsb);
    return result;
}

}  // namespace fidservo::reference

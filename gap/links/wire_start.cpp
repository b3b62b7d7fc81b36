// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/wire_start.h"

#include "core/median.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fidservo::gap {

namespace {

/// Moves the end of the hysteresis branch on which a wire is to another temperature, as far as the branch
/// reaches.
void slide_wire(const FodTable& table, PreisachMemory& wire, double temp_degC) {
    const bool heating = wire.last_peak_degC == wire.temp_degC;
    if (heating == (temp_degC > wire.temp_degC)) {
        preisach_step(table, wire, temp_degC);
        return;
    }
    const double valley_degC = wire.loops.empty() ? table.low_degC() : wire.loops.back().valley_degC;
    const double outer_mm = wire.loops.empty() ? 0.0 : wire.loops.back().contraction_mm;
    wire.temp_degC = heating ? std::max(temp_degC, valley_degC) : std::min(temp_degC, wire.last_peak_degC);
    if (heating) wire.last_peak_degC = wire.temp_degC;
    wire.contraction_mm = outer_mm + table.contraction_mm(wire.last_peak_degC, wire.temp_degC) -
                          table.contraction_mm(wire.last_peak_degC, valley_degC);
}

/// Cooling time constants after which a warm wire has cooled.
constexpr double cooling_taus = 3.0;

/// Errors from a first state until a warm wire would have cooled.
struct Cooling {
    double square = 0.0;    ///< sum of squared errors, LSB^2
    double variance = 0.0;  ///< about their mean, LSB^2
    double count = 0.0;     ///< number of errors
    double passed_s = 0.0;  ///< until then, or until the sum of squares exceeded the limit
};

/// @param most_square  limit of the sum of squares, LSB^2, at which the simulation ends
Cooling while_cooling(const PlatformModel& model, const PlatformRun& run, plant::MicroStageState state,
                      double most_square = std::numeric_limits<double>::infinity()) {
    const double enough_s = cooling_taus * model.stage.heater.parameters.cooling_tau_s;
    double sum = 0.0, squares = 0.0, count = 0.0, passed_s = 0.0;
    for (std::size_t k = 0; k < run.hall_adc.size() && passed_s < enough_s; ++k) {
        if (std::isfinite(run.hall_adc[k])) {
            const double error_lsb = mean_reading_lsb(model.stage, state) - run.hall_adc[k];
            sum += error_lsb;
            squares += error_lsb * error_lsb;
            count += 1.0;
            if (squares > most_square) break;
        }
        step(model, run, nullptr, k, state);
        passed_s += run.ticks[k] * run.tick_s;
    }
    if (count == 0.0) return {};
    return {squares, squares / count - (sum / count) * (sum / count), count, passed_s};
}

/// By how much the first readings exceed those of a cold wire, LSB.
struct Excess {
    double mean_lsb = 0.0;
    int readings = 0;
    bool is_clear = false;  ///< more than noise and rounding explain
};

/// Standard deviations from which on something is clear; an excess of the reading below which nothing is
/// seen.
constexpr double clear_stds = 5.0, unseen_lsb = 1.0;

/// @param zero_lsb  known offset of the sensor
Excess first_excess(const PlatformModel& model, const PlatformRun& run, double zero_lsb = 0.0) {
    plant::MicroStageState state = plant::start(model.stage, 0);
    Excess excess;
    for (std::size_t k = 0; k < std::min(glance_rows, run.hall_adc.size()); ++k) {
        if (std::isfinite(run.hall_adc[k])) {
            excess.mean_lsb += run.hall_adc[k] - mean_reading_lsb(model.stage, state);
            ++excess.readings;
        }
        step(model, run, nullptr, k, state);
    }
    if (excess.readings == 0) return excess;
    excess.mean_lsb = excess.mean_lsb / excess.readings - zero_lsb;
    excess.is_clear = excess.mean_lsb >= unseen_lsb + clear_stds * run.floor_lsb / std::sqrt(excess.readings);
    return excess;
}

/// The stage with a wire that is heated from cold until the reading has risen by `excess_lsb`.
plant::MicroStageState heated_to(const PlatformModel& model, double excess_lsb) {
    constexpr double resolution_degC = 1e-3;
    const plant::MicroStageState cold = plant::start(model.stage, 0);
    const auto heated = [&](double temp_degC) {
        plant::MicroStageState warm = cold;
        slide(model.stage, warm, temp_degC - cold.heater.temp_degC);
        return warm;
    };
    const double goal_lsb = mean_reading_lsb(model.stage, cold) + excess_lsb;
    double low = cold.heater.temp_degC;
    const double most_load_degC = std::max(0.0, model.stage.table_shift_degC_per_mm) *
                                  model.stage.stroke_factor * model.stage.fod->stroke_mm();
    double high = std::max(low, model.stage.fod->high_degC() + model.stage.table_shift_degC + most_load_degC);
    while (high - low > resolution_degC) {
        const double middle = 0.5 * (low + high);
        (mean_reading_lsb(model.stage, heated(middle)) < goal_lsb ? low : high) = middle;
    }
    return heated(low);
}

/// Whether the first readings change while those of a cold wire would be constant; those of a warm wire are
/// constant only if it is heated.
enum class Trend { unknown, still, drifting };

/// Evaluates the first readings until a cold wire would be warm enough to move, or the motor's voltage
/// changes, of which some may leak into the readings.
Trend first_trend(const PlatformModel& nominal, const PlatformRun& run) {
    constexpr double longest_s = 1.0, still_lsb = 0.3, same_V = 0.1;
    constexpr double least_readings = 10.0, least_still_s = 0.3;
    plant::MicroStageState cold = plant::start(nominal.stage, 0);
    const double still_at_lsb = mean_reading_lsb(nominal.stage, cold);
    double n = 0.0, t = 0.0, tt = 0.0, y = 0.0, ty = 0.0, passed_s = 0.0;
    bool is_heated = false;
    for (std::size_t k = 0; k < run.hall_adc.size() && passed_s < longest_s; ++k) {
        if (std::abs(mean_reading_lsb(nominal.stage, cold) - still_at_lsb) > still_lsb ||
            std::abs(run.macro_command_V[k] - run.macro_command_V[0]) > same_V)
            break;
        if (std::isfinite(run.hall_adc[k])) {
            n += 1.0;
            t += passed_s;
            tt += passed_s * passed_s;
            y += run.hall_adc[k];
            ty += passed_s * run.hall_adc[k];
        }
        is_heated = is_heated || run.command_V[k] > nominal.stage.heater.parameters.onset_V;
        step(nominal, run, nullptr, k, cold);
        passed_s += run.ticks[k] * run.tick_s;
    }
    if (n < least_readings) return Trend::unknown;
    const double spread = tt - t * t / n;
    if (std::abs(ty - t * y / n) > clear_stds * run.floor_lsb * std::sqrt(spread)) return Trend::drifting;
    return passed_s >= least_still_s && !is_heated ? Trend::still : Trend::unknown;
}

/// Ratio of squared errors from which on a prediction is far better.
constexpr double far_better = 0.25;

/// Variances of the errors, LSB^2, with which the following readings are predicted from a cold wire, and from
/// the best of those warmer ones that are compatible with the first readings. Variances do not depend on the
/// sensor's offset.
struct ColdOrWarm {
    double cold = 0.0, warm = 0.0;
    bool is_warm() const { return warm < far_better * cold; }
};

ColdOrWarm cold_or_warm(const PlatformModel& nominal, const PlatformRun& run, double excess_lsb) {
    constexpr double step_degC = 2.0, most_zero_lsb = 10.0;
    const plant::MicroStageState cold = plant::start(nominal.stage, 0);
    ColdOrWarm found;
    found.cold = found.warm = while_cooling(nominal, run, cold).variance;
    const double most_lsb = mean_reading_lsb(nominal.stage, cold) + std::max(0.0, excess_lsb) + most_zero_lsb;
    for (double warmer_degC = step_degC; warmer_degC < nominal.stage.fod->high_degC() && !found.is_warm();
         warmer_degC += step_degC) {
        plant::MicroStageState warm = cold;
        slide(nominal.stage, warm, warmer_degC);
        if (mean_reading_lsb(nominal.stage, warm) > most_lsb) break;
        found.warm = std::min(found.warm, while_cooling(nominal, run, warm).variance);
    }
    return found;
}

/// The stage with a wire that reads as a cold one does, at the temperature from which the following readings
/// are predicted best, or cold if no other temperature is far better.
plant::MicroStageState unmoved(const PlatformModel& model, const PlatformRun& run) {
    constexpr double resolution_degC = 0.5;
    const plant::MicroStageState cold = plant::start(model.stage, 0);
    const Cooling from_cold = while_cooling(model, run, cold);
    const double bound = far_better * from_cold.square;
    // Noise alone has larger errors than would count as far better.
    if (bound < from_cold.count * run.floor_lsb * run.floor_lsb) return cold;
    const auto warmer = [&](double by_degC) {
        plant::MicroStageState warm = cold;
        slide(model.stage, warm, by_degC);
        return warm;
    };
    const auto found = [&](double by_degC) { return while_cooling(model, run, warmer(by_degC), bound); };
    // If the errors of both exceed the bound, the one that exceeds it later is better.
    const auto is_better = [&](const Cooling& one, const Cooling& other) {
        return std::min(one.square, other.square) > bound ? one.passed_s > other.passed_s
                                                          : one.square < other.square;
    };
    double low = 0.0;
    double high = heated_to(model, unseen_lsb).heater.temp_degC - cold.heater.temp_degC;
    double left = high - golden_section * (high - low), right = low + golden_section * (high - low);
    Cooling at_left = found(left), at_right = found(right);
    while (high - low > resolution_degC) {
        if (is_better(at_left, at_right)) {
            high = right;
            right = left;
            at_right = at_left;
            at_left = found(left = high - golden_section * (high - low));
        } else {
            low = left;
            left = right;
            at_left = at_right;
            at_right = found(right = low + golden_section * (high - low));
        }
    }
    const double best = 0.5 * (low + high);
    return found(best).square < bound ? warmer(best) : cold;
}

}  // namespace

void step(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage, std::size_t row,
          plant::MicroStageState& state) {
    plant::CarriageInfluence influence;
    if (model.stage.feels_carriage()) {
        influence.drive_V = plant::drive_voltage_V(model.axis, run.macro_command_V[row]);
        if (carriage != nullptr) {
            influence.shaking = {carriage->acceleration_mm_per_s2[row], carriage->jerk_mm_per_s3[row]};
            const std::size_t next = std::min(row + 1, carriage->position_mm.size() - 1);
            influence.place_mm = carriage->position_mm[next];
            influence.speed_mm_per_s = carriage->velocity_mm_per_s[next];
        }
    }
    for (int tick = 0; tick < run.ticks[row]; ++tick) {
        plant::advance(model.stage, state, run.command_V[row], influence);
        influence.shaking = {};
    }
}

void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC) {
    if (by_degC == 0.0) return;
    // In steps over which the load of a contracting wire changes little.
    constexpr double longest_degC = 0.25;
    const double steps =
        stage.table_shift_degC_per_mm == 0.0 ? 1.0 : std::ceil(std::abs(by_degC) / longest_degC);
    for (double left = steps; left > 0.0; left -= 1.0) {
        state.heater.temp_degC += by_degC / steps;
        slide_wire(*stage.fod, state.wire, table_degC(stage, state));
    }
    state.position_mm = held_mm(stage, state) + state.swing.position_mm + state.formulas.beside_mm;
}

plant::MicroStageState first_state(const PlatformModel& model, const PlatformRun& run) {
    switch (run.start) {
        case WireStart::cold:
            return plant::start(model.stage, 0);
        case WireStart::unmoved:
            return unmoved(model, run);
        case WireStart::warm:
            return heated_to(model, first_excess(model, run).mean_lsb);
    }
    return plant::start(model.stage, 0);
}

double zero_of_sensor_lsb(const PlatformModel& nominal, std::span<const PlatformRun* const> runs) {
    std::vector<double> zeros;
    for (const PlatformRun* run : runs)
        if (first_trend(nominal, *run) == Trend::still) zeros.push_back(first_excess(nominal, *run).mean_lsb);
    return zeros.empty() ? 0.0 : median_of(std::move(zeros));
}

WireStart wire_start(const PlatformModel& nominal, const PlatformRun& run, double zero_lsb) {
    const Excess excess = first_excess(nominal, run, zero_lsb);
    const Trend trend = first_trend(nominal, run);
    const ColdOrWarm way = cold_or_warm(nominal, run, excess.mean_lsb);
    if (way.is_warm() || (excess.is_clear && trend == Trend::drifting)) return WireStart::warm;
    const bool is_cold = way.cold <= clearly_off_square * run.floor_lsb * run.floor_lsb;
    if (is_cold || (excess.is_clear && trend == Trend::still)) return WireStart::cold;
    return excess.is_clear ? WireStart::warm : WireStart::unmoved;
}

}  // namespace fidservo::gap

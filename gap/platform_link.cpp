#include "gap/platform_link.h"

#include "core/demand.h"
#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {

namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// What the carried temperature is trusted to. Where the wire is flat, readings say little of its
/// temperature, and the noise that a looser trust lets in shows when the wire gets steep (50 LSB per degree
/// on the reference rig): under the truth the errors of the practice campaign are then 1.01 floors with
/// 0.02, 3.8 with 0.1 and 20 with 0.3. What is wrong with a heater goes on being wrong.
constexpr double carried_std_degC = 0.003;
constexpr double most_stds = 3.0;

/// Moves the end of the branch on which a wire is to another temperature, as far as the branch goes.
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

void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC) {
    if (by_degC == 0.0) return;
    state.heater.temp_degC += by_degC;
    slide_wire(*stage.fod, state.wire, state.heater.temp_degC - stage.table_shift_degC);
    state.position_mm = stage.stroke_factor * state.wire.contraction_mm + state.swing.position_mm;
}

class Pass {
  public:
    Pass(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage)
        : model_(model), run_(run), carriage_(carriage) {
        const std::size_t rows = run.command_V.size();
        found_ = {std::vector(rows, not_known), std::vector(rows, not_known), std::vector(rows, not_known)};
    }

    PlatformPrediction predict() {
        if (run_.command_V.empty()) return found_;
        plant::MicroStageState state = first_state();
        plant::MicroStageState carried = state;  // where the next window's 100 ms begin
        std::size_t row = 0;
        for (std::size_t i = 0; i < run_.windows.size(); ++i) {
            const WindowRows& window = run_.windows[i];
            if (row <= window.lead) {
                walk(state, row, window.lead);
                carried = state;
                walk(state, window.lead, window.first);
            }
            state = corrected(window, carried);
            const bool follows = i + 1 < run_.windows.size() && run_.windows[i + 1].lead < window.end;
            const std::size_t next = follows ? run_.windows[i + 1].lead : window.end;
            walk(state, window.first, next);
            if (follows) carried = state;
            walk(state, next, window.end);
            std::copy(found_.path_lsb.begin() + static_cast<std::ptrdiff_t>(window.first),
                      found_.path_lsb.begin() + static_cast<std::ptrdiff_t>(window.end),
                      found_.reading_lsb.begin() + static_cast<std::ptrdiff_t>(window.first));
            row = window.end;
        }
        walk(state, row, run_.command_V.size());
        return found_;
    }

  private:
    /// A stage whose wire was heated from cold to where the first readings are; cold if they say so, or if
    /// what follows does: a sensor that reads high at a cold wire goes on to, a warm wire cools.
    plant::MicroStageState first_state() const {
        constexpr std::size_t glance = 20;
        constexpr double clear = 5.0, least_lsb = 1.0, resolution_degC = 1e-3;
        const plant::MicroStageState cold = plant::start(model_.stage, 0);
        plant::MicroStageState state = cold;
        double excess_lsb = 0.0;
        int count = 0;
        for (std::size_t k = 0; k < std::min(glance, run_.hall_adc.size()); ++k) {
            if (std::isfinite(run_.hall_adc[k])) {
                excess_lsb += run_.hall_adc[k] - mean_reading_lsb(model_.stage, state);
                ++count;
            }
            step(state, k);
        }
        if (count == 0) return cold;
        excess_lsb /= count;
        if (excess_lsb < least_lsb + clear * run_.floor_lsb / std::sqrt(count)) return cold;
        const auto heated = [&](double temp_degC) {
            plant::MicroStageState warm = cold;
            slide(model_.stage, warm, temp_degC - cold.heater.temp_degC);
            return warm;
        };
        const double goal_lsb = mean_reading_lsb(model_.stage, cold) + excess_lsb;
        double low = cold.heater.temp_degC;
        double high = std::max(low, model_.stage.fod->high_degC() + model_.stage.table_shift_degC);
        while (high - low > resolution_degC) {
            const double middle = 0.5 * (low + high);
            (mean_reading_lsb(model_.stage, heated(middle)) < goal_lsb ? low : high) = middle;
        }
        const plant::MicroStageState warm = heated(low);
        return squares_while_cooling(warm) < squares_while_cooling(cold) ? warm : cold;
    }

    /// Sum of squared errors, LSB^2, from a first state on until a warm wire would have cooled.
    double squares_while_cooling(plant::MicroStageState state) const {
        constexpr double taus = 3.0;
        const double enough_s = taus * model_.stage.heater.parameters.cooling_tau_s;
        double squares = 0.0, passed_s = 0.0;
        for (std::size_t k = 0; k < run_.hall_adc.size() && passed_s < enough_s; ++k) {
            if (std::isfinite(run_.hall_adc[k])) {
                const double error_lsb = mean_reading_lsb(model_.stage, state) - run_.hall_adc[k];
                squares += error_lsb * error_lsb;
            }
            step(state, k);
            passed_s += run_.ticks[k] * run_.tick_s;
        }
        return squares;
    }

    void step(plant::MicroStageState& state, std::size_t k) const {
        plant::CarriageInfluence carriage;
        if (model_.stage.feels_carriage()) {
            carriage.drive_V = plant::drive_voltage_V(model_.axis, run_.macro_command_V[k]);
            if (carriage_ != nullptr)
                carriage.shaking = {carriage_->acceleration_mm_per_s2[k], carriage_->jerk_mm_per_s3[k]};
        }
        for (int tick = 0; tick < run_.ticks[k]; ++tick) {
            plant::advance(model_.stage, state, run_.command_V[k], carriage);
            carriage.shaking = {};
        }
    }

    void walk(plant::MicroStageState& state, std::size_t first, std::size_t end) {
        for (std::size_t k = first; k < end; ++k) {
            found_.path_lsb[k] = mean_reading_lsb(model_.stage, state);
            found_.temperature_degC[k] = state.heater.temp_degC;
            step(state, k);
        }
    }

    /// The stage at a window's first row, and the path before it faded into the one that leads there.
    plant::MicroStageState corrected(const WindowRows& window, const plant::MicroStageState& carried) {
        constexpr double trial_degC = 0.05;
        const double weight = 1.0 / (run_.floor_lsb * run_.floor_lsb);
        plant::MicroStageState trial = carried;
        slide(model_.stage, trial, trial_degC);
        double pull = 0.0, stiffness = 1.0 / (carried_std_degC * carried_std_degC);
        for (std::size_t k = window.lead; k < window.first; ++k) {
            const double slope = (mean_reading_lsb(model_.stage, trial) - found_.path_lsb[k]) / trial_degC;
            pull += weight * slope * (run_.hall_adc[k] - found_.path_lsb[k]);
            stiffness += weight * slope * slope;
            step(trial, k);
        }
        constexpr double most_degC = most_stds * carried_std_degC;
        plant::MicroStageState state = carried;
        slide(model_.stage, state, std::clamp(pull / stiffness, -most_degC, most_degC));
        const auto rows = static_cast<double>(window.first - window.lead);
        for (std::size_t k = window.lead; k < window.first; ++k) {
            const double share = (static_cast<double>(k - window.lead) + 0.5) / rows;
            found_.path_lsb[k] += share * (mean_reading_lsb(model_.stage, state) - found_.path_lsb[k]);
            step(state, k);
        }
        return state;
    }

    const PlatformModel& model_;
    const PlatformRun& run_;
    const CarriagePath* carriage_;
    PlatformPrediction found_;
};

/// Ticks from one row to the next; what is longer than anything that the wire remembers is cut.
int ticks_between(TimeNs from_ns, TimeNs to_ns, double tick_s) {
    constexpr double longest_s = 60.0;
    return std::max(1, static_cast<int>(std::lround(std::min(longest_s, seconds(to_ns - from_ns)) / tick_s)));
}

/// Marks the rows where the wire's memory is not known.
void leave_out_unknown_wire(const Recording& recording, const HeaterParameters& heater,
                            std::vector<bool>& usable) {
    constexpr double longest_pause_s = 0.1, cold_taus = 5.0;
    const double longest_under_way_s = std::max(0.01, 1.5 * recording.tick_s);
    bool is_known = true;
    TimeNs last_ns = recording.rows.empty() ? 0 : recording.rows.front().time_ns;  // with a command
    double last_V = std::numeric_limits<double>::quiet_NaN();
    double cold_s = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < recording.rows.size(); ++k) {
        const StageRow& row = recording.rows[k];
        if (std::isfinite(row.micro_command_V)) {
            const double pause_s = seconds(row.time_ns - last_ns);
            const bool is_pause =
                pause_s > (row.micro_command_V == last_V ? longest_pause_s : longest_under_way_s);
            if (is_pause && cold_s < cold_taus * heater.cooling_tau_s) is_known = false;
            if (is_pause && !is_known) cold_s = 0.0;
            cold_s = row.micro_command_V > heater.onset_V ? 0.0 : cold_s + (is_pause ? 0.0 : pause_s);
            if (cold_s >= cold_taus * heater.cooling_tau_s) is_known = true;
            last_ns = row.time_ns;
            last_V = row.micro_command_V;
        }
        if (!is_known) usable[k] = false;
    }
}

}  // namespace

PlatformRun platform_run(const Recording& recording, const MicroParameters& micro, const HallRange& range,
                         double floor_lsb) {
    PlatformRun run;
    run.tick_s = recording.tick_s;
    run.floor_lsb = floor_lsb;
    std::vector<bool> usable;
    double micro_V = 0.0, macro_V = 0.0;
    for (std::size_t k = 0; k < recording.rows.size(); ++k) {
        const StageRow& row = recording.rows[k];
        run.hall_adc.push_back(within(range, row.hall_adc));
        usable.push_back(std::isfinite(row.micro_command_V) && std::isfinite(run.hall_adc.back()));
        if (std::isfinite(row.micro_command_V)) micro_V = row.micro_command_V;
        if (std::isfinite(row.macro_command_V)) macro_V = row.macro_command_V;
        run.command_V.push_back(micro_V);
        run.macro_command_V.push_back(macro_V);
        run.ticks.push_back(k + 1 < recording.rows.size()
                                ? ticks_between(row.time_ns, recording.rows[k + 1].time_ns, recording.tick_s)
                                : 1);
    }
    leave_out_unknown_wire(recording, micro.heater, usable);
    for (const Stretch& stretch : stretches(recording, usable))
        for (const WindowRows& window : cut(stretch, recording.tick_s, LeadIn::estimates_state))
            run.windows.push_back(window);
    return run;
}

PlatformModel platform_model(const plant::PlantParameters& parameters) {
    FIDSERVO_DEMAND(parameters.micro.has_value());
    return {plant::make_micro_stage(*parameters.micro, parameters.tick_s), parameters.axis};
}

PlatformPrediction predicted_readings(const PlatformModel& model, const PlatformRun& run,
                                      const CarriagePath* carriage) {
    return Pass(model, run, carriage).predict();
}

}  // namespace fidservo::gap

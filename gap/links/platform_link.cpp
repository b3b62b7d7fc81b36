// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/platform_link.h"

#include "core/demand.h"
#include "core/micro_parameters.h"
#include "gap/links/wire_start.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {

namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Standard deviation of the carried temperature: small, since readings tell little where the curve is flat.
constexpr double carried_std_degC = 0.003;

/// Whether a tick that changes neither temperatures nor contraction is followed by such ticks as long as the
/// command stays: nothing depends on the time, on the carriage or on earlier commands.
bool depends_on_state_alone(const plant::MicroStage& stage) {
    return stage.heater.delay_s == 0.0 && stage.hall_disturbance.is_none() && !stage.feels_carriage() &&
           !stage.formulas.any();
}

class Pass {
  public:
    Pass(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage,
         const FinerStage* finer)
        : model_(model),
          run_(run),
          carriage_(carriage),
          finer_(finer != nullptr && finer->parts > 1 && model.stage.heater.delay_s == 0.0 ? finer : nullptr),
          may_rest_(depends_on_state_alone(model.stage)) {
        const std::vector<double> none(run.command_V.size(), not_known);
        found_ = {none, none, none, {}};
        if (finer != nullptr) found_.bends_lsb.assign(none.size() * (finer->parts - 1), 0.0);
    }

    PlatformPrediction predict() {
        if (run_.command_V.empty()) return found_;
        plant::MicroStageState state = first_state(model_, run_);
        plant::MicroStageState carried = state;  // where the next window's 100 ms begin
        std::size_t row = 0;
        for (std::size_t i = 0; i < run_.windows.size(); ++i) {
            const WindowRows& window = run_.windows[i];
            if (run_.budget) run_.budget->check();
            if (row <= window.lead) {
                walk(state, row, window.lead);
                carried = state;
                walk(state, window.lead, window.first);
            }
            const bool is_beside = !run_.is_beside.empty() && run_.is_beside[i];
            state = is_beside ? beside(window, carried) : corrected(window, carried);
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
    void step(plant::MicroStageState& state, std::size_t k) const {
        gap::step(model_, run_, carriage_, k, state);
    }

    /// The reading with the platform's offset.
    double reading_lsb(plant::MicroStageState& state) const {
        if (beside_mm_ == 0.0) return mean_reading_lsb(model_.stage, state);
        const double position_mm = state.position_mm;
        state.position_mm += beside_mm_;
        const double reading_lsb = mean_reading_lsb(model_.stage, state);
        state.position_mm = position_mm;
        return reading_lsb;
    }

    /// Estimates the platform's offset in the rows before a window, by linearised least squares.
    void find_beside(const WindowRows& window, const plant::MicroStageState& carried) {
        for (int round = 0; round < linear_rounds; ++round) {
            plant::MicroStageState state = carried;
            double pull = 0.0, stiffness = 0.0;
            for (std::size_t k = window.lead; k < window.first; ++k) {
                const double predicted_lsb = reading_lsb(state);
                beside_mm_ += trial_mm;
                const double slope = (reading_lsb(state) - predicted_lsb) / trial_mm;
                beside_mm_ -= trial_mm;
                pull += slope * (run_.hall_adc[k] - predicted_lsb);
                stiffness += slope * slope;
                step(state, k);
            }
            if (stiffness > 0.0) beside_mm_ += pull / stiffness;
        }
    }

    void walk(plant::MicroStageState& state, std::size_t first, std::size_t end) {
        bool rests = false;
        for (std::size_t k = first; k < end; ++k) {
            if (rests && run_.command_V[k] == run_.command_V[k - 1]) {
                found_.path_lsb[k] = found_.path_lsb[k - 1];
                found_.temperature_degC[k] = found_.temperature_degC[k - 1];
                state.time_ns += run_.ticks[k] * model_.stage.tick_ns;
                continue;
            }
            found_.path_lsb[k] = reading_lsb(state);
            found_.temperature_degC[k] = state.heater.temp_degC;
            const double before_degC = state.heater.temp_degC;
            const auto before_rise_degC = state.heater.mass_rise_degC;
            const double before_mm = state.wire.contraction_mm;
            if (finer_ != nullptr && run_.ticks[k] == 1)
                look_within(state, k);
            else
                step(state, k);
            rests = may_rest_ && state.heater.temp_degC == before_degC &&
                    state.heater.mass_rise_degC == before_rise_degC && state.wire.contraction_mm == before_mm;
        }
    }

    /// Steps to the next row, and looks at the reading on the way.
    void look_within(plant::MicroStageState& state, std::size_t k) {
        plant::MicroStageState on_the_way = state;
        const double from_lsb = found_.path_lsb[k];
        step(state, k);
        const double way_lsb = reading_lsb(state) - from_lsb;
        const std::size_t bends = finer_->parts - 1;
        for (std::size_t part = 1; part <= bends; ++part) {
            advance(finer_->stage, on_the_way, run_.command_V[k], {});
            const double share = static_cast<double>(part) / static_cast<double>(finer_->parts);
            found_.bends_lsb[k * bends + part - 1] = reading_lsb(on_the_way) - (from_lsb + share * way_lsb);
        }
    }

    /// The stage at a window's first row as it was carried there, with the offset that the readings before it
    /// tell.
    plant::MicroStageState beside(const WindowRows& window, const plant::MicroStageState& carried) {
        find_beside(window, carried);
        plant::MicroStageState state = carried;
        fade(window, state);
        return state;
    }

    /// The stage at a window's first row, with its temperature corrected. The path before the window is faded
    /// into the one that leads there.
    plant::MicroStageState corrected(const WindowRows& window, const plant::MicroStageState& carried) {
        beside_mm_ = 0.0;
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
        constexpr double most_degC = chance_stds * carried_std_degC;
        plant::MicroStageState state = carried;
        slide(model_.stage, state, std::clamp(pull / stiffness, -most_degC, most_degC));
        fade(window, state);
        return state;
    }

    /// Simulates a stage through the rows before a window, and fades the path into this one.
    void fade(const WindowRows& window, plant::MicroStageState& state) {
        const auto rows = static_cast<double>(window.first - window.lead);
        for (std::size_t k = window.lead; k < window.first; ++k) {
            const double share = (static_cast<double>(k - window.lead) + 0.5) / rows;
            found_.path_lsb[k] += share * (reading_lsb(state) - found_.path_lsb[k]);
            step(state, k);
        }
    }

    const PlatformModel& model_;
    const PlatformRun& run_;
    const CarriagePath* carriage_;
    const FinerStage* finer_;
    bool may_rest_;
    /// Offset of the platform, by what the wire remembers from before the recording.
    double beside_mm_ = 0.0;
    PlatformPrediction found_;
};

/// Number of ticks from one row to the next. Pauses longer than anything that the wire remembers are
/// shortened to 60 s.
int ticks_between(TimeNs from_ns, TimeNs to_ns, double tick_s) {
    constexpr double longest_s = 60.0;
    return std::max(1, static_cast<int>(std::lround(std::min(longest_s, seconds(to_ns - from_ns)) / tick_s)));
}

/// Marks the rows in which the wire's memory is not known as unusable.
void leave_out_unknown_wire(const Recording& recording, const HeaterParameters& heater,
                            std::vector<bool>& usable) {
    constexpr double cold_taus = 5.0, shortest_pause_s = 0.01;
    const double longest_under_way_s = std::max(shortest_pause_s, most_steps_apart * recording.tick_s);
    bool is_known = true;
    // Time of the latest row with a command.
    TimeNs last_ns = recording.rows.empty() ? 0 : recording.rows.front().time_ns;
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

FinerStage finer_stage(const plant::PlantParameters& parameters) {
    FIDSERVO_DEMAND(parameters.micro.has_value());
    constexpr double longest_part_s = 1e-3;
    const double parts = std::max(1.0, std::ceil(parameters.tick_s / longest_part_s - next_to_nothing));
    return {plant::make_micro_stage(*parameters.micro, parameters.tick_s / parts),
            static_cast<std::size_t>(parts)};
}

PlatformPrediction predicted_readings(const PlatformModel& model, const PlatformRun& run,
                                      const CarriagePath* carriage, const FinerStage* finer) {
    return Pass(model, run, carriage, finer).predict();
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/controller_link.h"

#include "control/nonlinear_pd.h"
#include "control/pi_antiwindup.h"
#include "core/hall.h"
#include "core/rig.h"
#include "gap/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace fidservo::gap {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double no_limit_V = std::numeric_limits<double>::infinity();

/// Experiments that the rig file's controllers define (src/simulation/experiments.h). A recording that names
/// a controller claims that one; a recording of such an experiment that names none claims that it was one of
/// the file's.
constexpr std::array<std::string_view, 3> closed_loop_experiments{"macro-square", "micro-servo",
                                                                  "integrated"};

bool claims(const Recording& recording, std::string ControllerNames::*stage, std::string_view controller) {
    if (recording.controllers) return (*recording.controllers).*stage == controller;
    return std::ranges::find(closed_loop_experiments, recording.experiment) != closed_loop_experiments.end();
}

/// Mean square of the errors that are known; infinite where none is.
double mean_square_of_finite(const std::vector<double>& errors) {
    double sum = 0.0, count = 0.0;
    for (const double error : errors) {
        if (std::isnan(error)) continue;
        sum += error * error;
        count += 1.0;
    }
    return count > 0.0 ? sum / count : std::numeric_limits<double>::infinity();
}

/// The state of a controller at the start of a stretch: newly started, or running before.
enum class Start { fresh, under_way };

/// Whether a stretch may find the controller in such a state; where the recording begins with it both are
/// possible, as it may have been begun while the controller ran.
bool may_start(Start start, const Recording& recording, const Stretch& stretch,
               double StageRow::*setpoint_mm) {
    if (stretch.first == 0) return true;
    const bool goes_on = std::isfinite(recording.rows[stretch.first - 1].*setpoint_mm);
    return goes_on == (start == Start::under_way);
}

/// Gives a stretch's errors, replayed minus recorded command: NaN while the controller's state is not known;
/// no errors where the stretch cannot find it in the assumed state.
using Replay = std::function<std::vector<double>(const Stretch&)>;

/// A run with the errors of that one of several replays which fits best, in each stretch.
ControllerRun best_run(const Recording& recording, const std::vector<bool>& usable,
                       const std::vector<Replay>& candidates) {
    ControllerRun run;
    run.error_V.assign(recording.rows.size(), no_value);
    if (candidates.empty()) return run;
    for (const Stretch& stretch : stretches(recording, usable)) {
        const auto windows = cut(stretch, recording.tick_s, LeadIn::none);
        std::vector<double> best;
        for (const Replay& replay : candidates) {
            std::vector<double> errors = replay(stretch);
            if (errors.empty()) continue;
            if (!best.empty() && mean_square_of_finite(errors) >= mean_square_of_finite(best)) continue;
            best = std::move(errors);
        }
        for (const WindowRows& window : windows) {
            run.windows.push_back(window);
            for (std::size_t k = window.first; k < window.end; ++k) run.error_V[k] = best[k - stretch.first];
        }
    }
    return run;
}

/// How firmware may compute an error in counts from a setpoint and a reading.
struct CountReading {
    bool truncates;          ///< the setpoint to whole counts; otherwise it is rounded
    std::size_t delay_rows;  ///< age of the reading
};

constexpr std::array<CountReading, 4> count_readings{{{false, 0}, {true, 0}, {false, 1}, {true, 1}}};

/// The counts to which a setpoint may have been converted: several where the file's last digit leaves that
/// open.
struct SetpointCounts {
    double low, stated, high;
};

/// @param step_mm  value of the file's last digit
SetpointCounts setpoint_counts(double setpoint_mm, double step_mm, double resolution_mm,
                               const CountReading& reading) {
    const double counts = setpoint_mm / resolution_mm + (reading.truncates ? 0.0 : 0.5);
    const double open_counts = 0.5 * step_mm / resolution_mm + next_to_nothing;  // the division rounds
    return {std::floor(counts - open_counts), std::floor(counts), std::floor(counts + open_counts)};
}

/// The PD along a stretch.
struct PdReplay {
    const MacroParameters* macro;
    bool restarts;  ///< whether it restarts with each setpoint
    bool is_known;  ///< whether the last error is known
    control::PdState state{};

    double command_V(double error_count, bool is_new_setpoint, double /*recorded_V*/) {
        if (restarts && is_new_setpoint) state = {};
        const double command_V = control::pd_update(*macro->pd, macro->command_limit_V, state, error_count);
        return std::exchange(is_known, true) ? command_V : no_value;
    }
};

/// The benchmark PID along a stretch. If it ran before, its integral follows from the first command that is
/// not saturated.
struct PidReplay {
    const MacroParameters* macro;
    double tick_s;
    bool is_known;
    bool has_last_error = false;
    control::PidState state{};

    double command_V(double error_count, bool /*is_new_setpoint*/, double recorded_V) {
        if (is_known)
            return control::pid_update(*macro->pid, macro->command_limit_V, tick_s, state, error_count);
        if (has_last_error && std::abs(recorded_V) < macro->command_limit_V) {
            control::PidState without_integral{0.0, state.last_error_count};
            PidGains gains = *macro->pid;
            gains.ki_V_per_count_s = 0.0;
            state.integral_V =
                recorded_V - control::pid_update(gains, no_limit_V, tick_s, without_integral, error_count);
            is_known = true;
        }
        has_last_error = true;
        state.last_error_count = error_count;
        return is_known ? recorded_V : no_value;
    }
};

/// The rows of a recording in which a controller ran.
struct Asked {
    const Recording& recording;
    const std::vector<bool>& left_out;  ///< the other rows; empty: none

    bool at(std::size_t row) const { return left_out.empty() || !left_out[row]; }
    /// The row whose reading the controller used at a row of a stretch.
    std::size_t sampled(const Stretch& stretch, std::size_t row, std::size_t delay_rows) const {
        std::size_t read = std::max(stretch.first, row - std::min(row, delay_rows));
        while (read > stretch.first && !at(read)) --read;
        return read;
    }
};

/// A controller's replay while one setpoint is held.
template <class Controller>
struct Held {
    Controller controller;  ///< in its state at the end
    std::vector<double> error_V;
};

/// A controller along a stretch. Where a setpoint leaves its count open, the count that fits best is used as
/// long as the setpoint is held. The errors grow with the distance from the best count, so that the search
/// from the stated count to either side ends as soon as they do.
template <class Controller>
std::vector<double> replayed(const Asked& asked, const Stretch& stretch, double resolution_mm,
                             const CountReading& reading, Controller controller) {
    const Recording& recording = asked.recording;
    const auto held = [&](std::size_t first, std::size_t end, double setpoint_count) {
        Held<Controller> found{controller, {}};
        for (std::size_t k = first; k < end; ++k) {
            if (!asked.at(k)) {
                found.error_V.push_back(no_value);
                continue;
            }
            const std::size_t sampled = asked.sampled(stretch, k, reading.delay_rows);
            const double error_count = setpoint_count - recording.rows[sampled].encoder_count;
            const double recorded_V = recording.rows[k].macro_command_V;
            const bool is_new = k == first && k > stretch.first;
            found.error_V.push_back(found.controller.command_V(error_count, is_new, recorded_V) - recorded_V);
        }
        return found;
    };
    std::vector<double> errors;
    for (std::size_t first = stretch.first; first < stretch.end;) {
        const double setpoint_mm = recording.rows[first].macro_setpoint_mm;
        std::size_t end = first + 1;
        while (end < stretch.end && recording.rows[end].macro_setpoint_mm == setpoint_mm) ++end;
        const SetpointCounts counts =
            setpoint_counts(setpoint_mm, recording.macro_setpoint_step_mm, resolution_mm, reading);
        Held<Controller> best = held(first, end, counts.stated);
        for (const double way : {-1.0, 1.0})
            for (double count = counts.stated + way; count >= counts.low && count <= counts.high;
                 count += way) {
                Held<Controller> other = held(first, end, count);
                if (mean_square_of_finite(other.error_V) >= mean_square_of_finite(best.error_V)) break;
                best = std::move(other);
            }
        errors.insert(errors.end(), best.error_V.begin(), best.error_V.end());
        controller = best.controller;
        first = end;
    }
    return errors;
}

/// The PI along a stretch. If it ran before, its integral follows from the first command that is not
/// saturated.
/// @param delay_rows  age of the reading that it uses
std::vector<double> replayed_pi(const Asked& asked, const Stretch& stretch, const MicroParameters& micro,
                                std::size_t delay_rows, bool is_known) {
    const Recording& recording = asked.recording;
    const PiGains& gains = *micro.pi;
    control::PiState state = control::pi_start(gains);
    std::vector<double> errors;
    for (std::size_t k = stretch.first; k < stretch.end; ++k) {
        if (!asked.at(k)) {
            errors.push_back(no_value);
            continue;
        }
        const StageRow& row = recording.rows[k];
        const std::size_t sampled = asked.sampled(stretch, k, delay_rows);
        const double error_mm =
            row.micro_setpoint_mm - hall_position_mm_of_adc(micro.hall, recording.rows[sampled].hall_adc);
        if (!is_known && row.micro_command_V > gains.low_V && row.micro_command_V < gains.high_V) {
            state.integral_V = row.micro_command_V - gains.kp_V_per_mm * error_mm;
            is_known = true;
        }
        errors.push_back(is_known ? control::pi_update(gains, recording.tick_s, state, error_mm) -
                                        row.micro_command_V
                                  : no_value);
    }
    return errors;
}

}  // namespace

bool claims_controller(const Recording& recording) {
    for (const auto stage : {&ControllerNames::macro, &ControllerNames::micro})
        for (const std::string_view controller : {"nonlinear_pd", "benchmark_pid", "pi_antiwindup"})
            if (claims(recording, stage, controller)) return true;
    return false;
}

ControllerRun macro_controller_run(const Recording& recording, const Rig& rig,
                                   const std::vector<bool>& left_out) {
    const Asked asked{recording, left_out};
    const MacroParameters& macro = rig.macro;
    std::vector<bool> usable;
    for (const StageRow& row : recording.rows)
        usable.push_back(std::isfinite(row.macro_setpoint_mm) && std::isfinite(row.encoder_count) &&
                         std::isfinite(row.macro_command_V));
    const bool pd = macro.pd && claims(recording, &ControllerNames::macro, "nonlinear_pd");
    const bool pid = macro.pid && claims(recording, &ControllerNames::macro, "benchmark_pid");
    std::vector<Replay> candidates;
    for (const Start start : {Start::fresh, Start::under_way})
        for (const CountReading& reading : count_readings) {
            const auto add = [&](auto controller) {
                candidates.emplace_back([&, start, reading, controller](const Stretch& stretch) {
                    if (!may_start(start, recording, stretch, &StageRow::macro_setpoint_mm))
                        return std::vector<double>();
                    return replayed(asked, stretch, macro.encoder_resolution_mm, reading, controller);
                });
            };
            const bool known = start == Start::fresh;
            if (pd) add(PdReplay{&macro, false, known});
            if (pd) add(PdReplay{&macro, true, known});
            if (pid) add(PidReplay{&macro, recording.tick_s, known});
        }
    return best_run(recording, usable, candidates);
}

ControllerRun micro_controller_run(const Recording& recording, const Rig& rig,
                                   const std::vector<bool>& left_out) {
    const Asked asked{recording, left_out};
    std::vector<bool> usable;
    for (const StageRow& row : recording.rows)
        usable.push_back(std::isfinite(row.micro_setpoint_mm) && std::isfinite(row.hall_adc) &&
                         std::isfinite(row.micro_command_V));
    std::vector<Replay> candidates;
    if (rig.micro && rig.micro->pi && claims(recording, &ControllerNames::micro, "pi_antiwindup")) {
        const auto add = [&](Start start, std::size_t delay_rows) {
            candidates.emplace_back([&recording, &rig, &asked, start, delay_rows](const Stretch& stretch) {
                if (!may_start(start, recording, stretch, &StageRow::micro_setpoint_mm))
                    return std::vector<double>();
                return replayed_pi(asked, stretch, *rig.micro, delay_rows, start == Start::fresh);
            });
        };
        for (const Start start : {Start::fresh, Start::under_way})
            for (const std::size_t delay_rows : {0U, 1U}) add(start, delay_rows);
    }
    return best_run(recording, usable, candidates);
}

double controller_floor_V(const std::vector<double>& command_V) {
    constexpr double least_V = 1e-4, coarsest_V = 1.0, tolerance = 1e-6, decade = 10.0;
    const auto all_multiples = [&](double quantum_V) {
        return std::ranges::all_of(command_V, [&](double command) {
            const double steps = command / quantum_V;
            return !std::isfinite(command) || std::abs(steps - std::round(steps)) < tolerance;
        });
    };
    const bool is_idle =
        std::ranges::none_of(command_V, [](double command) { return std::abs(command) > 0.0; });
    double quantum_V = least_V;
    if (is_idle || !all_multiples(quantum_V)) return least_V;
    while (quantum_V < coarsest_V && all_multiples(decade * quantum_V)) quantum_V *= decade;
    return std::max(least_V, quantum_V / std::sqrt(uniform_divisor));
}

double counted_floors(double error_V, double floor_V) {
    constexpr double most = 10.0;
    return std::clamp(error_V / floor_V, -most, most);
}

}  // namespace fidservo::gap

#include "gap/controller_link.h"

#include "control/nonlinear_pd.h"
#include "control/pi_antiwindup.h"
#include "core/hall.h"
#include "core/rig.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace fidservo::gap {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double no_limit_V = std::numeric_limits<double>::infinity();

/// Commands of a stretch, from the state in which a controller starts, or that its commands show where it is
/// under way; NaN where they do not yet.
using Replay = std::function<std::vector<double>(const Stretch&)>;

/// Of the rows that it says something of; infinite where that is none.
double mean_square_of_finite(const std::vector<double>& errors) {
    double sum = 0.0, count = 0.0;
    for (const double error : errors) {
        if (std::isnan(error)) continue;
        sum += error * error;
        count += 1.0;
    }
    return count > 0.0 ? sum / count : std::numeric_limits<double>::infinity();
}

/// Whether a stretch begins where control goes on after rows that are missing.
bool is_under_way(const Recording& recording, const Stretch& stretch, double StageRow::*setpoint_mm) {
    return stretch.first > 0 && std::isfinite(recording.rows[stretch.first - 1].*setpoint_mm);
}

/// Fills a run with what the best of several replays leaves in each stretch.
ControllerRun best_run(const Recording& recording, const std::vector<bool>& usable,
                       const std::vector<Replay>& candidates, double StageRow::*command_V) {
    ControllerRun run;
    run.error_V.assign(recording.rows.size(), no_value);
    if (candidates.empty()) return run;
    for (const Stretch& stretch : stretches(recording, usable)) {
        const auto windows = cut(stretch, recording.tick_s, LeadIn::none);
        std::vector<double> best;
        for (const Replay& replay : candidates) {
            std::vector<double> errors = replay(stretch);
            for (std::size_t i = 0; i < errors.size(); ++i)
                errors[i] -= recording.rows[stretch.first + i].*command_V;
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

}  // namespace

ControllerRun macro_controller_run(const Recording& recording, const Rig& rig) {
    std::vector<bool> usable;
    std::vector<double> error_count;
    for (const StageRow& row : recording.rows) {
        const double resolution_mm = rig.macro.encoder_resolution_mm;
        const double setpoint_count = std::floor(row.macro_setpoint_mm / resolution_mm + 0.5);
        error_count.push_back(setpoint_count - row.encoder_count);
        usable.push_back(std::isfinite(error_count.back()) && std::isfinite(row.macro_command_V));
    }
    const double limit_V = rig.macro.command_limit_V;
    const auto pd = [&](bool restarts) {
        return [&, restarts](const Stretch& stretch) {
            std::vector<double> commands;
            control::PdState state;
            for (std::size_t k = stretch.first; k < stretch.end; ++k) {
                const bool is_new = k > stretch.first && recording.rows[k].macro_setpoint_mm !=
                                                             recording.rows[k - 1].macro_setpoint_mm;
                if (restarts && is_new) state = {};
                commands.push_back(control::pd_update(*rig.macro.pd, limit_V, state, error_count[k]));
            }
            if (is_under_way(recording, stretch, &StageRow::macro_setpoint_mm)) commands.front() = no_value;
            return commands;
        };
    };
    const auto pid = [&](const Stretch& stretch) {
        std::vector<double> commands;
        control::PidState state;
        bool is_known = !is_under_way(recording, stretch, &StageRow::macro_setpoint_mm);
        for (std::size_t k = stretch.first; k < stretch.end; ++k) {
            const double command_V = recording.rows[k].macro_command_V;
            if (!is_known && k > stretch.first && std::abs(command_V) < limit_V) {
                control::PidState without_integral{0.0, state.last_error_count};
                PidGains gains = *rig.macro.pid;
                gains.ki_V_per_count_s = 0.0;
                state.integral_V = command_V - control::pid_update(gains, no_limit_V, recording.tick_s,
                                                                   without_integral, error_count[k]);
                state.last_error_count = error_count[k];
                is_known = true;
                commands.push_back(command_V);
            } else if (is_known) {
                commands.push_back(
                    control::pid_update(*rig.macro.pid, limit_V, recording.tick_s, state, error_count[k]));
            } else {
                state.last_error_count = error_count[k];
                commands.push_back(no_value);
            }
        }
        return commands;
    };
    std::vector<Replay> candidates;
    if (rig.macro.pd) candidates = {pd(false), pd(true)};
    if (rig.macro.pid) candidates.push_back(pid);
    return best_run(recording, usable, candidates, &StageRow::macro_command_V);
}

ControllerRun micro_controller_run(const Recording& recording, const Rig& rig) {
    std::vector<bool> usable;
    for (const StageRow& row : recording.rows)
        usable.push_back(std::isfinite(row.micro_setpoint_mm) && std::isfinite(row.hall_adc) &&
                         std::isfinite(row.micro_command_V));
    std::vector<Replay> candidates;
    if (rig.micro && rig.micro->pi) {
        candidates.push_back([&](const Stretch& stretch) {
            const PiGains& gains = *rig.micro->pi;
            std::vector<double> commands;
            control::PiState state = control::pi_start(gains);
            bool is_known = !is_under_way(recording, stretch, &StageRow::micro_setpoint_mm);
            for (std::size_t k = stretch.first; k < stretch.end; ++k) {
                const StageRow& row = recording.rows[k];
                const double error_mm =
                    row.micro_setpoint_mm - hall_position_mm_of_adc(rig.micro->hall, row.hall_adc);
                if (!is_known && row.micro_command_V > gains.low_V && row.micro_command_V < gains.high_V) {
                    state.integral_V = row.micro_command_V - gains.kp_V_per_mm * error_mm;
                    is_known = true;
                }
                commands.push_back(is_known ? control::pi_update(gains, recording.tick_s, state, error_mm)
                                            : no_value);
            }
            return commands;
        });
    }
    return best_run(recording, usable, candidates, &StageRow::micro_command_V);
}

double controller_floor_V(const std::vector<double>& command_V) {
    constexpr double least_V = 1e-4, coarsest_V = 1.0, tolerance = 1e-6;
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
    while (quantum_V < coarsest_V && all_multiples(10.0 * quantum_V)) quantum_V *= 10.0;
    return std::max(least_V, quantum_V / std::sqrt(12.0));
}

double counted_floors(double error_V, double floor_V) {
    constexpr double most = 10.0;
    return std::clamp(error_V / floor_V, -most, most);
}

}  // namespace fidservo::gap

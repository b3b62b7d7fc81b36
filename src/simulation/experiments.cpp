// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/experiments.h"

#include "core/input_error.h"
#include "core/random.h"
#include "core/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// Draws an experiment's free choices, in the units of the rig.
class Excitation {
  public:
    Excitation(const Rig& rig, std::uint64_t seed, std::string_view name)
        : rig_(rig), noise_(seed, fmt::format("excitation/{}", name)) {}

    double between(double low, double high) { return low + (high - low) * noise_.uniform(); }
    /// A place on the macro travel, given as shares of it.
    double carriage_mm(double low, double high) {
        return place(rig_.macro.low_mm, rig_.macro.high_mm, between(low, high));
    }
    double platform_mm(double low, double high) {
        return place(rig_.micro->low_mm, rig_.micro->high_mm, between(low, high));
    }
    /// A motor voltage above the dead zone, as shares of what remains up to the limit.
    double motor_V(double low, double high) {
        return place(rig_.macro.dead_zone.threshold_V, rig_.macro.command_limit_V, between(low, high));
    }
    double heater_V(double low, double high) {
        return place(rig_.micro->heater.onset_V, rig_.micro->heater.limit_V, between(low, high));
    }
    double travel_mm() const { return rig_.macro.high_mm - rig_.macro.low_mm; }
    const Rig& rig() const { return rig_; }

  private:
    static double place(double low, double high, double share) { return low + share * (high - low); }

    const Rig& rig_;
    NoiseStream noise_;
};

Experiment rest(Excitation& draw) {
    return {.kind = "rest", .duration_s = 4.0, .carriage_mm = draw.carriage_mm(0.3, 0.7)};
}

/// Pulses to either side, each long enough for about a quarter of the travel, with rests between.
Experiment macro_pulses(Excitation& draw) {
    constexpr int pulses = 18;
    constexpr double period_s = 0.7, longest_s = 0.28;
    const MacroParameters& macro = draw.rig().macro;
    std::vector<double> times_s, volts;
    for (int i = 0; i < pulses; ++i) {
        const double u_V = draw.motor_V(0.07, 1.0);
        const double effective_V =
            macro.dead_zone.offset_V + macro.dead_zone.slope * (u_V - macro.dead_zone.threshold_V);
        const double way_mm = 0.225 * draw.travel_mm();
        const double length_s =
            std::min(longest_s, way_mm / (macro.velocity_gain_mm_per_s_per_V * effective_V));
        times_s.insert(times_s.end(), {i * period_s, i * period_s + length_s});
        volts.insert(volts.end(), {i % 2 == 0 ? u_V : -u_V, 0.0});
    }
    return {.kind = "macro-pulses",
            .duration_s = pulses * period_s,
            .carriage_mm = draw.carriage_mm(0.4, 0.4),
            .macro_V = steps(std::move(times_s), std::move(volts))};
}

/// A sine that reverses the carriage and crosses the dead zone at a steady rate.
Experiment macro_sweep(Excitation& draw) {
    const double amplitude_V = draw.motor_V(0.3, 0.9);
    const double omega = 2.0 * std::numbers::pi * draw.between(0.45, 0.6);
    return {.kind = "macro-sweep",
            .duration_s = 12.0,
            .carriage_mm = draw.carriage_mm(0.5, 0.5),
            .macro_V = [=](double t_s) { return amplitude_V * std::sin(omega * t_s); }};
}

/// Closed loop: setpoints around the middle whose distance shrinks from step to step.
Experiment macro_square(Excitation& draw) {
    constexpr int setpoints = 8;
    constexpr double period_s = 2.0;
    double distance_mm = draw.between(0.15, 0.25) * draw.travel_mm();
    const double shrinking = -draw.between(0.6, 0.75);
    const double middle_mm = draw.carriage_mm(0.5, 0.5);
    std::vector<double> times_s, places_mm;
    for (int i = 0; i < setpoints; ++i, distance_mm *= shrinking) {
        times_s.push_back(i * period_s);
        places_mm.push_back(middle_mm + distance_mm);
    }
    return {.kind = "macro-square",
            .duration_s = setpoints * period_s,
            .carriage_mm = middle_mm,
            .macro_setpoint_mm = steps(std::move(times_s), std::move(places_mm))};
}

/// Heats for a while, cools for a while, to another temperature each time.
Experiment micro_steps(Excitation& draw) {
    constexpr int heatings = 5;
    constexpr double period_s = 7.0, heating_s = 3.2;
    std::vector<double> times_s, volts;
    for (int i = 0; i < heatings; ++i) {
        times_s.insert(times_s.end(), {i * period_s, i * period_s + heating_s});
        volts.insert(volts.end(), {draw.heater_V(0.2, 0.92), 0.0});
    }
    return {.kind = "micro-steps",
            .duration_s = heatings * period_s,
            .carriage_mm = draw.carriage_mm(0.5, 0.5),
            .micro_V = steps(std::move(times_s), std::move(volts))};
}

/// A triangle whose peaks rise: each turn reaches a little further into the hysteresis.
Experiment micro_triangle(Excitation& draw) {
    constexpr double duration_s = 32.0;
    const double period_s = draw.between(6.0, 8.0);
    const double low_V = draw.heater_V(0.1, 0.1);
    const double last_V = draw.heater_V(0.41, 0.41) - low_V;
    const double first_V = last_V * draw.between(0.6, 0.75);
    return {.kind = "micro-triangle",
            .duration_s = duration_s,
            .carriage_mm = draw.carriage_mm(0.5, 0.5),
            .micro_V = [=](double t_s) {
                const double phase = std::fmod(t_s, period_s) / period_s;
                const double height = 1.0 - std::abs(2.0 * phase - 1.0);
                return low_V + height * (first_V + (last_V - first_V) * t_s / duration_s);
            }};
}

/// Closed loop: a new setpoint every three seconds.
Experiment micro_servo(Excitation& draw) {
    constexpr int setpoints = 10;
    constexpr double period_s = 3.0;
    std::vector<double> times_s, places_mm;
    for (int i = 0; i < setpoints; ++i) {
        times_s.push_back(i * period_s);
        places_mm.push_back(draw.platform_mm(0.1, 0.85));
    }
    return {.kind = "micro-servo",
            .duration_s = setpoints * period_s,
            .carriage_mm = draw.carriage_mm(0.5, 0.5),
            .micro_setpoint_mm = steps(std::move(times_s), std::move(places_mm))};
}

/// Both stages closed: macro moves over the whole travel, micro setpoints at each place.
Experiment integrated(Excitation& draw) {
    constexpr int places = 5;
    constexpr double period_s = 8.0;
    constexpr std::array micro_times_s{0.0, 3.0, 5.5};
    std::vector<double> macro_times_s, macro_mm, micro_times, micro_mm;
    for (int i = 0; i < places; ++i) {
        macro_times_s.push_back(i * period_s);
        macro_mm.push_back(draw.carriage_mm(0.1, 0.9));
        for (const double t_s : micro_times_s) {
            micro_times.push_back(i * period_s + t_s);
            micro_mm.push_back(draw.platform_mm(0.25, 0.72));
        }
    }
    const double start_mm = macro_mm.front();
    return {.kind = "integrated",
            .duration_s = places * period_s,
            .carriage_mm = start_mm,
            .macro_setpoint_mm = steps(std::move(macro_times_s), std::move(macro_mm)),
            .micro_setpoint_mm = steps(std::move(micro_times), std::move(micro_mm))};
}

struct Kind {
    std::string_view name;
    Experiment (*make)(Excitation&);
    bool macro_loop, micro, micro_loop;  ///< what the rig must have
};

constexpr std::array kinds{Kind{"rest", rest, false, false, false},
                           Kind{"macro-pulses", macro_pulses, false, false, false},
                           Kind{"macro-sweep", macro_sweep, false, false, false},
                           Kind{"macro-square", macro_square, true, false, false},
                           Kind{"micro-steps", micro_steps, false, true, false},
                           Kind{"micro-triangle", micro_triangle, false, true, false},
                           Kind{"micro-servo", micro_servo, false, true, true},
                           Kind{"integrated", integrated, true, true, true}};

const Kind& find_kind(std::string_view name) {
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.name == name; });
    if (found == kinds.end())
        throw InputError(fmt::format("{}: unknown experiment; allowed: {}, campaign, FILE.yaml", name,
                                     fmt::join(experiment_kinds(), ", ")));
    return *found;
}

}  // namespace

Course steps(std::vector<double> times_s, std::vector<double> values) {
    return [times = std::move(times_s), values = std::move(values)](double t_s) {
        const auto next = std::upper_bound(times.begin(), times.end(), t_s + 1e-9);
        return values[static_cast<std::size_t>(next - times.begin()) - 1];
    };
}

const std::vector<std::string_view>& experiment_kinds() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> result;
        result.reserve(std::size(kinds));
        for (const Kind& kind : kinds) result.push_back(kind.name);
        return result;
    }();
    return names;
}

std::string missing_for(std::string_view name, const Rig& rig) {
    const Kind& kind = find_kind(name);
    if (kind.macro_loop && !rig.macro.pd) return "macro.pd";
    if (kind.micro && !rig.micro) return "micro";
    if (kind.micro_loop && !rig.micro->pi) return "micro.pi";
    return "";
}

std::vector<CampaignRun> campaign_runs(const Rig& rig) {
    std::vector<CampaignRun> runs;
    for (const Kind& kind : kinds) {
        if (!missing_for(kind.name, rig).empty()) continue;
        for (const int copy : {1, 2})
            runs.push_back({std::string(kind.name), fmt::format("{}-{}", kind.name, copy)});
    }
    return runs;
}

Experiment make_experiment(std::string_view name, const Rig& rig, std::uint64_t seed,
                           std::string_view recording_name) {
    const Kind& kind = find_kind(name);
    if (const std::string missing = missing_for(name, rig); !missing.empty())
        throw InputError(
            fmt::format("{}: the rig {} has no {}, which this experiment needs", name, rig.name, missing));
    Excitation draw(rig, seed, recording_name);
    return kind.make(draw);
}

}  // namespace fidservo

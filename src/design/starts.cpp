// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/starts.h"

#include "core/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

namespace fidservo::design {
namespace {

constexpr double shortest_design_s = 20.0;

/// A stage's course in pieces: constants as long as it does not change, or a sine from phase 0 on about 0,
/// whose samples obey u(t + h) + u(t - h) = 2 cos(omega h) u(t).
std::optional<std::vector<DesignedPiece>> pieces_of(const Course& course, Follows follows, double lasts_s,
                                                    double tick_s) {
    constexpr std::size_t too_many = 200;
    const auto ticks = static_cast<std::size_t>(std::llround(lasts_s / tick_s));
    std::vector<DesignedPiece> constants;
    for (std::size_t k = 0; k < ticks && constants.size() <= too_many; ++k) {
        const double value = course(static_cast<double>(k) * tick_s);
        if (!std::isfinite(value)) return {};
        if (constants.empty() || value != constants.back().value)
            constants.push_back({.follows = follows, .value = value, .is_rest = value == 0.0});
        constants.back().duration_s += tick_s;
    }
    if (constants.size() <= too_many) return constants;
    const double first = course(tick_s), second = course(2.0 * tick_s), third = course(3.0 * tick_s);
    const double cosine = 0.5 * second / first;
    constexpr double rounding = 1e-6;
    if (course(0.0) != 0.0 || !(std::abs(cosine) < 1.0) ||
        std::abs(third + first - 2.0 * cosine * second) > rounding * std::abs(first))
        return {};
    const double omega = std::acos(cosine) / tick_s;
    return std::vector<DesignedPiece>{{.follows = follows,
                                       .shape = Shape::sine,
                                       .duration_s = lasts_s,
                                       .amplitude = first / std::sin(omega * tick_s),
                                       .frequency_hz = omega / (2.0 * std::numbers::pi)}};
}

/// Draws a stage's pieces.
class Drawing {
  public:
    Drawing(const Rig& rig, double lasts_s, NoiseStream& draw) : rig_(rig), left_s_(lasts_s), draw_(draw) {}

    double between(double low, double high) { return low + (high - low) * draw_.uniform(); }
    double log_between(double low, double high) { return low * std::pow(high / low, draw_.uniform()); }
    bool with(double probability) { return draw_.uniform() < probability; }
    std::size_t one_of(std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(draw_.uniform() * static_cast<double>(count)));
    }

    const Rig& rig() const { return rig_; }
    bool is_over() const { return left_s_ <= 0.0; }
    void add(DesignedPiece piece) {
        left_s_ -= piece.duration_s;
        pieces.push_back(piece);
    }
    void rest(double lasts_s) { add({.duration_s = lasts_s, .is_rest = true}); }
    void setpoint(double place_mm, double lasts_s) {
        add({.follows = Follows::setpoint, .duration_s = lasts_s, .value = place_mm});
    }
    void volts(double volts, double lasts_s) { add({.duration_s = lasts_s, .value = volts}); }
    void ramp(Follows follows, double from, double to, double lasts_s) {
        add({.follows = follows, .shape = Shape::ramp, .duration_s = lasts_s, .value = from, .end = to});
    }
    /// @param low, high  shares of the travel
    double carriage_mm(double low, double high) {
        return rig_.macro.low_mm + between(low, high) * (rig_.macro.high_mm - rig_.macro.low_mm);
    }
    double platform_mm(double low, double high) {
        return rig_.micro->low_mm + between(low, high) * (rig_.micro->high_mm - rig_.micro->low_mm);
    }
    double heater_V(double low, double high) {
        const HeaterParameters& heater = rig_.micro->heater;
        return heater.onset_V + between(low, high) * (heater.limit_V - heater.onset_V);
    }

    std::vector<DesignedPiece> pieces;

  private:
    const Rig& rig_;
    double left_s_;
    NoiseStream& draw_;
};

/// A pulse that takes the carriage as far as asked for, by the rig file's velocity and dead zone.
void pulse(Drawing& draw, double side, double way_mm) {
    const MacroParameters& macro = draw.rig().macro;
    const DeadZone& zone = macro.dead_zone;
    const double room_V = macro.command_limit_V - zone.threshold_V;
    const double u_V = zone.threshold_V + draw.log_between(0.01, 1.0) * room_V;
    const double speed_mm_per_s =
        macro.velocity_gain_mm_per_s_per_V * (zone.offset_V + zone.slope * (u_V - zone.threshold_V));
    constexpr double longest_pulse_s = 1.5;
    draw.volts(side * u_V, std::min(longest_pulse_s, way_mm / speed_mm_per_s));
}

void carriage_pulses(Drawing& draw) {
    const double way_mm = draw.log_between(0.01, 0.3) * (draw.rig().macro.high_mm - draw.rig().macro.low_mm);
    const double rest_s = draw.log_between(0.1, 0.8);
    for (double side = draw.with(0.5) ? 1.0 : -1.0; !draw.is_over(); side = -side) {
        pulse(draw, side, way_mm);
        draw.rest(rest_s);
    }
}

void carriage_sines(Drawing& draw) {
    const MacroParameters& macro = draw.rig().macro;
    while (!draw.is_over()) {
        const double frequency_hz = draw.log_between(0.15, 4.0);
        const double way_mm = draw.between(0.05, 0.6) * (macro.high_mm - macro.low_mm);
        const double wanted_V = macro.dead_zone.threshold_V + 0.5 * way_mm * 2.0 * std::numbers::pi *
                                                                  frequency_hz /
                                                                  macro.velocity_gain_mm_per_s_per_V;
        const double periods = std::ceil(draw.between(3.0, 12.0) * frequency_hz);
        draw.add({.shape = Shape::sine,
                  .duration_s = periods / frequency_hz,
                  .amplitude = std::min(wanted_V, macro.command_limit_V),
                  .frequency_hz = frequency_hz});
    }
}

void carriage_steps(Drawing& draw) {
    const double period_s = draw.between(0.6, 3.0);
    while (!draw.is_over()) draw.setpoint(draw.carriage_mm(0.05, 0.95), period_s);
}

void carriage_small_steps(Drawing& draw) {
    const double period_s = draw.between(0.4, 1.5);
    const double widest = draw.log_between(0.005, 0.1), middle = draw.between(0.2, 0.8);
    while (!draw.is_over()) draw.setpoint(draw.carriage_mm(middle - widest, middle + widest), period_s);
}

/// Ramps of the setpoint from place to place.
void ramps(Drawing& draw, double place_mm, const std::function<double()>& next_place_mm,
           const std::function<double()>& next_duration_s) {
    while (!draw.is_over()) {
        const double next_mm = next_place_mm();
        draw.ramp(Follows::setpoint, place_mm, next_mm, next_duration_s());
        place_mm = next_mm;
    }
}

void carriage_ramps(Drawing& draw) {
    ramps(
        draw, draw.carriage_mm(0.05, 0.95), [&] { return draw.carriage_mm(0.05, 0.95); },
        [&] { return draw.log_between(0.5, 8.0); });
}

void carriage_places_and_pulses(Drawing& draw) {
    const double travel_mm = draw.rig().macro.high_mm - draw.rig().macro.low_mm;
    while (!draw.is_over()) {
        draw.setpoint(draw.carriage_mm(0.35, 0.65), draw.between(0.8, 1.6));
        const double side = draw.with(0.5) ? 1.0 : -1.0;
        for (int k = 0; k < 2; ++k) {
            pulse(draw, side, draw.between(0.02, 0.15) * travel_mm);
            draw.rest(draw.between(0.2, 0.6));
        }
    }
}

void heat_and_cool(Drawing& draw) {
    const double heating_s = draw.between(0.5, 4.0), cooling_s = draw.between(0.3, 4.0);
    const bool cools = draw.with(0.6);
    while (!draw.is_over()) {
        draw.volts(draw.heater_V(0.1, 0.95), heating_s);
        if (cools) draw.rest(cooling_s);
    }
}

void triangles_of_voltage(Drawing& draw) {
    const double half_s = draw.between(1.0, 6.0);
    double low_V = draw.heater_V(0.0, 0.2);
    while (!draw.is_over()) {
        const double high_V = draw.heater_V(0.3, 0.7), next_V = draw.heater_V(0.0, 0.4);
        draw.ramp(Follows::voltage, low_V, high_V, half_s);
        draw.ramp(Follows::voltage, high_V, next_V, half_s);
        low_V = next_V;
    }
}

void platform_steps(Drawing& draw) {
    const double period_s = draw.between(0.8, 4.0);
    while (!draw.is_over()) draw.setpoint(draw.platform_mm(0.05, 0.9), period_s);
}

void platform_ramps(Drawing& draw) {
    ramps(
        draw, draw.platform_mm(0.05, 0.3), [&] { return draw.platform_mm(0.05, 0.9); },
        [&] { return draw.between(1.0, 8.0); });
}

void platform_sines(Drawing& draw) {
    const double travel_mm = draw.rig().micro->high_mm - draw.rig().micro->low_mm;
    while (!draw.is_over())
        draw.add({.follows = Follows::setpoint,
                  .shape = Shape::sine,
                  .duration_s = draw.between(4.0, 15.0),
                  .value = draw.platform_mm(0.3, 0.7),
                  .amplitude = draw.between(0.05, 0.3) * travel_mm,
                  .frequency_hz = draw.log_between(0.05, 1.0)});
}

void constant_heat(Drawing& draw) {
    while (!draw.is_over()) draw.volts(draw.heater_V(0.2, 0.8), draw.between(10.0, 30.0));
}

void at_rest(Drawing&) {}

struct Way {
    void (*draw)(Drawing&);
    bool needs_controller;
};

constexpr std::array carriage_ways{Way{carriage_pulses, false}, Way{carriage_sines, false},
                                   Way{carriage_steps, true},   Way{carriage_small_steps, true},
                                   Way{carriage_ramps, true},   Way{carriage_places_and_pulses, true}};
constexpr std::array platform_ways{Way{heat_and_cool, false}, Way{triangles_of_voltage, false},
                                   Way{platform_steps, true}, Way{platform_ramps, true},
                                   Way{platform_sines, true}, Way{constant_heat, false}};

/// @param often  the probability with which the stage moves
Way drawn_way(std::span<const Way> ways, bool has_controller, double often, Drawing& draw) {
    if (!draw.with(often)) return {at_rest, false};
    for (;;)
        if (const Way& way = ways[draw.one_of(ways.size())]; has_controller || !way.needs_controller)
            return way;
}

}  // namespace

std::optional<Design> as_design(const Experiment& experiment, const Rig& rig) {
    Design design{experiment.carriage_mm, {}, {}};
    const double lasts_s = std::min(experiment.duration_s, longest_s);
    const auto put = [&](std::vector<DesignedPiece>& pieces, const Course& volts, const Course& setpoints) {
        if (!volts && !setpoints) return true;
        if (volts && setpoints) return false;
        auto found = volts ? pieces_of(volts, Follows::voltage, lasts_s, rig.tick_s)
                           : pieces_of(setpoints, Follows::setpoint, lasts_s, rig.tick_s);
        if (found) pieces = std::move(*found);
        return found.has_value();
    };
    if (!put(design.macro, experiment.macro_V, experiment.macro_setpoint_mm) ||
        !put(design.micro, experiment.micro_V, experiment.micro_setpoint_mm))
        return {};
    if (design.macro.empty() && design.micro.empty()) return {};
    return rounded(std::move(design), rig);
}

Design drawn_design(const Rig& rig, const Emphasis& emphasis, NoiseStream& draw) {
    constexpr double usually = 0.9, sometimes = 0.3;
    const double lasts_s = shortest_design_s + (longest_s - shortest_design_s) * draw.uniform();
    Drawing macro(rig, lasts_s, draw), micro(rig, lasts_s, draw);
    const double macro_often = emphasis.macro ? usually : sometimes;
    drawn_way(carriage_ways, rig.macro.pd.has_value(), macro_often, macro).draw(macro);
    if (rig.micro) {
        const bool must = macro.pieces.empty();
        const double micro_often = must ? 1.0 : emphasis.micro ? usually : sometimes;
        drawn_way(platform_ways, rig.micro->pi.has_value(), micro_often, micro).draw(micro);
    } else if (macro.pieces.empty()) {
        carriage_pulses(macro);
    }
    return rounded({macro.carriage_mm(0.2, 0.8), std::move(macro.pieces), std::move(micro.pieces)}, rig);
}

}  // namespace fidservo::design

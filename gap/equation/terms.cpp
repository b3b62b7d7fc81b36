// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/terms.h"

#include "core/rig.h"
#include "gap/equation/term_library.h"
#include "gap/equation/visited.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace fidservo::gap {

namespace {

/// For each variable of a site, the range of its values in all recordings; 0 to 0 for a variable without
/// values.
std::array<Covered, plant::most_variables> covered_by(const Evidence& evidence, plant::Site site) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    std::array<Covered, plant::most_variables> ranges{};
    ranges.fill({infinite, -infinite});
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run)
        for (const SeenVariables& seen : variables_along(evidence, site, run))
            for (std::size_t k = 0; k < seen.size(); ++k) {
                if (!std::isfinite(seen[k])) continue;
                ranges[k].low = std::min(ranges[k].low, seen[k]);
                ranges[k].high = std::max(ranges[k].high, seen[k]);
            }
    for (Covered& range : ranges)
        if (range.low > range.high) range = {};
    return ranges;
}

/// Bends that cover a range side by side: twelve, and four wider ones.
std::vector<TermLibrary::Bend> bends_along(const Covered& range) {
    std::vector<TermLibrary::Bend> bends;
    constexpr std::array counts{12, 4};
    for (const int count : counts) {
        const double width = 2.0 * range.half() / count;
        for (int k = 0; k < count; ++k) bends.push_back({width, range.low + (k + 0.5) * width});
    }
    return bends;
}

constexpr std::array falling_speeds_mm_per_s{3.0, 8.0, 20.0, 60.0};
constexpr double slowest_mm_per_s = 0.5, fastest_mm_per_s = 300.0;
const TermShape falling_speed{"mm/s", 0.0, slowest_mm_per_s, fastest_mm_per_s};

constexpr int highest_power = 3;
/// Sizes of terms whose range is not known from the recordings.
constexpr double usual_acceleration_mm_per_s2 = 1e3, usual_drive_V = 3.0;

void add_carriage_terms(TermLibrary& library, plant::Port port, const CoveredRanges& ranges,
                        std::span<const double> periods_mm) {
    const KnownVariable place{"place", "mm", ranges.place_mm, "the place on the rail"};
    const KnownVariable speed{"speed", "mm/s", ranges.speed_mm_per_s, "speed"};
    const KnownVariable command{"command", "V", ranges.command_V, "the command"};
    const KnownVariable time{"time", "s", ranges.time_s, "time"};
    const KnownVariable way{"way", "mm", ranges.way_mm, "the way gone"};
    if (port == plant::Port::force) {
        library.add_constant({}, "the same everywhere");
        library.add_powers(place, highest_power);
        library.add_waves("place", periods_mm);
        library.add_steps_and_bells(place, bends_along(ranges.place_mm));
        library.add_powers(time, 1);
        library.add_fading({}, "fading with time");
        return;
    }
    if (port == plant::Port::drive_voltage) {
        constexpr double longest_delay_s = 0.05;
        constexpr std::array delays_s{0.003, 0.012};
        library.add_powers(command, 1);
        library.add_delayed(command, {"s", 0.0, 0.0, longest_delay_s}, delays_s);
        library.add(fmt::format("{0} * abs({0})", command.clipped()), "V2", std::pow(command.reach(), 2),
                    "growing with the square of the command");
        library.add_powers(command, highest_power);
        library.add_knees("sign(command) * max(0, abs(command) - shape)",
                          {"command", "V", {0.0, ranges.command_V.high}, "the command"},
                          "in proportion to the command beyond a size at which it begins");
        library.add_product(command, place);
        library.add_product(command, time);
        library.add_waves("place", periods_mm, command.clipped());
        return;
    }
    library.add_constant("direction", "constant against the motion");
    library.add_powers(speed, 1);
    library.add(fmt::format("{0} * abs({0})", speed.clipped()), "mm2/s2", std::pow(speed.reach(), 2),
                "growing with the square of speed, as the drag of a fluid does");
    library.add(fmt::format("{}^3", speed.clipped()), "mm3/s3", std::pow(speed.reach(), highest_power),
                "growing with the cube of speed");
    library.add(fmt::format("abs({})", speed.clipped()), "mm/s", speed.reach(),
                "in proportion to speed, other ways for the other direction");
    library.add_shaped({"direction * exp(-abs(speed) / shape)"}, falling_speed, falling_speeds_mm_per_s,
                       "that falls with speed (Stribeck)");
    library.add_shaped({"direction * exp(-(speed / shape)^2)"}, falling_speed, falling_speeds_mm_per_s,
                       "that falls with speed as a bell does (Stribeck)");
    library.add_shaped({"tanh(speed / shape)"}, falling_speed, falling_speeds_mm_per_s,
                       "that grows with speed to an end, as of a lubricated contact");
    library.add_powers(place, 2, "direction");
    library.add_product(speed, place);
    library.add_waves("place", periods_mm, "direction");
    library.add_steps_and_bells(place, bends_along(ranges.place_mm), "direction");
    library.add_powers(time, 1, "direction");
    library.add_product(speed, time);
    library.add_fading("direction", "fading with time");
    library.add_fading(speed.clipped(), "in proportion to speed, fading with time");
    library.add_powers(way, 1, "direction");
    library.add(fmt::format("direction * abs({})", command.clipped()), "V", command.reach(),
                "in proportion to what the drive pushes with, against the motion");
    library.add(fmt::format("direction * abs({0}) * abs({0})", "voltage"), "V2", std::pow(command.reach(), 2),
                "growing with the square of what the drive pushes with, against the motion");
}

void add_micro_terms(TermLibrary& library, plant::Port port, const CoveredRanges& ranges) {
    const KnownVariable wire{"wire_temp", "degC", ranges.wire_degC, "the wire's temperature"};
    const KnownVariable contraction{"contraction", "mm", ranges.contraction_mm, "contraction"};
    const KnownVariable platform{"platform", "mm", ranges.contraction_mm, "the platform's place"};
    const KnownVariable time{"time", "s", ranges.time_s, "time"};
    const KnownVariable place{"place", "mm", ranges.place_mm, "the carriage's place"};
    const KnownVariable speed{"speed", "mm/s", ranges.speed_mm_per_s, "the carriage's speed"};
    const KnownVariable heater{"heater_command", "V", ranges.heater_V, "the heater's voltage"};
    const KnownVariable heating{"heater_power", "degC", ranges.power_degC, "the heater's power"};
    const double rise = std::max(1.0, ranges.wire_degC.high - ranges.wire_degC.low);
    constexpr double least_rate_mm_per_s = 0.1;
    const double rate = std::max(least_rate_mm_per_s, ranges.contraction_mm.high - ranges.contraction_mm.low);
    constexpr double longest_heating_delay_s = 0.5, shortest_lag_s = 0.01, longest_lag_s = 10.0;
    constexpr std::array heating_delays_s{0.02, 0.1}, lags_s{0.05, 0.5};
    const auto add_rise = [&](int highest) {
        for (int power = 1; power <= highest; ++power)
            library.add(
                power == 1 ? "(wire_temp - room_temp)" : fmt::format("(wire_temp - room_temp)^{}", power),
                power == 1 ? "degC" : fmt::format("degC{}", power), std::pow(rise, power),
                power == 1
                    ? "in proportion to the wire's warmth above the room"
                    : fmt::format("growing with the power {} of the wire's warmth above the room", power));
    };
    switch (port) {
        case plant::Port::heater_power:
            library.add_constant({}, "the same at all times, as of a warmer room");
            library.add("heater_power", "degC", rise, "in proportion to the heater's power");
            library.add_delayed(heating, {"s", 0.0, 0.0, longest_heating_delay_s}, heating_delays_s);
            library.add("heater_power^2", "degC2", rise * rise,
                        "growing with the square of the heater's power");
            library.add_constant("(heater_power > 0)", "the same whenever it is heated");
            library.add("heater_power * time", "degC s", rise * ranges.time_s.high,
                        "in proportion to power and time");
            library.add_steps_and_bells(heating);
            library.add_knees("max(0, heater_command - shape)", heater,
                              "in proportion to the heater's voltage beyond one at which it begins");
            return;
        case plant::Port::heat_flow:
            library.add_constant({}, "the same at all times");
            add_rise(highest_power);
            for (const auto& [sign, words] :
                 {std::pair{'<', "in proportion to what it cools by, while it cools"},
                  std::pair{'>', "in proportion to what heats it, while it is heated"}})
                library.add(
                    fmt::format("(heater_power - wire_temp + room_temp) * (heater_power {} wire_temp - "
                                "room_temp)",
                                sign),
                    "degC", rise, words);
            library.add_lagging(wire, {"s", 0.0, shortest_slow_s, longest_slow_s}, slow_constants_s);
            library.add("contraction_rate", "mm/s", rate,
                        "in proportion to the rate of contraction, as latent heat is");
            library.add("abs(contraction_rate)", "mm/s", rate,
                        "in proportion to the speed of transformation");
            library.add_powers(contraction, 2);
            library.add("(wire_temp - room_temp) * clip(contraction, 0, 5)", "degC mm", rise * 2.0,
                        "in proportion to warmth times contraction");
            library.add_steps_and_bells(wire);
            library.add_steps_and_bells(contraction);
            return;
        case plant::Port::transformation:
            library.add_constant({}, "the same always");
            library.add_powers(contraction, highest_power);
            library.add("contraction_rate", "mm/s", rate, "in proportion to the rate of contraction");
            library.add("sign(contraction_rate)", "", 1.0,
                        "of one sign in contraction, the other in extension");
            library.add_powers(time, 1);
            library.add_steps_and_bells(contraction);
            library.add_powers(wire, 2);
            return;
        case plant::Port::contraction:
            library.add_powers(contraction, highest_power);
            library.add_steps_and_bells(contraction);
            library.add_powers(wire, 2);
            library.add_steps_and_bells(wire);
            library.add("contraction_rate", "mm/s", rate, "in proportion to its rate, as a lag is");
            library.add_lagging(contraction, {"s", 0.0, shortest_lag_s, longest_lag_s}, lags_s);
            library.add("clip(contraction, 0, 5) * time", "mm s", 2.0 * ranges.time_s.high,
                        "in proportion to contraction and time");
            return;
        case plant::Port::platform:
            library.add("acceleration", "mm/s2", usual_acceleration_mm_per_s2,
                        "in proportion to the carriage's acceleration");
            library.add_powers(speed, 1);
            library.add_powers(place, 2);
            return;
        case plant::Port::hall_voltage:
            library.add_constant({}, "the same always");
            library.add_powers(platform, highest_power);
            add_rise(2);
            library.add_steps_and_bells(platform);
            library.add_powers(time, 1);
            library.add_fading({}, "fading with time");
            library.add("drive", "V", usual_drive_V, "in proportion to the drive's voltage");
            library.add_powers(place, 2);
            library.add("acceleration", "mm/s2", usual_acceleration_mm_per_s2,
                        "in proportion to the carriage's acceleration");
            return;
        default:
            return;
    }
}

void add_camera_terms(TermLibrary& library, plant::Port port, const CoveredRanges& ranges,
                      std::span<const double> periods_mm) {
    const KnownVariable camera{"camera_place", "mm", ranges.view_mm, "the camera's place"};
    const KnownVariable tag{"tag_x", "mm", ranges.tag_mm, "the tag's place"};
    const KnownVariable time{"time", "s", ranges.time_s, "time"};
    switch (port) {
        case plant::Port::tag_x:
        case plant::Port::tag_y:
            library.add_constant({}, "the same for all tags");
            library.add_powers(tag, highest_power);
            library.add_steps_and_bells(tag);
            library.add_waves("tag_x", periods_mm);
            return;
        case plant::Port::frame_time:
            library.add_constant({}, "constant");
            library.add_powers(time, 2);
            return;
        default:
            library.add_constant({}, "constant");
            library.add_powers(camera, highest_power);
            library.add_steps_and_bells(camera);
            library.add_waves("camera_place", periods_mm);
            library.add_powers(time, 2);
            library.add_fading({}, "fading with time");
            return;
    }
}

}  // namespace

CoveredRanges covered_ranges(const Evidence& evidence) {
    const auto carriage = covered_by(evidence, plant::Site::carriage),
               wire = covered_by(evidence, plant::Site::micro),
               view = covered_by(evidence, plant::Site::camera);
    using namespace plant;
    return {.time_s = carriage[carriage_variable::time],
            .command_V = carriage[carriage_variable::command],
            .place_mm = carriage[carriage_variable::place],
            .speed_mm_per_s = carriage[carriage_variable::speed],
            .way_mm = carriage[carriage_variable::way],
            .wire_degC = wire[micro_variable::wire_temp],
            .contraction_mm = wire[micro_variable::contraction],
            .power_degC = wire[micro_variable::heater_power],
            .heater_V = wire[micro_variable::heater_command],
            .tag_mm = view[camera_variable::tag_x],
            .view_mm = view[camera_variable::camera_place]};
}

std::vector<Term> terms_of(plant::Port port, const CoveredRanges& ranges,
                           std::span<const double> periods_mm) {
    TermLibrary library;
    switch (plant::describe(port).site) {
        case plant::Site::carriage:
            add_carriage_terms(library, port, ranges, periods_mm);
            break;
        case plant::Site::encoder:
            library.add_powers({"place", "mm", ranges.place_mm, "the place on the rail"}, highest_power);
            library.add_waves("place", periods_mm);
            break;
        case plant::Site::micro:
            add_micro_terms(library, port, ranges);
            break;
        case plant::Site::camera:
            add_camera_terms(library, port, ranges, periods_mm);
            break;
    }
    return library.terms();
}

}  // namespace fidservo::gap

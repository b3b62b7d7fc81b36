// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/unknown.h"

#include "core/rig.h"
#include "gap/evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace fidservo::design {
namespace {

constexpr std::size_t bins = 12;

struct Named {
    std::string_view word;
    Quantity quantity;
};

/// Words of what a remainder depends on (gap/residuals/surrogate.h).
constexpr std::array quantity_words{Named{"velocity", Quantity::velocity},
                                    Named{"direction", Quantity::velocity},
                                    Named{"slides", Quantity::velocity},
                                    Named{"position", Quantity::position},
                                    Named{"place on the plate", Quantity::position},
                                    Named{"macro command", Quantity::macro_command},
                                    Named{"temperature", Quantity::temperature},
                                    Named{"contraction", Quantity::contraction},
                                    Named{"place of the platform", Quantity::contraction},
                                    Named{"wire turned", Quantity::contraction}};

std::vector<Quantity> quantities_of(const gap::Remainder& remainder) {
    std::vector<Quantity> found;
    const auto add = [&](Quantity quantity) {
        if (std::ranges::find(found, quantity) == found.end()) found.push_back(quantity);
    };
    const bool is_micro = remainder.block.starts_with("micro");
    for (const std::string& name : remainder.depends_on) {
        for (const Named& named : quantity_words)
            if (name.find(named.word) != std::string::npos) add(named.quantity);
        if (name.starts_with("command")) add(is_micro ? Quantity::temperature : Quantity::macro_command);
    }
    if (!found.empty()) return found;
    if (is_micro) return {Quantity::temperature, Quantity::contraction};
    return {Quantity::velocity, Quantity::position};
}

struct Course {
    std::vector<float> values;
    double low, high;
};

Course course_of(const gap::Evidence& evidence, Quantity quantity) {
    const Rig& rig = evidence.rig();
    const gap::Course& course = evidence.course(0);
    switch (quantity) {
        case Quantity::velocity: {
            const double fastest_mm_per_s =
                rig.macro.velocity_gain_mm_per_s_per_V * rig.macro.command_limit_V;
            return {course.velocity_mm_per_s, -fastest_mm_per_s, fastest_mm_per_s};
        }
        case Quantity::position:
            return {course.position_mm, rig.macro.low_mm, rig.macro.high_mm};
        case Quantity::macro_command: {
            std::vector<float> volts;
            for (const StageRow& row : evidence.recordings().front().rows)
                volts.push_back(static_cast<float>(row.macro_command_V));
            return {std::move(volts), -rig.macro.command_limit_V, rig.macro.command_limit_V};
        }
        case Quantity::temperature: {
            if (!rig.micro) return {{}, 0.0, 1.0};
            const HeaterParameters& heater = rig.micro->heater;
            return {course.temperature_degC, heater.ambient_degC,
                    heater.ambient_degC + heater.gain_degC_per_V * (heater.limit_V - heater.onset_V)};
        }
        case Quantity::contraction:
            if (!rig.micro) return {{}, 0.0, 1.0};
            return {course.contraction_mm, rig.micro->low_mm, rig.micro->high_mm};
    }
    return {{}, 0.0, 1.0};
}

}  // namespace

std::optional<Unknown> unknown_of(const gap::Diagnosis& diagnosis) {
    constexpr double stated_floors = 1.25;
    if (!diagnosis.unexplained) return {};
    double floors = 0.0;
    for (const gap::SignalGap& signal : diagnosis.signals)
        floors = std::max(floors, signal.after / signal.floor);
    if (floors < stated_floors) return {};
    return Unknown{quantities_of(*diagnosis.unexplained), floors * floors - 1.0};
}

double information(const Unknown& unknown, const gap::Evidence& evidence) {
    double least = std::numeric_limits<double>::infinity();
    for (const Quantity quantity : unknown.depends_on) {
        const Course course = course_of(evidence, quantity);
        std::array<double, bins> time_s{};
        for (const float value : course.values) {
            const double share = (value - course.low) / (course.high - course.low);
            if (!std::isfinite(share)) continue;
            const auto bin = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * (bins - 1e-9));
            time_s[bin] += evidence.rig().tick_s;
        }
        double sum = 0.0;
        for (const double bin_s : time_s) sum += 0.5 * std::log1p(unknown.excess * bin_s);
        least = std::min(least, sum);
    }
    return least;
}

}  // namespace fidservo::design

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/matters.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/diagnose/words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::diagnose {
namespace {

struct Unit {
    std::string_view name;
    double in_own_unit;
};

/// The signal's own unit first.
std::vector<Unit> units_of(gap::Signal signal, const Rig& rig) {
    const double um_per_count = 1000.0 * rig.macro.encoder_resolution_mm;
    std::vector<Unit> units{{gap::unit_of(signal), 1.0}};
    switch (signal) {
        case gap::Signal::encoder:
            units.push_back({"um", 1.0 / um_per_count});
            units.push_back({"mm", 1000.0 / um_per_count});
            break;
        case gap::Signal::hall:
            if (rig.micro) units.push_back({"um", 1.0 / std::abs(hall_um_per_lsb(rig.micro->hall))});
            break;
        case gap::Signal::macro_command:
        case gap::Signal::micro_command:
            units.push_back({"mV", 1e-3});
            break;
        case gap::Signal::tag:
        case gap::Signal::image:
            break;
    }
    return units;
}

gap::Signal signal_of(const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    std::vector<std::string_view> known;
    for (std::size_t s = 0; s < gap::signal_count; ++s) {
        const auto signal = static_cast<gap::Signal>(s);
        if (gap::name_of(signal) == name) return signal;
        known.push_back(gap::name_of(signal));
    }
    throw InputError(
        fmt::format("--matters: {}: there is no such signal; there are {}", name, fmt::join(known, ", ")));
}

double in_own_unit(const std::string& argument, gap::Signal signal, const Rig& rig) {
    const std::vector<Unit> units = units_of(signal, rig);
    const auto fail = [&] {
        std::vector<std::string_view> names;
        names.reserve(units.size());
        for (const Unit& unit : units) names.push_back(unit.name);
        return InputError(
            fmt::format("--matters: {}: {}=VALUE, or VALUE with its unit behind it, above 0, is expected; "
                        "units: {}",
                        argument, gap::name_of(signal), fmt::join(names, ", ")));
    };
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) throw fail();
    double value = 0.0;
    const char* const end = argument.data() + argument.size();
    const auto [rest, error] = std::from_chars(argument.data() + equals + 1, end, value);
    if (error != std::errc() || !std::isfinite(value) || value <= 0.0) throw fail();
    const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
    if (unit.empty()) return value;
    const auto known = std::ranges::find(units, unit, &Unit::name);
    if (known == units.end()) throw fail();
    return value * known->in_own_unit;
}

}  // namespace

gap::SignalLimits what_matters(const std::vector<std::string>& arguments, const Rig& rig) {
    gap::SignalLimits limits{};
    for (const std::string& argument : arguments) {
        const gap::Signal signal = signal_of(argument);
        double& limit = limits[gap::index_of(signal)];
        if (limit != 0.0) throw InputError(fmt::format("--matters: {} is given twice", gap::name_of(signal)));
        limit = in_own_unit(argument, signal, rig);
    }
    return limits;
}

}  // namespace fidservo::diagnose

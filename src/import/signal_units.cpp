// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_error.h"
#include "src/identify/column_units.h"
#include "src/import/signal_times.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::imports {
namespace {

/// A unit's one name; what nobody knows, as it is written.
std::string canonical(const std::string& unit) {
    const Unit* known = find_unit(unit);
    return known == nullptr ? unit : std::string(known->name);
}

/// The unit that map and file together state; empty if neither does.
std::string agreed_unit(const LoggedSignal& signal, const Log& log, const std::string& asked,
                        const YamlValue& where) {
    if (!asked.empty() && !signal.unit.empty() && canonical(asked) != canonical(signal.unit))
        where.fail(fmt::format("{}: unit '{}', but {} states '{}'", signal.name, asked, log.file.string(),
                               signal.unit));
    return asked.empty() ? signal.unit : asked;
}

}  // namespace

std::vector<double> converted(const LoggedSignal& signal, const Log& log, const SignalChoice& choice,
                              std::string_view target_unit) {
    const YamlValue& where = *choice.where;
    const std::string unit = agreed_unit(signal, log, choice.unit, where);
    double scale = choice.factor;
    const Unit* target = find_unit(target_unit);
    if (target == nullptr) {
        if (!unit.empty() && unit != target_unit)
            where.fail(fmt::format("{}: unit '{}': must be {}", signal.name, unit,
                                   target_unit.empty() ? "none" : target_unit));
    } else if (const Unit* given = find_unit(unit); given != nullptr && given->quantity == target->quantity) {
        scale *= given->size / target->size;
    } else if (unit.empty() && target->quantity != "reading") {
        where.fail(fmt::format(
            "{0}: {1} states no unit; say it, as {0} [{2}]; allowed: {3}, or another one and factor",
            signal.name, log.file.string(), target->name, fmt::join(units_of(target->quantity), ", ")));
    } else if (!unit.empty() && !choice.has_factor) {
        where.fail(fmt::format("{}: unit '{}': allowed: {}, or another one and factor, the {} in one {}",
                               signal.name, unit, fmt::join(units_of(target->quantity), ", "), target->name,
                               unit));
    }
    std::vector<double> values = signal.values;
    if (scale != 1.0 || choice.offset != 0.0)
        for (double& value : values) value = scale * value + choice.offset;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (std::isinf(values[k]))
            throw InputError(
                fmt::format("{}: {}: value {} is infinite", log.file.string(), signal.name, k + 1));
    return values;
}

std::vector<TimeNs> times_of(const LoggedSignal& signal, const Log& log, const std::string& asked_unit,
                             const YamlValue& where) {
    const std::string stated = agreed_unit(signal, log, asked_unit, where);
    const Unit* unit = find_unit(stated);
    if (unit == nullptr || unit->quantity != "time")
        where.fail(fmt::format("{}: {}; allowed: {}, as {} [s]", signal.name,
                               stated.empty() ? fmt::format("{} states no unit of time", log.file.string())
                                              : fmt::format("unit '{}' is none of time", stated),
                               fmt::join(units_of("time"), ", "), signal.name));
    const auto fail = [&](std::size_t k) {
        throw InputError(fmt::format("{}: {}: value {}: {} {} is no time within 4e18 ns of 0",
                                     log.file.string(), signal.name, k + 1, signal.values[k], unit->name));
    };
    constexpr double most_ns = 4e18;  // an offset as large still fits
    const double size_ns = std::round(unit->size * 1e9);
    std::vector<TimeNs> times(signal.values.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
        const double value_ns = signal.values[k] * size_ns;
        if (!(std::abs(value_ns) < most_ns)) fail(k);
        times[k] = signal.whole.empty() ? static_cast<TimeNs>(std::llround(value_ns))
                                        : signal.whole[k] * static_cast<TimeNs>(size_ns);
    }
    return times;
}

}  // namespace fidservo::imports

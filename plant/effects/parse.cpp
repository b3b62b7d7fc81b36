// SPDX-License-Identifier: GPL-3.0-or-later
// "NAME:PARAMETER=VALUE,..." as the option --effect takes it.
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

namespace fidservo::plant {

namespace {

/// @param where  what the user wrote, and where
[[noreturn]] void fail(std::string_view where, const std::string& message) {
    throw InputError(std::string(where) + ": " + message);
}

std::string range_of(const EffectParameter& parameter) {
    std::ostringstream range;
    range << parameter.low << " .. " << parameter.high;
    if (!parameter.unit.empty()) range << ' ' << parameter.unit;
    if (parameter.vanishing != parameter.typical) range << " (" << parameter.vanishing << ": no effect)";
    return range.str();
}

std::string known_effects(std::span<const Effect* const> others) {
    std::string names;
    for (const auto& known : {others, effect_catalogue()})
        for (const Effect* effect : known) names += (names.empty() ? "" : ", ") + std::string(effect->name);
    return names;
}

std::string known_parameters(const Effect& effect) {
    std::string names;
    for (const EffectParameter& parameter : effect.parameters)
        names += (names.empty() ? "" : ", ") + std::string(parameter.name) + " = " + range_of(parameter);
    return names;
}

/// Cuts off what stands before the separator, which goes too. Without separator all of it.
std::string_view take_until(std::string_view& rest, char separator) {
    const std::size_t at = rest.find(separator);
    const std::string_view taken = rest.substr(0, at);
    rest = at == std::string_view::npos ? std::string_view{} : rest.substr(at + 1);
    return taken;
}

std::size_t index_of(const Effect& effect, std::string_view name, std::string_view where) {
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        if (effect.parameters[k].name == name) return k;
    fail(where, "\"" + std::string(name) + "\" is no parameter of " + std::string(effect.name) +
                    "; allowed: " + known_parameters(effect));
}

double value_of(const EffectParameter& parameter, std::string_view digits, std::string_view where) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
        fail(where, std::string(parameter.name) + ": \"" + std::string(digits) +
                        "\" is not a number; allowed: " + range_of(parameter));
    if (value < parameter.low || value > parameter.high)
        fail(where, std::string(parameter.name) + ": " + std::string(digits) +
                        " is out of bounds; allowed: " + range_of(parameter));
    return value;
}

EffectSetting parse(std::string_view text, std::string_view where, std::span<const Effect* const> others) {
    std::string_view rest = text;
    const bool has_parameters = text.find(':') != std::string_view::npos;
    const Effect* effect = find_effect(take_until(rest, ':'), others);
    if (effect == nullptr) fail(where, "no such effect; known: " + known_effects(others));

    EffectSetting setting = typical_setting(*effect);
    if (!has_parameters) return setting;
    if (rest.empty() || rest.back() == ',')
        fail(where, "PARAMETER=VALUE is missing; allowed: " + known_parameters(*effect));

    std::vector<bool> given(effect->parameters.size(), false);
    while (!rest.empty()) {
        std::string_view digits = take_until(rest, ',');
        if (digits.find('=') == std::string_view::npos)
            fail(where, "\"" + std::string(digits) +
                            "\" is not PARAMETER=VALUE; allowed: " + known_parameters(*effect));
        const std::size_t k = index_of(*effect, take_until(digits, '='), where);
        if (given[k]) fail(where, std::string(effect->parameters[k].name) + " is given twice");
        given[k] = true;
        setting.values[k] = value_of(effect->parameters[k], digits, where);
    }
    if (effect->formula == nullptr) return setting;
    try {
        demand_extents(*effect->formula, setting.values);
    } catch (const InputError& error) {
        fail(where, error.what());
    }
    return setting;
}

}  // namespace

EffectSetting parse_effect(std::string_view text, std::span<const Effect* const> others) {
    return parse(text, "--effect: " + std::string(text), others);
}

EffectSetting setting_of(const StatedEffect& stated) {
    std::string text = stated.name;
    for (const StatedEffect::Parameter& parameter : stated.parameters) {
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), parameter.value).ptr;
        text += (text.size() == stated.name.size() ? ':' : ',') + parameter.name + '=';
        text.append(digits.data(), end);
    }
    if (!stated.formula) return parse(text, text, {});
    const Effect* const own = &effect_of(*stated.formula);
    return parse(text, text, {&own, 1});
}

}  // namespace fidservo::plant

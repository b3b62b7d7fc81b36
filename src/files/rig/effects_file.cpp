// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/effects_file.h"

#include "core/input_error.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_code.h"
#include "plant/formulas/formula_effect.h"
#include "src/files/text/yaml_reader.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {

namespace {

using Kind = FormulaEffect::Memory::Kind;

constexpr std::string_view effects_format = "fidservo-effects/1";

std::string text_if_given(const YamlValue& map, const char* key) {
    const auto value = map.find(key);
    return value ? value->text() : std::string();
}

FormulaEffect::Parameter read_parameter(const YamlValue& map, const std::string& name) {
    FormulaEffect::Parameter parameter;
    parameter.name = name;
    parameter.unit = text_if_given(map, "unit");
    const std::vector<double> bounds = map.at("bounds").numbers(2);
    parameter.low = bounds[0];
    parameter.high = bounds[1];
    if (const auto role = map.find("role")) {
        (void)role->one_of({"size", "shape", "optional"});
        parameter.role = role->text();
    }
    parameter.typical = map.at("typical").number();
    const auto vanishing = map.find("vanishing");
    parameter.vanishing = vanishing                   ? vanishing->number()
                          : parameter.role == "shape" ? parameter.typical
                                                      : 0.0;
    if (const auto starts = map.find("starts"))
        for (const YamlValue& start : starts->items())
            parameter.starts.push_back(start.number({parameter.low, parameter.high}));
    parameter.text = text_if_given(map, "text");
    return parameter;
}

/// Quantities of one kind that remember: a map of names to what they follow.
void read_memories(const YamlValue& map, Kind kind, const char* extent_key,
                   std::vector<FormulaEffect::Memory>& found) {
    for (const std::string& name : map.keys()) {
        const YamlValue value = map.at(name);
        FormulaEffect::Memory memory{.name = name, .kind = kind, .of = {}, .by = {}};
        if (extent_key == nullptr) {
            memory.of = value.text();
        } else {
            value.allow_only({"of", extent_key});
            memory.of = value.at("of").text();
            memory.by = value.at(extent_key).text();
        }
        found.push_back(std::move(memory));
    }
}

/// @param values  of the parameters that state one; nullptr: none may
FormulaEffect read_formula(const YamlValue& map, std::vector<StatedEffect::Parameter>* values) {
    map.allow_only(
        {"name", "block", "acts_on", "formula", "parameters", "state", "play", "delay", "text", "source"});
    FormulaEffect effect;
    effect.name = map.at("name").text();
    effect.block = map.at("block").text();
    effect.acts_on = map.at("acts_on").text();
    effect.formula = map.at("formula").text();
    const YamlValue parameters = map.at("parameters");
    for (const std::string& name : parameters.keys()) {
        const YamlValue parameter = parameters.at(name);
        if (values != nullptr)
            parameter.allow_only(
                {"unit", "bounds", "vanishing", "typical", "role", "starts", "text", "value"});
        else
            parameter.allow_only({"unit", "bounds", "vanishing", "typical", "role", "starts", "text"});
        effect.parameters.push_back(read_parameter(parameter, name));
        if (const auto value = parameter.find("value"))
            values->push_back(
                {name, value->number({effect.parameters.back().low, effect.parameters.back().high})});
    }
    if (const auto state = map.find("state")) read_memories(*state, Kind::state, nullptr, effect.memories);
    if (const auto play = map.find("play")) read_memories(*play, Kind::play, "width", effect.memories);
    if (const auto delay = map.find("delay")) read_memories(*delay, Kind::delay, "by", effect.memories);
    effect.text = text_if_given(map, "text");
    effect.source = text_if_given(map, "source");
    return effect;
}

/// Fails at the key that is wrong: "NAME: KEY: what" of plant::effect_of(), KEY perhaps
/// "parameters.drag.high".
[[noreturn]] void fail_at_key(const YamlValue& map, const std::string& name, std::string_view message) {
    const std::string_view rest = message.substr(std::min(message.size(), name.size() + 2));
    const std::size_t colon = rest.find(": ");
    YamlValue place = map;
    for (std::string_view key = rest.substr(0, colon); !key.empty() && place.is_map();) {
        const std::size_t dot = key.find('.');
        const auto next = place.find(key.substr(0, dot));
        if (!next) break;
        place = *next;
        key = dot == std::string_view::npos ? std::string_view{} : key.substr(dot + 1);
    }
    place.fail(colon == std::string_view::npos ? rest : rest.substr(colon + 2));
}

const plant::Effect& effect_at(const YamlValue& map, const FormulaEffect& formula) {
    try {
        return plant::effect_of(formula);
    } catch (const InputError& error) {
        fail_at_key(map, formula.name, error.what());
    }
}

std::string exact_digits(double value) {
    return fmt::format("{}", value);
}

}  // namespace

std::vector<const plant::Effect*> load_effects_file(const std::filesystem::path& file) {
    return read_effects_file(YamlValue::load(file));
}

std::vector<const plant::Effect*> read_effects_file(const YamlValue& root) {
    root.allow_only({"format", "effects"});
    (void)root.at("format").one_of({effects_format});
    std::vector<const plant::Effect*> effects;
    for (const YamlValue& item : root.at("effects").items()) {
        const plant::Effect& effect = effect_at(item, read_formula(item, nullptr));
        if (std::ranges::count(effects, effect.name, [](const plant::Effect* other) { return other->name; }) >
            0)
            item.at("name").fail("is the name of two effects; allowed: a name of its own");
        effects.push_back(&effect);
    }
    if (effects.empty()) root.at("effects").fail("has none; allowed: one effect or more");
    return effects;
}

void fail_at_formula(const YamlValue& map, const plant::FormulaFault& fault) {
    fail_at_key(map, fault.effect(), fault.what());
}

void fail_at_formula(const std::filesystem::path& file, const plant::FormulaFault& fault) {
    const YamlValue root = YamlValue::load(file);
    for (const YamlValue& item : root.at("effects").items())
        if (item.at("name").text() == fault.effect()) fail_at_formula(item, fault);
    throw plant::FormulaFault(fault);
}

void demand_effects(const char* option, const std::vector<std::string>& names,
                    std::span<const plant::Effect* const> formulas) {
    for (const std::string& name : names)
        if (plant::find_effect(name, formulas) == nullptr)
            throw InputError(fmt::format(
                "{}: {}: there is no such effect; fidservo simulate --help lists them", option, name));
}

StatedEffect read_stated_formula(const YamlValue& map) {
    StatedEffect stated;
    stated.formula = read_formula(map, &stated.parameters);
    stated.name = stated.formula->name;
    (void)effect_at(map, *stated.formula);
    return stated;
}

std::string stated_formula_yaml(const StatedEffect& effect) {
    const FormulaEffect& formula = *effect.formula;
    YAML::Emitter out;
    const auto add = [&](const char* key, const std::string& value) {
        if (!value.empty()) out << YAML::Key << key << YAML::Value << value;
    };
    out << YAML::BeginMap;
    add("name", formula.name);
    add("block", formula.block);
    add("acts_on", formula.acts_on);
    add("formula", formula.formula);
    out << YAML::Key << "parameters" << YAML::Value << YAML::BeginMap;
    for (const FormulaEffect::Parameter& parameter : formula.parameters) {
        out << YAML::Key << parameter.name << YAML::Value << YAML::Flow << YAML::BeginMap;
        const auto stated =
            std::ranges::find(effect.parameters, parameter.name, &StatedEffect::Parameter::name);
        if (stated != effect.parameters.end()) add("value", exact_digits(stated->value));
        add("unit", parameter.unit);
        out << YAML::Key << "bounds" << YAML::Value << YAML::Flow << YAML::BeginSeq
            << exact_digits(parameter.low) << exact_digits(parameter.high) << YAML::EndSeq;
        add("vanishing", exact_digits(parameter.vanishing));
        add("typical", exact_digits(parameter.typical));
        add("role", parameter.role);
        if (!parameter.starts.empty()) {
            out << YAML::Key << "starts" << YAML::Value << YAML::Flow << YAML::BeginSeq;
            for (const double start : parameter.starts) out << exact_digits(start);
            out << YAML::EndSeq;
        }
        add("text", parameter.text);
        out << YAML::EndMap;
    }
    out << YAML::EndMap;
    const auto add_memories = [&](const char* key, Kind kind, const char* extent_key) {
        if (std::ranges::none_of(formula.memories, [&](const auto& memory) { return memory.kind == kind; }))
            return;
        out << YAML::Key << key << YAML::Value << YAML::BeginMap;
        for (const FormulaEffect::Memory& memory : formula.memories) {
            if (memory.kind != kind) continue;
            out << YAML::Key << memory.name << YAML::Value;
            if (extent_key == nullptr) {
                out << memory.of;
                continue;
            }
            out << YAML::Flow << YAML::BeginMap;
            add("of", memory.of);
            add(extent_key, memory.by);
            out << YAML::EndMap;
        }
        out << YAML::EndMap;
    };
    add_memories("state", Kind::state, nullptr);
    add_memories("play", Kind::play, "width");
    add_memories("delay", Kind::delay, "by");
    add("text", formula.text);
    add("source", formula.source);
    out << YAML::EndMap;
    return out.c_str();
}

}  // namespace fidservo

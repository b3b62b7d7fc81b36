// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/sketch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {

namespace {

std::string coefficient_unit(std::string_view of_port, const std::string& of_term) {
    const std::string unit = of_port.empty() ? "1" : std::string(of_port);
    if (of_term.empty()) return of_port.empty() ? "" : unit;
    return of_term.find_first_of(" /") == std::string::npos ? fmt::format("{}/{}", unit, of_term)
                                                            : fmt::format("{}/({})", unit, of_term);
}

std::string replaced(std::string text, std::string_view from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

std::string described(const FormulaEffect::Memory& memory) {
    switch (memory.kind) {
        case FormulaEffect::Memory::Kind::state:
            return fmt::format(" d{}/dt = {}.", memory.name, memory.of);
        case FormulaEffect::Memory::Kind::delay:
            return fmt::format(" {} is what {} was {} seconds ago.", memory.name, memory.of, memory.by);
        case FormulaEffect::Memory::Kind::play:
            return fmt::format(" {} follows {} with a play of {}.", memory.name, memory.of, memory.by);
    }
    return {};
}

}  // namespace

std::size_t Sketch::shapes() const {
    std::size_t count = 0;
    for (const Term& term : terms) count += term.shapes.size();
    return count;
}

FormulaEffect formula_of(const Sketch& sketch, std::string_view block, const std::string& name) {
    const plant::PortDescription& port = plant::describe(sketch.port);
    FormulaEffect effect;
    effect.name = name;
    effect.acts_on = port.name;
    const bool may_be = std::ranges::find(port.blocks, block) != port.blocks.end();
    effect.block = may_be ? std::string(block) : std::string(port.blocks.front());
    std::vector<std::string> words;
    char coefficient = 'a', shape = 'p', memory = 'm';
    std::size_t at = 0;
    for (const Term& term : sketch.terms) {
        std::vector<std::string> letters;
        for (std::size_t k = 0; k < term.shapes.size(); ++k) letters.emplace_back(1, shape++);
        const std::string kept(1, memory);
        const auto named = [&](std::string text) {
            for (std::size_t k = 0; k < letters.size(); ++k)
                text = replaced(std::move(text), shape_names[k], letters[k]);
            return replaced(std::move(text), memory_name, kept);
        };
        for (const std::string& text : term.texts) {
            constexpr double reach = 30.0, least_size = 1e-12;
            const std::string letter(1, coefficient++);
            const double value = sketch.coefficients[at++];
            const double most = reach * std::max(std::abs(value), least_size);
            effect.formula +=
                fmt::format("{}{} * {}", effect.formula.empty() ? "" : " + ", letter, named(text));
            effect.parameters.push_back({.name = letter,
                                         .unit = coefficient_unit(port.unit, term.unit),
                                         .low = -most,
                                         .high = most,
                                         .typical = value != 0.0 ? value : least_size,
                                         .text = term.words});
        }
        for (std::size_t k = 0; k < term.shapes.size(); ++k)
            effect.parameters.push_back({.name = letters[k],
                                         .unit = term.shapes[k].unit,
                                         .low = term.shapes[k].low,
                                         .high = term.shapes[k].high,
                                         .vanishing = term.shapes[k].value,
                                         .typical = term.shapes[k].value,
                                         .role = "shape",
                                         .starts = {term.shapes[k].value},
                                         .text = "of what is " + term.words});
        if (term.memory) {
            effect.memories.push_back(
                {kept, term.memory->kind, named(term.memory->of), named(term.memory->by)});
            ++memory;
        }
        words.push_back(term.words);
    }
    effect.text = fmt::format(
        "Proposed by a diagnosis for what no listed effect explains, at {}: {}. Beyond what the recordings "
        "have covered, powers are continued by their end values.",
        port.name, fmt::join(words, "; and "));
    for (const FormulaEffect::Memory& kept : effect.memories) effect.text += described(kept);
    effect.source = "the recordings of this rig";
    return effect;
}

Sketch one_text_of(plant::Port port, const Term& term, std::size_t text, double coefficient) {
    Term one = term;
    one.texts = {term.texts[text]};
    return {port, {std::move(one)}, {coefficient}};
}

Sketch with_values(Sketch sketch, std::span<const double> values) {
    std::size_t coefficient = 0, value = 0;
    for (Term& term : sketch.terms) {
        for (std::size_t k = 0; k < term.texts.size(); ++k)
            sketch.coefficients[coefficient++] = values[value++];
        for (TermShape& shape : term.shapes) shape.value = values[value++];
    }
    return sketch;
}

Sketch first_of(const Sketch& sketch) {
    const auto count = static_cast<std::ptrdiff_t>(sketch.terms.front().texts.size());
    return {sketch.port,
            {sketch.terms.front()},
            {sketch.coefficients.begin(), sketch.coefficients.begin() + count}};
}

Sketch without(const Sketch& sketch, std::size_t term) {
    Sketch rest{sketch.port, {}, {}};
    std::size_t at = 0;
    for (std::size_t t = 0; t < sketch.terms.size(); ++t)
        for (std::size_t k = 0; k < sketch.terms[t].texts.size(); ++k, ++at) {
            if (t == term) continue;
            if (k == 0) rest.terms.push_back(sketch.terms[t]);
            rest.coefficients.push_back(sketch.coefficients[at]);
        }
    return rest;
}

std::optional<Sketch> joined(Sketch sketch, const Sketch& more) {
    for (const Term& term : more.terms)
        for (const Term& known : sketch.terms)
            if (term.family == known.family) return {};
    sketch.terms.insert(sketch.terms.end(), more.terms.begin(), more.terms.end());
    sketch.coefficients.insert(sketch.coefficients.end(), more.coefficients.begin(), more.coefficients.end());
    if (sketch.coefficients.size() > most_coefficients || sketch.shapes() > most_equation_shapes) return {};
    return sketch;
}

}  // namespace fidservo::gap

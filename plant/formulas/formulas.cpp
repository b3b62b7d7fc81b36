// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/formulas/formulas.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>

namespace fidservo::plant {

namespace {

using Kind = FormulaEffect::Memory::Kind;

std::span<const double> memories_of(const FormulaTerm& term, const FormulaMemory& memory) {
    return std::span(memory.values).subspan(term.first_memory, term.code->effect().memories.size());
}

/// @param what  "KEY: what; allowed"
[[noreturn]] void refuse(const FormulaCode& code, const std::string& stated_at, const std::string& what) {
    if (stated_at.empty()) throw FormulaFault(code.effect().name, what);
    throw InputError(stated_at + "." + what);
}

/// @param state  of which it is the value; nullptr: of the formula
[[noreturn]] void refuse_value(const FormulaTerm& term, double value, std::span<const double> variables,
                               const FormulaEffect::Memory* state = nullptr) {
    const PortDescription& port = term.code->port();
    const std::string_view unit = state != nullptr ? std::string_view{} : port.unit;
    std::ostringstream text;
    if (state != nullptr)
        text << "state." << state->name << ": comes to ";
    else
        text << "formula: gives ";
    if (std::isnan(value))
        text << "no number";
    else
        text << value << (unit.empty() ? "" : " ") << unit;
    const auto known = variables_of(port.site);
    const char* separator = " at ";
    for (const std::size_t k : port.variables) {
        if (!term.code->uses(k)) continue;
        text << separator << known[k].name << " = " << variables[k];
        separator = ", ";
    }
    text << term.code->at_values(term.parameters);
    if (state != nullptr)
        text << "; allowed: any finite number";
    else
        text << "; allowed: numbers up to " << port.limit << (unit.empty() ? "" : " ") << unit;
    refuse(*term.code, term.stated_at, text.str());
}

/// Rate of a state and how it changes with the state.
struct Rate {
    double rate, slope;
};

Rate rate_of(const FormulaTerm& term, std::size_t k, FormulaMemory& memory,
             std::span<const double> variables) {
    double& value = memory.values[term.first_memory + k];
    const double here = value, step = 1e-6 * (1.0 + std::abs(here));
    const auto rate_at = [&](double there) {
        value = there;
        return term.code->followed(k, variables, memories_of(term, memory), term.parameters);
    };
    const double rate = rate_at(here), slope = (rate_at(here + step) - rate_at(here - step)) / (2.0 * step);
    value = here;
    return {rate, slope};
}

double settled(const FormulaTerm& term, std::size_t k, FormulaMemory& memory,
               std::span<const double> variables) {
    constexpr int most_rounds = 50;
    constexpr double level = 1e-12;
    double& value = memory.values[term.first_memory + k];
    for (int round = 0; round < most_rounds; ++round) {
        const auto [rate, slope] = rate_of(term, k, memory, variables);
        if (!std::isfinite(rate) || !std::isfinite(slope) || std::abs(slope) < level) return 0.0;
        const double change = rate / slope;
        value -= change;
        if (std::abs(change) <= level * (1.0 + std::abs(value))) return value;
    }
    return 0.0;
}

std::size_t ring_size(double delay_s, double tick_s) {
    return static_cast<std::size_t>(std::ceil(delay_s / tick_s)) + 2;
}

bool vanishes(const FormulaTerm& term) {
    const std::vector<FormulaEffect::Parameter>& known = term.code->effect().parameters;
    for (std::size_t k = 0; k < term.parameters.size(); ++k)
        if (known[k].role == "size" && term.parameters[k] != known[k].vanishing) return false;
    return true;
}

}  // namespace

void Formulas::add(const FormulaCode& code, std::span<const double> parameters,
                   const std::string& stated_at) {
    FormulaTerm own{&code, {parameters.begin(), parameters.end()}, 0, stated_at};
    try {
        if (!vanishes(own)) code.demand_extents(parameters);
    } catch (const FormulaFault& fault) {
        refuse(code, stated_at, fault.rest());
    }
    std::vector<FormulaTerm> terms = std::move(terms_);
    const auto before = std::ranges::find(terms, &code, &FormulaTerm::code);
    if (before != terms.end())
        *before = std::move(own);
    else
        terms.push_back(std::move(own));
    *this = Formulas();
    for (FormulaTerm& term : terms)
        if (!vanishes(term)) take_in(std::move(term));
}

void Formulas::take_in(FormulaTerm term) {
    const FormulaCode& code = *term.code;
    const FormulaEffect& effect = code.effect();
    if (memories_ + effect.memories.size() > most_memories)
        refuse(code, term.stated_at,
               "state: with those of the other effects there are more than " + std::to_string(most_memories) +
                   " quantities that remember; allowed: no more");
    term.first_memory = memories_;
    terms_.push_back(std::move(term));
    memories_ += effect.memories.size();
    acting_.set(static_cast<std::size_t>(code.port().port));
    for (std::size_t k = 0; k < most_variables; ++k)
        if (code.uses(k)) used_.set(k);
}

double Formulas::value(Port port, std::span<const double> variables, const FormulaMemory& memory) const {
    double sum = 0.0;
    for (const FormulaTerm& term : terms_) {
        if (term.code->port().port != port) continue;
        const double value = term.code->value(variables, memories_of(term, memory), term.parameters);
        if (!(std::abs(value) <= term.code->port().limit)) refuse_value(term, value, variables);
        sum += value;
    }
    return sum;
}

double Formulas::any_value(Port port, std::span<const double> variables, const FormulaMemory& memory) const {
    double sum = 0.0;
    for (const FormulaTerm& term : terms_)
        if (term.code->port().port == port)
            sum += term.code->value(variables, memories_of(term, memory), term.parameters);
    return sum;
}

FormulaMemory Formulas::start(std::span<const double> variables, double tick_s) const {
    FormulaMemory memory;
    memory.tick_s = tick_s;
    for (const FormulaTerm& term : terms_) {
        const FormulaEffect& effect = term.code->effect();
        for (std::size_t k = 0; k < effect.memories.size(); ++k) {
            double& value = memory.values[term.first_memory + k];
            if (effect.memories[k].kind == Kind::state) {
                value = settled(term, k, memory, variables);
                continue;
            }
            value = term.code->followed(k, variables, memories_of(term, memory), term.parameters);
            if (effect.memories[k].kind == Kind::delay)
                memory.past.insert(memory.past.end(),
                                   ring_size(term.code->extent(k, term.parameters), tick_s), value);
        }
    }
    memory.next = memory.values;
    return memory;
}

void Formulas::begin_tick(const FormulaTerm& term, FormulaMemory& memory, std::span<const double> variables,
                          double tick_s, std::size_t& ring) {
    const std::vector<FormulaEffect::Memory>& kept = term.code->effect().memories;
    const auto followed = [&](std::size_t k) {
        return term.code->followed(k, variables, memories_of(term, memory), term.parameters);
    };
    for (std::size_t k = 0; k < kept.size(); ++k)
        if (kept[k].kind == Kind::state)
            memory.values[term.first_memory + k] = memory.next[term.first_memory + k];
    for (std::size_t k = 0; k < kept.size(); ++k) {
        if (kept[k].kind == Kind::state) continue;
        double& value = memory.values[term.first_memory + k];
        const double extent = term.code->extent(k, term.parameters);
        if (kept[k].kind == Kind::play) {
            const double ahead = followed(k);
            value = std::clamp(value, ahead - 0.5 * extent, ahead + 0.5 * extent);
            continue;
        }
        if (tick_s != memory.tick_s) continue;
        const std::size_t size = ring_size(extent, tick_s);
        const auto at = [&](std::size_t ticks_ago) -> double& {
            return memory.past[ring + (memory.ticks + size - ticks_ago) % size];
        };
        at(0) = followed(k);
        const double ticks = extent / tick_s, whole = std::floor(ticks);
        const auto n = static_cast<std::size_t>(whole);
        value = at(n) + (ticks - whole) * (at(n + 1) - at(n));
        ring += size;
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
        if (kept[k].kind != Kind::state) continue;
        const auto [rate, slope] = rate_of(term, k, memory, variables);
        constexpr double straight = 1e-9;
        const double way = tick_s * slope;
        double& next = memory.next[term.first_memory + k];
        next = memory.values[term.first_memory + k] +
               tick_s * rate * (std::abs(way) < straight ? 1.0 : std::expm1(way) / way);
        if (!std::isfinite(next)) refuse_value(term, next, variables, &kept[k]);
    }
}

void Formulas::begin_tick(FormulaMemory& memory, std::span<const double> variables, double tick_s) const {
    std::size_t ring = 0;
    for (const FormulaTerm& term : terms_) begin_tick(term, memory, variables, tick_s, ring);
    ++memory.ticks;
}

}  // namespace fidservo::plant

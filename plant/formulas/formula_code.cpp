// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/formulas/formula_code.h"

#include "core/input_error.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <muParser.h>

namespace fidservo::plant {

namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw InputError(what);
}

constexpr const char* functions =
    "abs, sign, sqrt, exp, log, sin, cos, tan, tanh, atan2, min, max, clip, if; pi";
constexpr std::array reserved{"abs", "sign", "sqrt",  "exp", "log", "sin", "cos", "clip",
                              "tan", "tanh", "atan2", "min", "max", "if",  "pi"};

double if_of(double condition, double then, double otherwise) {
    return condition != 0.0 ? then : otherwise;
}
double sign_of(double value) {
    return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}
double least_of(double left, double right) {
    return std::isnan(left) || std::isnan(right) ? left + right : std::min(left, right);
}
double clip_of(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}
double most_of(double left, double right) {
    return std::isnan(left) || std::isnan(right) ? left + right : std::max(left, right);
}

/// A parser that knows the functions and nothing else.
mu::Parser bare_parser() {
    mu::Parser parser;
    parser.ClearFun();
    parser.ClearConst();
    parser.ClearInfixOprt();
    parser.DefineInfixOprt("-", [](double value) { return -value; });
    parser.DefineInfixOprt("+", [](double value) { return value; });
    parser.DefineFun("abs", [](double value) { return std::abs(value); });
    parser.DefineFun("sign", sign_of);
    parser.DefineFun("sqrt", [](double value) { return std::sqrt(value); });
    parser.DefineFun("exp", [](double value) { return std::exp(value); });
    parser.DefineFun("log", [](double value) { return std::log(value); });
    parser.DefineFun("sin", [](double value) { return std::sin(value); });
    parser.DefineFun("cos", [](double value) { return std::cos(value); });
    parser.DefineFun("tan", [](double value) { return std::tan(value); });
    parser.DefineFun("tanh", [](double value) { return std::tanh(value); });
    parser.DefineFun("atan2", [](double y, double x) { return std::atan2(y, x); });
    parser.DefineFun("min", least_of);
    parser.DefineFun("max", most_of);
    parser.DefineFun("clip", clip_of);
    parser.DefineFun("if", if_of);
    parser.DefineConst("pi", std::numbers::pi);
    return parser;
}

bool is_of_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_name(const std::string& name) {
    return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
           std::ranges::all_of(name, is_of_name);
}

/// Where an assignment or a string begins; npos: nowhere.
std::size_t forbidden_at(const std::string& text) {
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '"') return k;
        if (text[k] != '=') continue;
        const bool compares = (k > 0 && (text[k - 1] == '<' || text[k - 1] == '>' || text[k - 1] == '!')) ||
                              (k + 1 < text.size() && text[k + 1] == '=');
        if (!compares) return k;
        if (k + 1 < text.size() && text[k + 1] == '=') ++k;
    }
    return std::string::npos;
}

/// Where a character begins that no formula has, a control character or one beyond ASCII, and its bytes;
/// npos: nowhere.
std::pair<std::size_t, std::string> foreign_at(const std::string& text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    constexpr std::string_view blanks = "\t\n\r";
    constexpr unsigned char beyond_ascii = 0x80, goes_on = 0x40;
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (byte(k) < ' ' && blanks.find(text[k]) == std::string_view::npos) return {k, {}};
        if (byte(k) < beyond_ascii) continue;
        std::size_t end = k + 1;
        while (end < text.size() && byte(end) >= beyond_ascii && (byte(end) & goes_on) == 0) ++end;
        return {k, text.substr(k, end - k)};
    }
    return {std::string::npos, {}};
}

std::string listed(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

std::vector<std::string> parameter_names(const FormulaEffect& effect) {
    std::vector<std::string> names;
    for (const FormulaEffect::Parameter& parameter : effect.parameters) names.push_back(parameter.name);
    return names;
}

std::string key_of(const FormulaEffect::Memory& memory) {
    switch (memory.kind) {
        case FormulaEffect::Memory::Kind::state:
            return "state." + memory.name;
        case FormulaEffect::Memory::Kind::play:
            return "play." + memory.name;
        case FormulaEffect::Memory::Kind::delay:
            return "delay." + memory.name;
    }
    return memory.name;
}

std::string extent_key(const FormulaEffect::Memory& memory) {
    return key_of(memory) + (memory.kind == FormulaEffect::Memory::Kind::play ? ".width" : ".by");
}

/// muParser's message without its stop and without the place, which it counts from 0.
std::string bare(std::string message) {
    static const std::regex place(R"(( found)? at (expression )?position \d+)");
    message = std::regex_replace(message, place, "");
    while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
    return message;
}

/// Where a whole name stands in an expression, counted from 1.
std::size_t character_of(const std::string& text, const std::string& name) {
    const auto is_part = [&](std::size_t at) { return at < text.size() && is_of_name(text[at]); };
    std::size_t at = text.find(name);
    while (at != std::string::npos && ((at > 0 && is_part(at - 1)) || is_part(at + name.size())))
        at = text.find(name, at + 1);
    return at == std::string::npos ? 1 : at + 1;
}

/// The names that an expression has. Throws InputError where it is none, or has a name that is not allowed.
std::set<std::string> names_in(const std::string& where, const std::string& text,
                               const std::vector<std::string>& allowed) {
    const auto refuse_at = [&](std::size_t character, const std::string& what) {
        refuse(where + ": character " + std::to_string(character) + ": " + what);
    };
    if (text.empty()) refuse(where + ": is empty; allowed: an expression, e.g. 0.1 * speed");
    constexpr std::size_t longest = 2000;
    if (text.size() > longest)
        refuse(where + ": has " + std::to_string(text.size()) +
               " characters; allowed: " + std::to_string(longest) + " at most");
    if (const auto [at, bytes] = foreign_at(text); at != std::string::npos)
        refuse_at(at + 1, (bytes.empty() ? "a control character" : '"' + bytes + '"') +
                              " has no meaning here; allowed: numbers, " + listed(allowed) +
                              ", + - * / ^, comparisons, c ? a : b, " + functions);
    if (const std::size_t at = forbidden_at(text); at != std::string::npos)
        refuse_at(at + 1,
                  "neither assignments nor strings; allowed: a value, e.g. 0.1 * speed, with == to compare");
    try {
        mu::Parser parser = bare_parser();
        parser.SetExpr(text);
        std::set<std::string> names;
        for (const auto& [name, unused] : parser.GetUsedVar()) {
            if (std::ranges::find(allowed, name) == allowed.end())
                refuse_at(character_of(text, name), "\"" + name + "\" is not known here; allowed: " +
                                                        listed(allowed) + "; " + functions);
            names.insert(name);
        }
        double none = 0.0;
        for (const std::string& name : names) parser.DefineVar(name, &none);
        (void)parser.Eval();
        if (parser.GetNumResults() != 1)
            refuse(where + ": is more than one value; allowed: one, with . in numbers");
        return names;
    } catch (const mu::Parser::exception_type& error) {
        refuse_at(static_cast<std::size_t>(std::max(0, error.GetPos())) + 1,
                  bare(error.GetMsg()) + "; allowed: numbers, " + listed(allowed) +
                      ", + - * / ^, comparisons, c ? a : b, " + functions);
    }
    return {};
}

}  // namespace

/// A thread's parsers of one effect, and the values that they read.
class FormulaCode::Machine {
  public:
    explicit Machine(const FormulaCode& code) {
        const FormulaEffect& effect = code.effect_;
        const auto known = variables_of(code.port_->site);
        first_memory_ = known.size();
        first_parameter_ = first_memory_ + effect.memories.size();
        values_.resize(first_parameter_ + effect.parameters.size());
        const auto compiled = [&](const std::string& text) {
            mu::Parser parser = bare_parser();
            for (std::size_t k = 0; k < known.size(); ++k)
                parser.DefineVar(std::string(known[k].name), &values_[k]);
            for (std::size_t k = 0; k < effect.memories.size(); ++k)
                parser.DefineVar(effect.memories[k].name, &values_[first_memory_ + k]);
            for (std::size_t k = 0; k < effect.parameters.size(); ++k)
                parser.DefineVar(effect.parameters[k].name, &values_[first_parameter_ + k]);
            parser.SetExpr(text);
            (void)parser.Eval();
            return parser;
        };
        formula_ = compiled(effect.formula);
        for (const FormulaEffect::Memory& memory : effect.memories) {
            followed_.push_back(compiled(memory.of));
            extent_.push_back(compiled(memory.by.empty() ? "0" : memory.by));
        }
    }
    Machine(const Machine&) = delete;  // parsers point at values_
    Machine& operator=(const Machine&) = delete;

    void set(std::span<const double> variables, std::span<const double> memories,
             std::span<const double> parameters) {
        std::ranges::copy(variables, values_.begin());
        std::ranges::copy(memories, values_.begin() + static_cast<std::ptrdiff_t>(first_memory_));
        std::ranges::copy(parameters, values_.begin() + static_cast<std::ptrdiff_t>(first_parameter_));
    }

    double value() const { return formula_.Eval(); }
    double followed(std::size_t memory) const { return followed_[memory].Eval(); }
    double extent(std::size_t memory) const { return extent_[memory].Eval(); }

  private:
    std::vector<double> values_;  ///< variables, memories, parameters
    std::size_t first_memory_ = 0, first_parameter_ = 0;
    mu::Parser formula_;
    std::vector<mu::Parser> followed_, extent_;
};

FormulaCode::FormulaCode(const FormulaEffect& effect) : effect_(effect), port_(find_port(effect.acts_on)) {
    static std::atomic<std::size_t> count = 0;
    const auto where = [&](const std::string& key) { return effect_.name + ": " + key; };
    if (port_ == nullptr) {
        std::string known;
        for (const PortDescription& port : ports())
            known += (known.empty() ? "" : ", ") + std::string(port.name);
        refuse(where("acts_on") + ": \"" + effect_.acts_on + "\" is no port; allowed: " + known);
    }
    if (std::ranges::find(port_->blocks, effect_.block) == port_->blocks.end()) {
        std::string allowed;
        for (const std::string_view block : port_->blocks)
            allowed += (allowed.empty() ? "" : ", ") + std::string(block);
        refuse(where("block") + ": \"" + effect_.block + "\": what acts on " + std::string(port_->name) +
               " is of another block; allowed: " + allowed);
    }
    if (effect_.memories.size() > most_memories)
        refuse(where("state") + ": " + std::to_string(effect_.memories.size()) +
               " quantities that remember; allowed: " + std::to_string(most_memories) + " at most");
    if (!effect_.memories.empty() && !port_->may_remember)
        refuse(where(key_of(effect_.memories.front())) + ": nothing is remembered at " +
               std::string(port_->name) + "; allowed: a formula of what is there at the moment");
    if (effect_.parameters.size() > most_formula_parameters)
        refuse(where("parameters") + ": " + std::to_string(effect_.parameters.size()) +
               "; allowed: " + std::to_string(most_formula_parameters) + " at most");
    const std::vector<std::string> parameters = parameter_names(effect_);
    const auto known = variables_of(port_->site);
    std::vector<std::string> allowed;
    for (const std::size_t variable : port_->variables) allowed.emplace_back(known[variable].name);
    const auto add_name = [&](const std::string& name, const std::string& key) {
        const bool is_taken = std::ranges::find(allowed, name) != allowed.end() ||
                              std::ranges::find(reserved, name) != reserved.end();
        if (!is_name(name) || is_taken)
            refuse(where(key) + ": \"" + name + "\" " +
                   (is_taken ? "means something else already" : "is no name") +
                   "; allowed: letters, digits and _, no digit first, none of " + listed(allowed) + ", " +
                   functions);
        allowed.push_back(name);
    };
    for (const std::string& name : parameters) add_name(name, "parameters." + name);
    for (const FormulaEffect::Memory& memory : effect_.memories) add_name(memory.name, key_of(memory));

    const auto note = [&](const std::string& key, const std::string& text,
                          const std::vector<std::string>& names) {
        for (const std::string& name : names_in(where(key), text, names))
            for (std::size_t k = 0; k < known.size(); ++k)
                if (known[k].name == name) used_.set(k);
    };
    note("formula", effect_.formula, allowed);
    for (const FormulaEffect::Memory& memory : effect_.memories) {
        note(key_of(memory), memory.of, allowed);
        if (memory.kind != FormulaEffect::Memory::Kind::state)
            note(extent_key(memory), memory.by, parameters);
    }
    id_ = count++;
}

const FormulaCode& FormulaCode::of(const FormulaEffect& effect) {
    static std::mutex guard;
    static std::unordered_multimap<std::string, std::unique_ptr<const FormulaCode>> all;
    const std::lock_guard lock(guard);
    const std::string key = effect.name + '\n' + effect.acts_on + '\n' + effect.formula;
    const auto [first, last] = all.equal_range(key);
    const auto known =
        std::find_if(first, last, [&](const auto& code) { return code.second->effect_ == effect; });
    if (known != last) return *known->second;
    return *all.emplace(key, std::unique_ptr<const FormulaCode>(new FormulaCode(effect)))->second;
}

FormulaCode::Machine& FormulaCode::machine() const {
    struct Kept {
        std::size_t id = 0;
        std::unique_ptr<Machine> machine;
    };
    thread_local std::array<Kept, 256> own;  // of the effects that were evaluated last
    Kept& kept = own[id_ % own.size()];
    if (!kept.machine || kept.id != id_) kept = {id_, std::make_unique<Machine>(*this)};
    return *kept.machine;
}

std::vector<std::string> FormulaCode::variable_names() const {
    std::vector<std::string> names;
    const auto known = variables_of(port_->site);
    for (std::size_t k = 0; k < known.size(); ++k)
        if (uses(k)) names.emplace_back(known[k].name);
    return names;
}

double FormulaCode::value(std::span<const double> variables, std::span<const double> memories,
                          std::span<const double> parameters) const {
    Machine& here = machine();
    here.set(variables, memories, parameters);
    return here.value();
}

double FormulaCode::followed(std::size_t memory, std::span<const double> variables,
                             std::span<const double> memories, std::span<const double> parameters) const {
    Machine& here = machine();
    here.set(variables, memories, parameters);
    return here.followed(memory);
}

double FormulaCode::extent(std::size_t memory, std::span<const double> parameters) const {
    Machine& here = machine();
    here.set({}, {}, parameters);
    return here.extent(memory);
}

void FormulaCode::demand_extents(std::span<const double> parameters) const {
    for (std::size_t k = 0; k < effect_.memories.size(); ++k) {
        const FormulaEffect::Memory& memory = effect_.memories[k];
        if (memory.kind == FormulaEffect::Memory::Kind::state) continue;
        const bool is_delay = memory.kind == FormulaEffect::Memory::Kind::delay;
        const double value = extent(k, parameters);
        if (value >= 0.0 && (is_delay ? value <= longest_delay_s : std::isfinite(value))) continue;
        std::ostringstream what;
        what << extent_key(memory) << ": is " << value << (is_delay ? " s" : "") << at_values(parameters)
             << "; allowed: " << (is_delay ? "0 to " : "numbers not below 0");
        if (is_delay) what << longest_delay_s << " s";
        throw FormulaFault(effect_.name, what.str());
    }
}

std::string FormulaCode::at_values(std::span<const double> parameters) const {
    std::ostringstream text;
    const char* separator = " with ";
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        text << separator << effect_.parameters[k].name << " = " << parameters[k];
        separator = ", ";
    }
    return text.str();
}

}  // namespace fidservo::plant

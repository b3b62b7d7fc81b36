// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/term_library.h"

#include "gap/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace fidservo::gap {

namespace {

using Memory = FormulaEffect::Memory;

std::string six_digits(double value) {
    return fmt::format("{:.6g}", value);
}

std::string times(const std::string& factor, const std::string& text) {
    return factor.empty() ? text : fmt::format("{} * {}", factor, text);
}

}  // namespace

double KnownVariable::step() const {
    // Mathematics: half of the last but one decimal place.
    return 0.5 * std::pow(10.0, std::floor(std::log10(std::max(next_to_nothing, 2.0 * range.half()))) - 1.0);
}

std::string KnownVariable::clipped() const {
    return fmt::format("clip({}, {}, {})", name, six_digits(step() * std::floor(range.low / step())),
                       six_digits(step() * std::ceil(range.high / step())));
}

double KnownVariable::origin() const {
    constexpr double hardly = small_part;
    const bool has_both_signs = std::min(-range.low, range.high) > hardly * range.half();
    return has_both_signs ? 0.0 : step() * std::round(range.middle() / step());
}

std::string KnownVariable::centred() const {
    const double at = origin();
    return at == 0.0 ? clipped() : fmt::format("({} - {})", clipped(), six_digits(at));
}

double KnownVariable::most() const {
    return std::max({std::abs(range.low), std::abs(range.high), next_to_nothing});
}

double KnownVariable::reach() const {
    return std::max({range.high - origin(), origin() - range.low, next_to_nothing});
}

std::string KnownVariable::power_unit(int power) const {
    if (power == 1) return unit;
    return unit.find('/') == std::string::npos ? fmt::format("{}{}", unit, power)
                                               : fmt::format("({}){}", unit, power);
}

void TermLibrary::add(std::string text, std::string unit, double size, std::string words) {
    keep({{std::move(text)}, std::move(unit), size, {}, next_family_++, std::move(words)});
}

void TermLibrary::keep(Term term) {
    const auto has_room = [](const TermShape& shape) { return shape.low < shape.high; };
    if (term.size > 0.0 && std::ranges::all_of(term.shapes, has_room)) terms_.push_back(std::move(term));
}

void TermLibrary::add_constant(const std::string& factor, const std::string& words) {
    add(factor.empty() ? "1" : factor, "", 1.0, words);
}

void TermLibrary::add_powers(const KnownVariable& of, int highest, const std::string& factor) {
    constexpr std::array names{"in proportion to", "growing with the square of", "growing with the cube of"};
    for (int power = 1; power <= highest; ++power) {
        const std::string text = power == 1 ? of.clipped() : fmt::format("{}^{}", of.centred(), power);
        const double size = power == 1 ? of.most() : std::pow(of.reach(), power);
        add(times(factor, text), of.power_unit(power), size,
            fmt::format("{} {}", names[static_cast<std::size_t>(power - 1)], of.words));
        if (power == 2) add_squares_elsewhere(of, factor);
    }
}

/// Adds squares about other centres to the family of the square about the origin, which was added last.
void TermLibrary::add_squares_elsewhere(const KnownVariable& of, const std::string& factor) {
    Term square = terms_.back();
    square.texts = {times(factor, fmt::format("({} - shape)^2", of.clipped()))};
    const double half = of.range.half(), middle = of.range.middle();
    for (const double share : {-0.5, 0.5}) {
        square.shapes = {{of.unit, middle + share * half, middle - 2.0 * half, middle + 2.0 * half}};
        keep(square);
    }
}

void TermLibrary::add_knees(const std::string& text, const KnownVariable& of, const std::string& words) {
    const int family = next_family_++;
    constexpr std::array knees{0.2, 0.5, 0.8};
    for (const double share : knees) {
        const double at = of.range.low + share * (of.range.high - of.range.low);
        keep({{text},
              of.unit,
              0.5 * (of.range.high - of.range.low),
              {{of.unit, at, of.range.low, of.range.high}},
              family,
              words});
    }
}

void TermLibrary::add_product(const KnownVariable& left, const KnownVariable& right) {
    add(fmt::format("{} * {}", left.clipped(), right.clipped()), fmt::format("{} {}", left.unit, right.unit),
        left.most() * right.most(), fmt::format("in proportion to {} times {}", left.words, right.words));
}

void TermLibrary::add_shaped(const std::vector<std::string>& texts, const TermShape& shape,
                             std::span<const double> values, const std::string& words) {
    const int family = next_family_++;
    for (const double value : values)
        keep({texts, "", 1.0, {{shape.unit, value, shape.low, shape.high}}, family, words});
}

void TermLibrary::add_waves(const std::string& variable, std::span<const double> periods_mm,
                            const std::string& factor) {
    constexpr double shorter = 0.9, longer = 1.1;
    for (const double period_mm : periods_mm)
        add_shaped({times(factor, fmt::format("sin(2 * pi * {} / shape)", variable)),
                    times(factor, fmt::format("cos(2 * pi * {} / shape)", variable))},
                   {"mm", period_mm, shorter * period_mm, longer * period_mm}, std::array{period_mm},
                   fmt::format("a wave along the way, {:.3g} mm long", period_mm));
}

void TermLibrary::add_steps_and_bells(const KnownVariable& of, std::span<const Bend> bends,
                                      const std::string& factor) {
    const double half = std::max(of.range.half(), next_to_nothing);
    constexpr double narrowest = 0.02, widest = 3.0;
    const auto add_bends = [&](const std::string& text, const std::string& words) {
        const int family = next_family_++;
        for (const auto& [width, centre] : bends)
            keep({{times(factor, text)},
                  "",
                  1.0,
                  {{of.unit, width, narrowest * half, widest * half},
                   {of.unit, centre, of.range.low, of.range.high}},
                  family,
                  words});
    };
    add_bends(fmt::format("tanh(({} - centre) / shape)", of.name),
              fmt::format("that steps with {}", of.words));
    add_bends(fmt::format("exp(-(({} - centre) / shape)^2)", of.name),
              fmt::format("around one value of {}", of.words));
}

void TermLibrary::add_steps_and_bells(const KnownVariable& of) {
    const double half = std::max(of.range.half(), next_to_nothing), middle = of.range.middle();
    constexpr double narrow = 0.25;
    add_steps_and_bells(of,
                        std::array{Bend{0.5 * half, middle}, Bend{narrow * half, middle - 0.5 * half},
                                   Bend{narrow * half, middle}, Bend{narrow * half, middle + 0.5 * half}});
}

void TermLibrary::add_fading(const std::string& factor, const std::string& words) {
    add_shaped({times(factor, "exp(-time / shape)")}, {"s", 0.0, shortest_slow_s, longest_slow_s},
               slow_constants_s, words);
}

void TermLibrary::add_remembering(const Memory& memory, const KnownVariable& of, const TermShape& shape,
                                  std::span<const double> values, const std::string& words) {
    const int family = next_family_++;
    for (const double value : values)
        keep({{fmt::format("({} - {})", memory_name, of.name)},
              of.unit,
              of.reach(),
              {{shape.unit, value, shape.low, shape.high}},
              family,
              words,
              memory});
}

void TermLibrary::add_delayed(const KnownVariable& of, const TermShape& shape,
                              std::span<const double> delays_s) {
    add_remembering(
        {.name = std::string(memory_name), .kind = Memory::Kind::delay, .of = of.name, .by = "shape"}, of,
        shape, delays_s, fmt::format("as if {} came later", of.words));
}

void TermLibrary::add_lagging(const KnownVariable& of, const TermShape& shape,
                              std::span<const double> time_constants_s) {
    add_remembering({.name = std::string(memory_name),
                     .kind = Memory::Kind::state,
                     .of = fmt::format("({} - {}) / shape", of.name, memory_name),
                     .by = {}},
                    of, shape, time_constants_s,
                    fmt::format("towards what {} was, as something that follows it slowly", of.words));
}

}  // namespace fidservo::gap

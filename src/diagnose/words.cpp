// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/words.h"

#include "core/hall.h"
#include "core/rig.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 13> blocks{{
    {"macro.drive", "the drive of the carriage"},
    {"macro.friction", "the friction of the carriage"},
    {"macro.mechanics", "the mechanics of the carriage"},
    {"macro.encoder", "the encoder"},
    {"micro.heater", "the heating and cooling of the wire"},
    {"micro.hysteresis", "the wire's contraction over temperature"},
    {"micro.mechanics", "the mechanics of the platform"},
    {"micro.hall", "the Hall sensor"},
    {"camera.geometry", "the lens and mounting of the camera"},
    {"camera.timing", "the camera's frame times"},
    {"camera.image", "the camera's image"},
    {"plate", "the plate of fiducials"},
    {"controller", "the controllers"},
}};

/// "10" and its exponent as superscript digits.
std::string power_of_ten(int exponent) {
    constexpr std::array<std::string_view, 10> digits{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                      "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string text = exponent < 0 ? "10\u207b" : "10";
    for (const char digit : fmt::format("{}", std::abs(exponent)))
        text += digits[static_cast<std::size_t>(digit - '0')];
    return text;
}

}  // namespace

std::string block_words(std::string_view block) {
    const auto* const found =
        std::ranges::find(blocks, block, &std::pair<std::string_view, std::string_view>::first);
    return std::string(found == blocks.end() ? block : found->second);
}

std::string_view signal_words(gap::Signal signal) {
    constexpr std::array<std::string_view, gap::signal_count> names{
        "encoder reading", "Hall reading",  "tags' places in the image",
        "macro command",   "micro command", "tags' looks in the frames"};
    return names[gap::index_of(signal)];
}

std::string dependence_words(const std::string& dependence) {
    constexpr std::string_view periodic = "position, periodic (";
    if (!dependence.starts_with(periodic) || !dependence.ends_with(')')) return dependence;
    return "position with a period of " +
           dependence.substr(periodic.size(), dependence.size() - periodic.size() - 1);
}

std::string readable(std::string_view name) {
    std::string text(name);
    std::ranges::replace(text, '_', ' ');
    return text;
}

std::string enumerated(const std::vector<std::string>& parts) {
    std::string text;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (k > 0) text += k + 1 == parts.size() ? " and " : ", ";
        text += parts[k];
    }
    return text;
}

std::string capitalised(std::string text) {
    if (!text.empty())
        text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string three_digits(double value) {
    constexpr int least_exponent = -4, first_large_exponent = 5;
    if (!std::isfinite(value)) return "\u2013";
    if (value == 0.0) return "0";
    const std::string scientific = fmt::format("{:.2e}", std::abs(value));
    const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
    const double rounded = std::stod(scientific);
    std::string text;
    if (exponent < least_exponent || exponent >= first_large_exponent) {
        text = scientific.substr(0, scientific.find('e')) + "\u00d7" + power_of_ten(exponent);
    } else {
        text = fmt::format("{:.{}f}", rounded, std::max(0, 2 - exponent));
        if (exponent > 2) text.insert(text.size() - 3, "\u202f");
    }
    return value < 0.0 ? "\u2212" + text : text;
}

DisplayUnit display_unit(const Rig& rig, gap::Signal signal, double largest) {
    constexpr double largest_in_um_mm = 1.0;
    const double resolution_mm = rig.macro.encoder_resolution_mm;
    switch (signal) {
        case gap::Signal::encoder:
            if (largest * resolution_mm > largest_in_um_mm) return {"mm", resolution_mm};
            return {"\u00b5m", 1000.0 * resolution_mm};
        case gap::Signal::hall:
            return {"LSB", 1.0};
        case gap::Signal::tag:
            return {"px", 1.0};
        case gap::Signal::macro_command:
        case gap::Signal::micro_command:
            return {"mV", 1000.0};
        case gap::Signal::image:
            return {"floors", 1.0};
    }
    return {"", 1.0};
}

std::string shown_size(const Rig& rig, gap::Signal signal, double own_unit) {
    constexpr double least_shown = 0.01;
    const DisplayUnit display = display_unit(rig, signal, own_unit);
    const double size = own_unit * display.per_own_unit;
    if (size < least_shown) return fmt::format("< {} {}", least_shown, display.unit);
    return fmt::format("{} {}", three_digits(size), display.unit);
}

double hall_um_per_lsb(const HallParameters& hall) {
    return 1000.0 * hall_lsb_V(hall) / hall_slope_V_per_mm(hall, hall.centre_mm);
}

std::string platform_motion(const Rig& rig, double hall_lsb) {
    return three_digits(hall_lsb * hall_um_per_lsb(rig.micro->hall)) + " \u00b5m";
}

std::string floors_words(double floors) {
    constexpr double least_shown = 0.1;
    return floors < least_shown ? "< 0.1" : three_digits(floors);
}

std::string probability_words(double probability) {
    constexpr double nothing = 0.0005;
    if (probability < nothing) return "< 0.1 %";
    if (probability > 1.0 - nothing) return "> 99.9 %";
    return fmt::format("{:.1f} %", 100.0 * probability);
}

std::string share_words(double share) {
    if (share == 0.0) return "0 %";
    return share == 1.0 ? "100 %" : probability_words(share);
}

std::vector<std::string> ties_of(const gap::FoundEffect& effect, const gap::Diagnosis& diagnosis) {
    std::vector<std::string> names;
    for (const std::string& name : effect.indistinguishable_from)
        if (std::ranges::find(diagnosis.effects, name, &gap::FoundEffect::effect) == diagnosis.effects.end())
            names.push_back(name);
    return names;
}

int size_class(double floors) {
    constexpr std::array<double, 4> bounds{1.1, 2.0, 5.0, 20.0};
    return static_cast<int>(std::ranges::count_if(bounds, [&](double bound) { return floors > bound; }));
}

}  // namespace fidservo::diagnose

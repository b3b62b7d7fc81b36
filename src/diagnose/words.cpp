#include "src/diagnose/words.h"

#include "core/hall.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
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

double hall_um_per_lsb(const HallParameters& hall) {
    return 1000.0 * hall_lsb_V(hall) / hall_slope_V_per_mm(hall, hall.centre_mm);
}

/// Digits in threes, with thin spaces.
std::string grouped(long long value) {
    std::string digits = fmt::format("{}", value);
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), "\u202f");
    return digits;
}

}  // namespace

std::string block_words(std::string_view block) {
    const auto* const found =
        std::ranges::find(blocks, block, &std::pair<std::string_view, std::string_view>::first);
    return std::string(found == blocks.end() ? block : found->second);
}

std::string_view signal_words(gap::Signal signal) {
    constexpr std::array<std::string_view, gap::signal_count> names{
        "encoder reading", "Hall reading", "tags' places in the image", "macro command", "micro command"};
    return names[gap::index_of(signal)];
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
    constexpr double exponential_below = 1e-4, exponential_from = 1e7;
    if (!std::isfinite(value)) return "\u2013";
    const double size = std::abs(value);
    std::string text;
    if (size == 0.0)
        text = "0";
    else if (size < exponential_below || size >= exponential_from)
        text = fmt::format("{:.2e}", size);
    else if (size >= 999.5)
        text = grouped(std::llround(size));
    else {
        const int digits = std::max(0, 2 - static_cast<int>(std::floor(std::log10(size * 1.0005))));
        text = fmt::format("{:.{}f}", size, digits);
    }
    return value < 0.0 ? "\u2212" + text : text;
}

DisplayUnit display_unit(const Rig& rig, gap::Signal signal) {
    switch (signal) {
        case gap::Signal::encoder:
            return {"\u00b5m", 1000.0 * rig.macro.encoder_resolution_mm};
        case gap::Signal::hall:
            return {"LSB", 1.0};
        case gap::Signal::tag:
            return {"px", 1.0};
        case gap::Signal::macro_command:
        case gap::Signal::micro_command:
            return {"mV", 1000.0};
    }
    return {"", 1.0};
}

std::string shown_size(const Rig& rig, gap::Signal signal, double own_unit) {
    constexpr double thousand = 1000.0, least_shown = 0.001;
    const DisplayUnit display = display_unit(rig, signal);
    const double size = own_unit * display.per_own_unit;
    if (size < least_shown) return fmt::format("< {} {}", least_shown, display.unit);
    if (size >= thousand && signal == gap::Signal::encoder) return three_digits(size / thousand) + " mm";
    return fmt::format("{} {}", three_digits(size), display.unit);
}

std::string platform_motion(const Rig& rig, double hall_lsb) {
    return three_digits(hall_lsb * hall_um_per_lsb(rig.micro->hall)) + " \u00b5m";
}

std::string floors_words(double floors) {
    constexpr double least_shown = 0.01;
    return floors < least_shown ? "< 0.01" : three_digits(floors);
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

int size_class(double floors) {
    constexpr std::array<double, 4> bounds{1.1, 2.0, 5.0, 20.0};
    return static_cast<int>(std::ranges::count_if(bounds, [&](double bound) { return floors > bound; }));
}

}  // namespace fidservo::diagnose

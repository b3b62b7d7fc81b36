// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/design.h"

#include "core/demand.h"
#include "core/rig.h"
#include "src/simulation/experiment_file.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace fidservo::design {
namespace {

constexpr double shortest_piece_s = 0.02;
constexpr double slowest_hz = 0.05, fastest_hz = 10.0;
/// Share of a travel at either end that setpoints leave free, for a controller may go beyond a setpoint.
constexpr double margin = 0.04;
constexpr double of_products = 1e-6;  // of products
constexpr double places_V = 1e4, places_mm = 1e3, places_hz = 1e6;

struct Range {
    double low, high;
    bool is_logarithmic = false;

    double clamped(double value) const { return std::clamp(value, low, high); }
    double share_of(double value) const {
        const double share = is_logarithmic ? std::log(clamped(value) / low) / std::log(high / low)
                                            : (value - low) / (high - low);
        return std::clamp(share, 0.0, 1.0);
    }
    double at(double share) const {
        const double within = std::clamp(share, 0.0, 1.0);
        return is_logarithmic ? low * std::pow(high / low, within) : low + within * (high - low);
    }
};

Range travel(double low_mm, double high_mm) {
    const double free_mm = margin * (high_mm - low_mm);
    return {low_mm + free_mm, high_mm - free_mm};
}

Range range_of(const DesignedPiece& piece, bool is_macro, const Rig& rig) {
    const bool is_setpoint = piece.follows == Follows::setpoint;
    if (is_macro)
        return is_setpoint ? travel(rig.macro.low_mm, rig.macro.high_mm)
                           : Range{-rig.macro.command_limit_V, rig.macro.command_limit_V};
    return is_setpoint ? travel(rig.micro->low_mm, rig.micro->high_mm)
                       : Range{0.0, rig.micro->heater.limit_V};
}

/// Calls visit(value, range) for all that may change.
template <typename Visit>
void visit_numbers(Design& design, const Rig& rig, const Visit& visit) {
    visit(design.carriage_mm, travel(rig.macro.low_mm, rig.macro.high_mm));
    for (const bool is_macro : {true, false})
        for (DesignedPiece& piece : is_macro ? design.macro : design.micro) {
            const Range range = range_of(piece, is_macro, rig);
            visit(piece.duration_s, Range{shortest_piece_s, longest_s, true});
            if (piece.is_rest) continue;
            if (piece.shape != Shape::sine || range.low >= 0.0 || piece.follows == Follows::setpoint)
                visit(piece.value, range);
            if (piece.shape == Shape::ramp) visit(piece.end, range);
            if (piece.shape != Shape::sine) continue;
            visit(piece.amplitude, Range{0.0, 0.5 * (range.high - range.low)});
            visit(piece.frequency_hz, Range{slowest_hz, fastest_hz, true});
        }
}

double to_places(double value, double places) {
    return std::round(value * places) / places;
}

DesignedPiece rounded_piece(DesignedPiece piece, const Range& range) {
    const double places = piece.follows == Follows::setpoint ? places_mm : places_V;
    piece.value = to_places(range.clamped(piece.value), places);
    piece.end = to_places(range.clamped(piece.end), places);
    piece.frequency_hz = to_places(piece.frequency_hz, places_hz);
    const double room = std::min(range.high - piece.value, piece.value - range.low);
    piece.amplitude = std::floor(std::min(piece.amplitude, room) * places + of_products) / places;
    if (piece.shape == Shape::sine && piece.amplitude <= 0.0) piece.shape = Shape::constant;
    if (piece.shape != Shape::ramp) piece.end = 0.0;
    if (piece.shape != Shape::sine) piece.amplitude = piece.frequency_hz = 0.0;
    return piece;
}

void round_pieces(std::vector<DesignedPiece>& pieces, bool is_macro, const Rig& rig) {
    const auto most_ticks = std::llround(longest_s / rig.tick_s);
    long long ticks = 0;
    std::vector<DesignedPiece> kept;
    for (DesignedPiece& piece : pieces) {
        const auto lasts = std::min(std::llround(piece.duration_s / rig.tick_s), most_ticks - ticks);
        if (lasts <= 0) continue;
        ticks += lasts;
        piece.duration_s = static_cast<double>(lasts) * rig.tick_s;
        kept.push_back(rounded_piece(piece, range_of(piece, is_macro, rig)));
    }
    pieces = std::move(kept);
}

double sum_s(const std::vector<DesignedPiece>& pieces) {
    double sum = 0.0;
    for (const DesignedPiece& piece : pieces) sum += piece.duration_s;
    return sum;
}

/// A number without trailing zeros, as exact as an experiment file states it.
std::string plain(double value) {
    std::string text = fmt::format("{:.6f}", value == 0.0 ? 0.0 : value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

std::string line_of(const DesignedPiece& piece) {
    const std::string_view unit = piece.follows == Follows::setpoint ? "mm" : "V";
    std::string text;
    if (piece.shape == Shape::constant) {
        text = fmt::format("constant_{}: {}", unit, plain(piece.value));
    } else if (piece.shape == Shape::ramp) {
        text = fmt::format("ramp_{}: [{}, {}]", unit, plain(piece.value), plain(piece.end));
    } else {
        text = fmt::format("sine_{}: {}, offset_{}: {}, frequency_hz: {}", unit, plain(piece.amplitude), unit,
                           plain(piece.value), plain(piece.frequency_hz));
    }
    return fmt::format("  - {{{}, duration_s: {}}}\n", text, plain(piece.duration_s));
}

}  // namespace

double duration_s(const Design& design) {
    return std::max(sum_s(design.macro), sum_s(design.micro));
}

Design rounded(Design design, const Rig& rig) {
    design.carriage_mm =
        to_places(travel(rig.macro.low_mm, rig.macro.high_mm).clamped(design.carriage_mm), places_mm);
    round_pieces(design.macro, true, rig);
    round_pieces(design.micro, false, rig);
    return design;
}

std::string experiment_yaml(const Design& design, const std::string& name,
                            const std::vector<std::string>& remark) {
    std::string text;
    for (const std::string& line : remark) text += fmt::format("# {}\n", line);
    text += fmt::format("name: {}\ncarriage_mm: {}\n", name, plain(design.carriage_mm));
    const auto add = [&](std::string_view stage, const std::vector<DesignedPiece>& pieces) {
        if (pieces.empty()) return;
        text += fmt::format("{}:\n", stage);
        for (const DesignedPiece& piece : pieces) text += line_of(piece);
    };
    add("macro", design.macro);
    add("micro", design.micro);
    return text;
}

Experiment experiment_of(const Design& design, const std::string& name, const Rig& rig) {
    return parse_experiment(experiment_yaml(design, name), name, rig);
}

std::vector<double> numbers(const Design& design, const Rig& rig) {
    Design copy = design;
    std::vector<double> shares;
    visit_numbers(copy, rig,
                  [&](double& value, const Range& range) { shares.push_back(range.share_of(value)); });
    return shares;
}

Design with_numbers(Design form, const std::vector<double>& shares, const Rig& rig) {
    auto next = shares.begin();
    visit_numbers(form, rig, [&](double& value, const Range& range) {
        FIDSERVO_DEMAND(next != shares.end());
        value = range.at(*next++);
    });
    FIDSERVO_DEMAND(next == shares.end());
    return rounded(std::move(form), rig);
}

}  // namespace fidservo::design

// SPDX-License-Identifier: GPL-3.0-or-later
// The wire's hysteresis: a family of first-order descending curves from a kiln, the Preisach model that it
// gives, and its validation on another temperature profile, forwards and inverted (fig. 12).
#include "calib/wire/fod_curves.h"
#include "core/input_error.h"
#include "core/random.h"
#include "core/rig.h"
#include "reference/hysteresis.h"
#include "src/report/xy_chart.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr double kiln_encoder_mm = 0.014, um_in_mm = 1e3;

/// Straight ramps through some temperatures, a sample every quarter of a degree.
std::vector<double> ramps(const std::vector<double>& turns_degC) {
    constexpr double step_degC = 0.25;
    std::vector<double> temps{turns_degC.front()};
    for (std::size_t i = 1; i < turns_degC.size(); ++i) {
        const double from = turns_degC[i - 1], way = turns_degC[i] - from;
        const int samples = static_cast<int>(std::ceil(std::abs(way) / step_degC));
        for (int k = 1; k <= samples; ++k) temps.push_back(from + way * k / samples);
    }
    return temps;
}

/// The wire in the kiln, as the encoder shows it.
calib::HysteresisTrace in_the_kiln(const Rig& rig, std::vector<double> temps_degC) {
    const reference::HysteresisModel wire = reference::make_hysteresis(*rig.micro->fod, {});
    reference::HysteresisState state = reference::heated_to(wire, temps_degC.front());
    std::vector<double> read_mm(temps_degC.size());
    std::ranges::transform(temps_degC, read_mm.begin(), [&](double temp_degC) {
        reference::move_to(wire, state, temp_degC);
        return kiln_encoder_mm * std::floor(reference::contraction_mm(wire, state) / kiln_encoder_mm + 0.5);
    });
    return {std::move(temps_degC), std::move(read_mm)};
}

/// From cold to a peak and back, with peaks that fall from cycle to cycle.
std::vector<double> decreasing_peaks(const FodTable& wire) {
    constexpr double cold_margin_degC = 8.0, peak_step_degC = 3.0, lowest_share = 0.35;
    const double cold_degC = wire.low_degC() + cold_margin_degC;
    std::vector<double> turns{cold_degC};
    for (double peak = wire.high_degC();
         peak > wire.low_degC() + lowest_share * (wire.high_degC() - wire.low_degC()); peak -= peak_step_degC)
        turns.insert(turns.end(), {peak, cold_degC});
    return ramps(turns);
}

/// Loops within loops, at random.
std::vector<double> validation_profile(const FodTable& wire, double cold_degC, std::uint64_t seed) {
    constexpr int turns_made = 24;
    NoiseStream draw(seed, "reproduce/kiln");
    std::vector<double> turns{cold_degC};
    for (int i = 0; i < turns_made; ++i) {
        const double share = i % 2 == 0 ? 0.5 + 0.45 * draw.uniform() : 0.15 + 0.4 * draw.uniform();
        turns.push_back(wire.low_degC() + share * (wire.high_degC() - wire.low_degC()));
    }
    return ramps(turns);
}

/// The inverse model: temperatures for displacements, put into the wire. R.m.s. of displacement reached minus
/// wanted.
double inverse_rms_mm(const Rig& rig, const FodTable& model, double cold_degC, std::uint64_t seed) {
    constexpr int targets = 200;
    NoiseStream draw(seed, "reproduce/inverse");
    const reference::HysteresisModel wire = reference::make_hysteresis(*rig.micro->fod, {});
    reference::HysteresisState state = reference::heated_to(wire, cold_degC);
    PreisachMemory memory = preisach_start(model, cold_degC);
    double squares = 0.0;
    for (int i = 0; i < targets; ++i) {
        const double wanted_mm = model.stroke_mm() * (0.1 + 0.8 * draw.uniform());
        const auto temp_degC = preisach_inverse(model, memory, wanted_mm);
        if (!temp_degC)
            throw RunFault(fmt::format("inverse hysteresis: {:.3f} mm is out of reach", wanted_mm));
        preisach_step(model, memory, *temp_degC);
        reference::move_to(wire, state, *temp_degC);
        const double error_mm = reference::contraction_mm(wire, state) - wanted_mm;
        squares += error_mm * error_mm / targets;
    }
    return std::sqrt(squares);
}

}  // namespace

Chapter wire_hysteresis(const Laboratory& laboratory) {
    const Rig& rig = laboratory.rig;
    const FodTable& wire = *rig.micro->fod;
    const calib::HysteresisTrace kiln = in_the_kiln(rig, decreasing_peaks(wire));
    constexpr std::size_t nodes = 45;
    const auto found =
        calib::identify_fod(kiln, {.nodes = nodes, .least_reversal = {}, .output_step = kiln_encoder_mm});
    if (!found) throw RunFault(fmt::format("identification of the hysteresis: {}", found.error().text));
    const calib::HysteresisTrace other =
        in_the_kiln(rig, validation_profile(wire, kiln.input.front(), laboratory.seed));
    const std::vector<double> predicted = calib::predict(found->fit, other.input);
    const double validation_mm = calib::prediction_rms(found->fit, other);
    const double inverse_mm = inverse_rms_mm(rig, found->fit.table, kiln.input.front(), laboratory.seed);

    Chapter chapter{"hysteresis", "The wire's hysteresis", "", {}};
    chapter.html =
        chart_figure(
            fmt::format("Fig. 12 from our data: heated from cold to {} peaks, each lower than the last, and "
                        "cooled; read by an "
                        "encoder of 14 um. The cooling branches are the first-order descending curves.",
                        found->descending.size()),
            report::xy_chart_svg("temperature, degC", "contraction, mm",
                                 {{"kiln cycles", kiln.input, kiln.output}})) +
        chart_figure(fmt::format("Validation on another profile of loops within loops: {:.1f} um r.m.s. "
                                 "between model and encoder, "
                                 "whose rounding alone is {:.1f} um.",
                                 um_in_mm * validation_mm, um_in_mm * kiln_encoder_mm / std::sqrt(12.0)),
                     report::xy_chart_svg("temperature, degC", "contraction, mm",
                                          {{"encoder", other.input, other.output},
                                           {"Preisach model", other.input, predicted}}));
    chapter.claims = {
        {"fig. 12",
         "The Preisach model from the descending curves predicts a profile that it was not made from.",
         fmt::format("{:.1f} um r.m.s. of {:.2f} mm stroke ({:.2f} %)", um_in_mm * validation_mm,
                     wire.stroke_mm(), 100.0 * validation_mm / wire.stroke_mm()),
         holds_if(validation_mm < 0.01 * wire.stroke_mm()), ""},
        {"eq. 8", "The model can be inverted: from a displacement to the temperature that gives it.",
         fmt::format("200 displacements asked for, {:.1f} um r.m.s. missed by the wire",
                     um_in_mm * inverse_mm),
         holds_if(inverse_mm < 0.01 * wire.stroke_mm()), ""}};
    return chapter;
}

}  // namespace fidservo::reproduce

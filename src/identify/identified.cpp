// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/identified.h"

#include "calib/tails.h"
#include "core/rig.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/rig_edit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace fidservo {

namespace {

nlohmann::json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Decimals at which a standard error has two digits.
int decimals_of(double error) {
    constexpr int most = 12;
    if (!std::isfinite(error) || error <= 0.0) return most / 2;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, most);
}

/// As many digits as the standard error has meaning.
std::string with_error(double value, double std) {
    if (!std::isfinite(std) || std <= 0.0) return fmt::format("{:.6g}", value);
    const int decimals = decimals_of(std);
    return fmt::format("{:.{}f} +- {:.{}f}", value, decimals, std, decimals);
}

std::string describe(const IdentifiedValue& value) {
    std::string text = fmt::format("{} {}", with_error(value.value, value.std), value.unit);
    if (value.interval)
        text += fmt::format(" (95 %: {:.{}f} to {:.{}f})", value.interval->low, decimals_of(value.std),
                            value.interval->high, decimals_of(value.std));
    if (value.systematic > value.std)
        text += fmt::format(", by up to {:.2g} more if what the model lacks goes with it", value.systematic);
    return text;
}

nlohmann::json interval_of(const IdentifiedValue& value) {
    if (value.interval) return {finite_or_null(value.interval->low), finite_or_null(value.interval->high)};
    if (!std::isfinite(value.std)) return {};
    return {value.value - calib::normal_95 * value.std, value.value + calib::normal_95 * value.std};
}

nlohmann::ordered_json json_of(const Contradiction::Side& side) {
    return {{"recording", side.recording}, {"value", side.value}, {"std", side.std}};
}

std::string describe(const FitResidual& residual) {
    std::string text = fmt::format("{} {:.4g} {} r.m.s.", residual.signal, residual.rms, residual.unit);
    if (residual.floor) text += fmt::format(" (noise and rounding: {:.4g})", *residual.floor);
    return text;
}

}  // namespace

std::optional<Interval95> wide_interval(double value, double std, double freedom) {
    constexpr double wider = 1.1;
    const double bound = calib::student_95(freedom);
    if (!(std > 0.0) || !(bound > wider * calib::normal_95)) return std::nullopt;
    return Interval95{value - bound * std, value + bound * std};
}

bool fits_a_rig_file(const Identified& identified) {
    return identified.fod || !identified.effects.empty() ||
           std::ranges::any_of(identified.values, &IdentifiedValue::in_rig_file);
}

std::string sides_of(const Contradiction& contradiction) {
    const auto side = [](const Contradiction::Side& of) {
        return fmt::format("{} says {}", of.recording, with_error(of.value, of.std));
    };
    return side(contradiction.low) + ", " + side(contradiction.high);
}

std::string describe(const Identified& identified) {
    std::size_t width = 0;
    for (const IdentifiedValue& value : identified.values) width = std::max(width, value.key.size());
    std::string text = fmt::format("{}, from {}\n", identified.part, fmt::join(identified.recordings, ", "));
    for (const IdentifiedValue& value : identified.values)
        text += fmt::format("  {:<{}}  {}\n", value.key, width, describe(value));
    for (const FitResidual& residual : identified.residuals)
        text += fmt::format("  residual: {}\n", describe(residual));
    for (const Contradiction& found : identified.contradictions)
        text += fmt::format("  the recordings contradict each other by {:.1f} standard errors: {}: {}\n",
                            found.standard_errors, found.key, sides_of(found));
    for (const std::string& note : identified.notes) text += fmt::format("  {}\n", note);
    for (const Undetermined& undetermined : identified.undetermined)
        text += fmt::format("  not determined: {}: {}\n", undetermined.key, undetermined.reason);
    return text;
}

void write_identification_json(const std::filesystem::path& file, const Identified& identified) {
    nlohmann::ordered_json json{{"format", "fidservo-identification/1"},
                                {"part", identified.part},
                                {"recordings", identified.recordings},
                                {"values", nlohmann::json::array()},
                                {"residuals", nlohmann::json::array()},
                                {"undetermined", nlohmann::json::array()},
                                {"contradictions", nlohmann::json::array()},
                                {"missing", nlohmann::json::array()},
                                {"missed_share", finite_or_null(identified.missed_share.value_or(NAN))},
                                {"effects", nlohmann::json::array()},
                                {"notes", identified.notes}};
    for (const IdentifiedValue& value : identified.values)
        json["values"].push_back({{"key", value.key},
                                  {"unit", value.unit},
                                  {"value", finite_or_null(value.value)},
                                  {"std", finite_or_null(value.std)},
                                  {"interval_95", interval_of(value)},
                                  {"systematic", value.systematic}});
    for (const FitResidual& residual : identified.residuals)
        json["residuals"].push_back({{"signal", residual.signal},
                                     {"unit", residual.unit},
                                     {"rms", finite_or_null(residual.rms)},
                                     {"floor", finite_or_null(residual.floor.value_or(NAN))}});
    for (const Undetermined& undetermined : identified.undetermined)
        json["undetermined"].push_back({{"key", undetermined.key}, {"reason", undetermined.reason}});
    for (const Contradiction& found : identified.contradictions)
        json["contradictions"].push_back({{"key", found.key},
                                          {"standard_errors", found.standard_errors},
                                          {"low", json_of(found.low)},
                                          {"high", json_of(found.high)}});
    for (const Missing& missing : identified.missing)
        json["missing"].push_back({{"depends_on", missing.depends_on}, {"share", missing.share}});
    for (const StatedEffect& effect : identified.effects) {
        nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
        for (const StatedEffect::Parameter& parameter : effect.parameters)
            parameters[parameter.name] = parameter.value;
        json["effects"].push_back({{"name", effect.name}, {"parameters", parameters}});
    }
    write_or_throw(file, json.dump(2) + '\n');
}

void write_identified_rig(const std::filesystem::path& file, const std::filesystem::path& source_rig_file,
                          const Identified& identified) {
    RigEdit edit(source_rig_file);
    RigProvenance provenance{identified.part, identified.recordings, {}, {}, {}};
    for (const Contradiction& found : identified.contradictions)
        provenance.contradictions.push_back(fmt::format("{}: {}", found.key, sides_of(found)));
    for (const IdentifiedValue& value : identified.values) {
        if (!value.in_rig_file) continue;
        edit.set(value.key, value.value);
        provenance.standard_errors.emplace_back(value.key, value.std);
    }
    for (const FitResidual& residual : identified.residuals)
        provenance.residuals.emplace_back(fmt::format("{}_{}", residual.signal, residual.unit), residual.rms);
    for (const StatedEffect& effect : identified.effects) edit.state_effect(effect);
    if (identified.fod) edit.set_fod(identified.fod);
    edit.set_provenance(provenance);
    edit.save(file);
}

}  // namespace fidservo

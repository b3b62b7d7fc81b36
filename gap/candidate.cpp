#include "gap/candidate.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fidservo::gap {
namespace {

/// Both move the wire's temperature against the table by a constant.
constexpr std::string_view temperature_class = "ambient_temperature";

/// The plainer effect is the richer one where bristles are stiff, the patch is long, friction does not depend
/// on speed or direction, the harness's spring is long.
struct Limit {
    std::string_view richer, plainer;
    /// The plainer effect's size.
    double (*size)(std::span<const double> richer, double middle_mm);
};

double level(std::span<const double> values, double /*middle_mm*/) {
    return values[0];
}
double mean_of_directions(std::span<const double> values, double /*middle_mm*/) {
    return 0.5 * (values[0] + values[1]);
}
double pull_in_the_middle(std::span<const double> values, double middle_mm) {
    return values[0] * (values[1] - middle_mm);
}

constexpr std::array limits{Limit{"presliding", "coulomb_friction", level},
                            Limit{"stribeck_friction", "coulomb_friction", level},
                            Limit{"rail_patch", "coulomb_friction", level},
                            Limit{"friction_asymmetry", "viscous_friction", mean_of_directions},
                            Limit{"cable_force", "drive_offset", pull_in_the_middle}};

const Limit* find_limit(std::string_view plainer, std::string_view richer) {
    const auto* const found = std::ranges::find_if(
        limits, [&](const Limit& limit) { return limit.plainer == plainer && limit.richer == richer; });
    return found == limits.end() ? nullptr : found;
}

/// A typical size; where the catalogue has none but the image's looks grow with the parameter, a quarter of
/// the largest.
double typical_of(const plant::Effect& effect, const plant::EffectParameter& parameter) {
    const bool is_of_image = effect.block == "camera.image" && parameter.vanishing == parameter.typical;
    return is_of_image ? 0.25 * parameter.high : parameter.typical;
}

bool says_how_large(const plant::Effect& effect, const plant::EffectParameter& parameter) {
    return parameter.vanishing != typical_of(effect, parameter);
}

/// Where the carriage has been in all recordings, mm.
struct TravelledRange {
    double low_mm = 0.0, high_mm = 0.0;
};

TravelledRange travelled(const Evidence& evidence) {
    TravelledRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run)
        for (const float position_mm : evidence.course(run).position_mm) {
            if (std::isnan(position_mm)) continue;
            range.low_mm = std::min(range.low_mm, static_cast<double>(position_mm));
            range.high_mm = std::max(range.high_mm, static_cast<double>(position_mm));
        }
    return range.low_mm <= range.high_mm ? range : TravelledRange{};
}

/// Sizes of which errors are roughly multiples nearby. What a belt's stretch does grows with it only as long
/// as the carriage swings on it with about the same frequency; a false scale hides within the counts up to
/// where the carriage has gone too far for that.
std::vector<double> sizes_of(const plant::Effect& effect, const plant::EffectParameter& parameter) {
    const auto times = [&](double factor) {
        return parameter.vanishing + factor * (parameter.typical - parameter.vanishing);
    };
    if (parameter.unit == "um/V") return {times(4.0), times(16.0)};
    if (effect.block == "macro.encoder") return {times(1.0), times(0.1), times(-0.1)};
    return {typical_of(effect, parameter)};
}

/// Values from which a fit of a shape may begin.
std::vector<double> grid_of(const plant::EffectParameter& parameter, const TravelledRange& range) {
    const auto within = [&](double value) { return std::clamp(value, parameter.low, parameter.high); };
    std::vector<double> grid;
    if (parameter.is_choice) {
        grid = {parameter.vanishing, parameter.is_high(parameter.vanishing) ? parameter.low : parameter.high};
    } else if (parameter.unit == "Hz") {
        constexpr double ratio = 1.15;  // of neighbours: half the width of a resonance of damping ratio 0.07
        for (double value = parameter.low; value < parameter.high; value *= ratio) grid.push_back(value);
    } else if (parameter.unit == "mm" && parameter.low < 0.0) {
        constexpr int places = 12;
        for (int k = 0; k < places; ++k)
            grid.push_back(within(range.low_mm + (range.high_mm - range.low_mm) * (k + 0.5) / places));
    } else if (parameter.low > 0.0 && parameter.high >= 5000.0 * parameter.low) {
        for (const double factor : {0.2, 1.0, 5.0}) grid.push_back(within(factor * parameter.typical));
    } else if (parameter.low > 0.0 && parameter.high >= 20.0 * parameter.low) {
        for (const double factor : {0.4, 2.0}) grid.push_back(within(factor * parameter.typical));
    } else if (parameter.unit == "1/s") {  // what settles within a run, as a rule, or never
        grid = {parameter.vanishing, parameter.vanishing + 10.0 * parameter.negligible};
    } else if (parameter.unit.empty() && parameter.low == 0.0 && parameter.negligible == 0.0 &&
               (parameter.typical == 1.0 || parameter.typical == 0.0)) {  // a share: all or nothing
        grid = {1.0, 0.0};
    } else {
        grid.push_back(parameter.typical);
    }
    grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
    return grid;
}

/// All combinations of the shapes' grids.
std::vector<std::vector<double>> shapes_of(const plant::Effect& effect, const TravelledRange& range,
                                           bool is_wave) {
    std::vector<std::vector<double>> shapes{{}};
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const plant::EffectParameter& parameter = effect.parameters[k];
        const std::vector<double> grid = is_wave                             ? std::vector{parameter.typical}
                                         : says_how_large(effect, parameter) ? sizes_of(effect, parameter)
                                                                             : grid_of(parameter, range);
        std::vector<std::vector<double>> longer;
        for (const std::vector<double>& shape : shapes)
            for (const double value : grid) {
                longer.push_back(shape);
                longer.back().push_back(value);
            }
        shapes = std::move(longer);
    }
    return shapes;
}

/// Whether its fits end in many small valleys, a count apart at the end of the way.
bool hides_within_counts(const plant::Effect& effect) {
    return effect.block == "macro.encoder" && unrefined_parameters(effect) == 1;
}

bool is_in(std::span<const std::string> list, std::string_view name) {
    return std::ranges::find(list, name) != list.end();
}

}  // namespace

bool is_of_wire(const Candidate& candidate) {
    return candidate.effect->block == "micro.heater" || candidate.effect->block == "micro.hysteresis";
}

std::string_view class_of(std::string_view effect) {
    return effect == "stress_shift" ? temperature_class : effect;
}

bool is_limit_of(std::string_view plainer, std::string_view richer) {
    return find_limit(plainer, richer) != nullptr;
}

plant::EffectSetting plain_form(const plant::EffectSetting& richer, const plant::Effect& plainer,
                                const MacroParameters& rail) {
    const double middle_mm = 0.5 * (rail.low_mm + rail.high_mm);
    plant::EffectSetting setting = plant::vanishing_setting(plainer);
    const plant::EffectParameter& size = plainer.parameters.front();
    setting.values.front() = std::clamp(
        find_limit(plainer.name, richer.effect->name)->size(richer.values, middle_mm), size.low, size.high);
    return setting;
}

std::vector<plant::EffectSetting> rich_forms(const plant::EffectSetting& plain, const Candidate& richer) {
    constexpr std::size_t many = 6;
    const Limit* const limit = find_limit(plain.effect->name, richer.effect->name);
    if (limit == nullptr || limit->size != level || richer.shapes.size() > many) return {};
    std::vector<plant::EffectSetting> forms;
    for (const std::vector<double>& shape : richer.shapes) {
        plant::EffectSetting form{richer.effect, shape};
        form.values.front() = plain.values.front();
        for (std::size_t k = 1; k < shape.size(); ++k) {
            const auto& shared = plain.effect->parameters;
            const auto same =
                std::ranges::find(shared, richer.effect->parameters[k].name, &plant::EffectParameter::name);
            if (same != shared.end())
                form.values[k] = plain.values[static_cast<std::size_t>(same - shared.begin())];
        }
        if (std::ranges::find(forms, form.values, &plant::EffectSetting::values) == forms.end())
            forms.push_back(std::move(form));
    }
    return forms;
}

std::vector<Refinement> refinements_of(const plant::Effect& effect) {
    constexpr double hardly_seen = 2.0, seen = 4.0, in_any_motion = 16.0;
    std::vector<Refinement> found;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const plant::EffectParameter& parameter = effect.parameters[k];
        if (parameter.negligible <= 0.0) continue;
        const double least = parameter.negligible, none = parameter.vanishing;
        std::vector<double> values{none + hardly_seen * least, none + seen * least,
                                   none + in_any_motion * least};
        if (parameter.low < none)
            values = {none - in_any_motion * least, none + in_any_motion * least};
        else if (none > 0.0)
            values = {0.5 * (none + parameter.high)};
        found.push_back({parameter.name, k, std::move(values)});
    }
    return found;
}

std::size_t unrefined_parameters(const plant::Effect& effect) {
    const auto choices = std::ranges::count_if(effect.parameters, &plant::EffectParameter::is_choice);
    return effect.parameters.size() - refinements_of(effect).size() - static_cast<std::size_t>(choices);
}

bool knows_places(const Evidence& evidence) {
    return std::ranges::all_of(evidence.windows(), [&](const Window& window) {
        return window.signal != Signal::encoder || evidence.knows_places(window.run);
    });
}

std::vector<Candidate> candidates(const Evidence& evidence, std::span<const std::string> only,
                                  std::span<const std::string> without) {
    std::array<bool, signal_count> recorded{};
    for (const Window& window : evidence.windows()) recorded[index_of(window.signal)] = true;
    const auto is_withheld = [&](std::string_view name) {
        return std::ranges::any_of(
            without, [&](const std::string& other) { return class_of(other) == class_of(name); });
    };
    const bool places_are_known = knows_places(evidence);
    const auto is_left_out = [&](std::string_view name) {
        if (plant::find_effect(name)->needs_place && !places_are_known) return true;
        return is_withheld(name) || (!only.empty() && !is_in(only, name));
    };
    const auto is_limit = [&](std::string_view name) {
        return std::ranges::any_of(
            limits, [&](const Limit& limit) { return limit.plainer == name && !is_left_out(limit.richer); });
    };
    const TravelledRange range = travelled(evidence);
    const double farthest_mm = std::max(std::abs(range.low_mm), std::abs(range.high_mm));
    const double quarter_count =
        0.25 * evidence.rig().macro.encoder_resolution_mm / std::max(1.0, farthest_mm);
    std::vector<Candidate> found;
    for (const plant::Effect* effect : plant::effect_catalogue()) {
        if (effect->block == "camera.image" && !recorded[index_of(Signal::image)]) continue;
        if (effect->block.starts_with("micro.") && !evidence.rig().micro) continue;
        const bool left_out = is_left_out(effect->name);
        if (left_out && !is_limit(effect->name)) continue;
        if (std::ranges::none_of(reach_of(*effect), [&](Signal s) { return recorded[index_of(s)]; }))
            continue;
        Candidate candidate{.effect = effect,
                            .sizes = {},
                            .shapes = {},
                            .wave = wave_of(*effect),
                            .patch = patch_of(*effect),
                            .step_within_counts = hides_within_counts(*effect) ? quarter_count : 0.0,
                            .class_name = std::string(class_of(effect->name)),
                            .is_limit = left_out};
        candidate.shapes = shapes_of(*effect, range, candidate.wave.has_value());
        for (std::size_t k = 0; k < effect->parameters.size(); ++k)
            if (says_how_large(*effect, effect->parameters[k])) candidate.sizes.push_back(k);
        found.push_back(std::move(candidate));
    }
    return found;
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/candidates/candidate.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fidservo::gap {
namespace {

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

/// Values from which a fit of a parameter may begin.
std::vector<double> grid_of(const plant::EffectParameter& parameter, const TravelledRange& range) {
    if (parameter.is_choice())
        return {parameter.vanishing, parameter.is_high(parameter.vanishing) ? parameter.low : parameter.high};
    if (!parameter.starts.empty()) return {parameter.starts.begin(), parameter.starts.end()};
    if (parameter.is_size()) return {parameter.usual()};
    if (parameter.role != plant::Role::place) return {parameter.typical};
    constexpr int places = 12;
    std::vector<double> grid;
    grid.reserve(places);
    for (int k = 0; k < places; ++k)
        grid.push_back(std::clamp(range.low_mm + (range.high_mm - range.low_mm) * (k + 0.5) / places,
                                  parameter.low, parameter.high));
    grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
    return grid;
}

/// All combinations of the parameters' grids.
std::vector<std::vector<double>> shapes_of(const plant::Effect& effect, const TravelledRange& range) {
    std::vector<std::vector<double>> shapes{{}};
    for (const plant::EffectParameter& parameter : effect.parameters) {
        const std::vector<double> grid = grid_of(parameter, range);
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

/// Whether its fits end in many small valleys, a count apart at the end of the way: a false scale of the
/// encoder.
bool hides_within_counts(const plant::Effect& effect) {
    return effect.part == plant::Part::encoder && !wave_of(effect);
}

bool is_in(std::span<const std::string> list, std::string_view name) {
    return std::ranges::find(list, name) != list.end();
}

}  // namespace

std::string_view class_of(std::string_view effect) {
    const plant::Effect* const known = plant::find_effect(effect);
    return known != nullptr && known->same_as != nullptr ? known->same_as->name : effect;
}

bool is_limit_of(const plant::Effect& plainer, const plant::Effect& richer) {
    return richer.plainer.effect == &plainer;
}

plant::EffectSetting plain_form(const plant::EffectSetting& richer, const MacroParameters& rail) {
    const double middle_mm = 0.5 * (rail.low_mm + rail.high_mm);
    const auto& [plainer, size_of] = richer.effect->plainer;
    plant::EffectSetting setting = plant::vanishing_setting(*plainer);
    const plant::EffectParameter& size = plainer->parameters.front();
    const double value = size_of != nullptr ? size_of(richer.values, middle_mm) : richer.values.front();
    setting.values.front() = std::clamp(value, size.low, size.high);
    return setting;
}

std::vector<plant::EffectSetting> rich_forms(const plant::EffectSetting& plain, const Candidate& richer) {
    constexpr std::size_t many = 6;
    if (!is_limit_of(*plain.effect, *richer.effect) || richer.effect->plainer.size != nullptr ||
        richer.shapes.size() > many)
        return {};
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
        if (parameter.role != plant::Role::optional) continue;
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

std::vector<plant::EffectSetting> settings_within_counts(const Candidate& candidate) {
    constexpr int most_steps = 16;
    if (candidate.step_within_counts == 0.0) return {};
    const std::size_t size = candidate.sizes.front();
    std::vector<plant::EffectSetting> settings;
    settings.reserve(2 * most_steps);
    for (int k = -most_steps; k <= most_steps; ++k) {
        if (k == 0) continue;
        settings.push_back({candidate.effect, candidate.shapes.front()});
        settings.back().values[size] =
            candidate.effect->parameters[size].vanishing + k * candidate.step_within_counts;
    }
    return settings;
}

std::size_t unrefined_parameters(const plant::Effect& effect) {
    const auto is_asked_first = [](const plant::EffectParameter& parameter) {
        return parameter.role != plant::Role::optional && !parameter.is_choice();
    };
    return static_cast<std::size_t>(std::ranges::count_if(effect.parameters, is_asked_first));
}

bool knows_places(const Evidence& evidence) {
    return std::ranges::all_of(evidence.windows(), [&](const Window& window) {
        return window.signal != Signal::encoder || evidence.knows_places(window.run);
    });
}

std::vector<Candidate> candidates(const Evidence& evidence, std::span<const std::string> only,
                                  std::span<const std::string> without,
                                  std::span<const plant::Effect* const> formulas) {
    std::array<bool, signal_count> recorded{};
    for (const Window& window : evidence.windows()) recorded[index_of(window.signal)] = true;
    const auto is_withheld = [&](std::string_view name) {
        return std::ranges::any_of(
            without, [&](const std::string& other) { return class_of(other) == class_of(name); });
    };
    const bool places_are_known = knows_places(evidence);
    const auto is_left_out = [&](const plant::Effect& effect) {
        if (effect.needs_place && !places_are_known) return true;
        return is_withheld(effect.name) || (!only.empty() && !is_in(only, effect.name));
    };
    const auto is_limit = [&](const plant::Effect& effect) {
        return std::ranges::any_of(plant::effect_catalogue(), [&](const plant::Effect* richer) {
            return is_limit_of(effect, *richer) && !is_left_out(*richer);
        });
    };
    const TravelledRange range = travelled(evidence);
    const double farthest_mm = std::max(std::abs(range.low_mm), std::abs(range.high_mm));
    constexpr double probed_count = 0.25;
    const double quarter_count =
        probed_count * evidence.rig().macro.encoder_resolution_mm / std::max(1.0, farthest_mm);
    std::vector<Candidate> found;
    const auto listed = plant::effect_catalogue();
    std::vector<const plant::Effect*> known(listed.begin(), listed.end());
    known.insert(known.end(), formulas.begin(), formulas.end());
    for (const StatedEffect& stated : evidence.rig().effects)
        if (stated.formula) known.push_back(&plant::refit_of(stated));
    for (const plant::Effect* effect : known) {
        if (plant::is_of_frames(effect->part) && !recorded[index_of(Signal::image)]) continue;
        if (plant::is_of_platform(effect->part) && !evidence.rig().micro) continue;
        const bool left_out = is_left_out(*effect);
        if (left_out && !is_limit(*effect)) continue;
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
        candidate.shapes = shapes_of(*effect, range);
        for (std::size_t k = 0; k < effect->parameters.size(); ++k)
            if (effect->parameters[k].is_size()) candidate.sizes.push_back(k);
        found.push_back(std::move(candidate));
    }
    return found;
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/planned_experiments.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/effects_file.h"
#include "src/simulation/experiment_file.h"

#include <algorithm>
#include <utility>

namespace fidservo {

PlannedExperiment planned_experiment(const std::string& asked, const Rig& rig, std::uint64_t seed) {
    if (is_experiment_file(asked)) {
        Experiment experiment = load_experiment(asked, rig);
        return {experiment.kind + "-1", std::move(experiment)};
    }
    const std::string name = asked + "-1";
    return {name, make_experiment(asked, rig, seed, name)};
}

std::vector<PlannedExperiment> planned_campaign(const Rig& rig, std::uint64_t seed) {
    std::vector<PlannedExperiment> all;
    for (const CampaignRun& run : campaign_runs(rig))
        all.push_back({run.name, make_experiment(run.kind, rig, seed, run.name)});
    return all;
}

std::vector<plant::EffectSetting> effects_of(const std::vector<std::string>& texts,
                                             const std::filesystem::path& effects_file) {
    std::vector<const plant::Effect*> formulas;
    if (!effects_file.empty()) formulas = load_effects_file(effects_file);
    std::vector<plant::EffectSetting> effects;
    effects.reserve(texts.size());
    for (const std::string& text : texts) effects.push_back(plant::parse_effect(text, formulas));
    const auto is_named = [&](const plant::Effect* formula) {
        return std::ranges::find(effects, formula, &plant::EffectSetting::effect) != effects.end();
    };
    if (std::ranges::none_of(formulas, is_named))
        for (const plant::Effect* formula : formulas) effects.push_back(plant::typical_setting(*formula));
    return effects;
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/cured_rig.h"

#include "core/median.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/rig_edit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace fidservo::fleet {
namespace {

/// A parameter's values wherever an effect is named with a probability of a half or more; that without a
/// value are of its usual one.
std::vector<double> values_in_names(const std::vector<FleetResult>& results, std::string_view effect,
                                    const plant::EffectParameter& parameter) {
    constexpr double credible = 0.5;
    std::vector<double> values;
    for (const FleetResult& result : results)
        for (const NamedEffect& named : result.effects) {
            if (named.effect != effect || named.probability < credible) continue;
            const auto stated = std::ranges::find(named.parameters, parameter.name, &NamedParameter::name);
            values.push_back(stated != named.parameters.end() ? stated->value : parameter.vanishing);
        }
    return values;
}

/// The median, if nine in ten values are within a twentieth of the range about it; else nobody agrees.
std::optional<double> agreed(const std::vector<double>& values, const plant::EffectParameter& parameter) {
    constexpr double share = 0.9, apart = 0.05;
    if (values.empty()) return {};
    const double median = median_of(values);
    const double most = apart * std::max(std::abs(median), 0.1 * (parameter.high - parameter.low));
    const auto near =
        std::ranges::count_if(values, [&](double value) { return std::abs(value - median) <= most; });
    return static_cast<double>(near) >= share * static_cast<double>(values.size()) ? std::optional(median)
                                                                                   : std::nullopt;
}

/// Adds those parameters that are no sizes.
/// @return whether diagnoses agree on them
bool add_agreed(const std::vector<FleetResult>& results, StatedEffect& cure) {
    const plant::Effect* const effect = plant::find_effect(cure.name);
    if (effect == nullptr) return false;
    for (const plant::EffectParameter& parameter : effect->parameters) {
        const std::string name(parameter.name);
        if (parameter.is_size() ||
            std::ranges::find(cure.parameters, name, &StatedEffect::Parameter::name) != cure.parameters.end())
            continue;
        const auto value = agreed(values_in_names(results, cure.name, parameter), parameter);
        if (!value) return false;
        if (*value != parameter.vanishing) cure.parameters.push_back({name, *value});
    }
    return true;
}

}  // namespace

CuredRig write_cured_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                         const std::vector<FleetResult>& results, const FleetFindings& findings) {
    std::vector<StatedEffect> cures;
    for (const Judgement& judgement : findings.judgements) {
        if (judgement.whose != Whose::all || judgement.matter != Matter::deviation) continue;
        const Quantity& quantity = findings.quantities[judgement.quantity].quantity;
        auto cure = std::ranges::find(cures, quantity.effect, &StatedEffect::name);
        if (cure == cures.end()) cure = cures.insert(cures.end(), StatedEffect{quantity.effect, {}});
        cure->parameters.push_back({quantity.parameter, quantity.in_units(judgement.size.value)});
    }
    CuredRig cured;
    std::erase_if(cures, [&](StatedEffect& cure) {
        if (add_agreed(results, cure)) return false;
        cured.left_out.push_back(cure.name);
        return true;
    });
    RigEdit edit(source);
    std::filesystem::remove(file);
    if (cures.empty()) return cured;
    for (const StatedEffect& cure : cures) edit.add_effect(cure);
    edit.save(file);
    cured.is_written = true;
    return cured;
}

}  // namespace fidservo::fleet

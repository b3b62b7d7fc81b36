// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/candidates/scaled_parameters.h"

#include "gap/candidates/coupling.h"
#include "gap/candidates/wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::gap {
namespace {

double scale_of(const plant::EffectSetting& setting, std::size_t which) {
    constexpr double share_of_value = 0.2, share_of_range = 0.05;
    const plant::EffectParameter& parameter = setting.effect->parameters[which];
    if (const auto wave = wave_of(*setting.effect); wave && wave->period == which) {
        const double period_mm = std::max(setting.values[which], parameter.low);
        return period_mm * period_mm / (2.0 * std::numbers::pi * rail_middle_mm);
    }
    if (parameter.is_size()) return std::abs(parameter.usual() - parameter.vanishing);
    if (parameter.role == plant::Role::phase || parameter.typical == 0.0 || parameter.low < 0.0)
        return share_of_range * (parameter.high - parameter.low);
    return share_of_value * std::abs(parameter.typical);
}

}  // namespace

ScaledParameters::ScaledParameters(const Hypothesis& start) : hypothesis_(start) {
    for (const plant::EffectSetting& setting : start)
        for (std::size_t k = 0; k < setting.values.size(); ++k) {
            all_.push_back(&setting.effect->parameters[k]);
            scales_.push_back(scale_of(setting, k));
            values.push_back(setting.values[k] / scales_.back());
            moves_carriage_.push_back(gap::moves_carriage(*setting.effect));
        }
}

Hypothesis ScaledParameters::at(std::span<const double> scaled) const {
    Hypothesis changed = hypothesis_;
    std::size_t k = 0;
    for (plant::EffectSetting& setting : changed)
        for (double& value : setting.values) {
            value = std::clamp(scaled[k] * scale(k), all_[k]->low, all_[k]->high);
            ++k;
        }
    return changed;
}

}  // namespace fidservo::gap

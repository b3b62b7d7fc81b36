// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/accused.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fidservo::gap {

void accuse(std::vector<BlockProbability>& where, const std::string& block, double probability) {
    const auto known = std::ranges::find(where, block, &BlockProbability::block);
    if (known != where.end())
        known->probability = 1.0 - (1.0 - known->probability) * (1.0 - probability);
    else
        where.push_back({block, probability});
    constexpr double steps = 20.0;  // of probability; within one the order stays
    std::ranges::stable_sort(where, std::greater{}, [](const BlockProbability& accused) {
        return std::lround(steps * accused.probability);
    });
}

double mean_probability(const std::vector<FoundEffect>& effects) {
    double sum = 0.0;
    for (const FoundEffect& effect : effects) sum += effect.probability;
    return effects.empty() ? 0.0 : sum / static_cast<double>(effects.size());
}

bool are_credible(const std::vector<FoundEffect>& effects) {
    return mean_probability(effects) > 0.5;
}

}  // namespace fidservo::gap

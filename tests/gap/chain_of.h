// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A chain with effects of given values.
#include "gap/search/chain.h"

#include <algorithm>
#include <vector>

namespace fidservo::testing {

/// A chain with these effects, judged with these values on both halves.
inline gap::Chain chain_of(const gap::Search& search, const std::vector<gap::Candidate>& candidates,
                           const gap::Hypothesis& settings) {
    gap::Chain chain;
    for (const plant::EffectSetting& setting : settings)
        chain.choices.push_back({&*std::ranges::find(candidates, setting.effect, &gap::Candidate::effect)});
    chain.fitted.of_half = {settings, settings};
    search.judge(chain.fitted);
    return chain;
}

}  // namespace fidservo::testing

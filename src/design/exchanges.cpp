// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/exchanges.h"

#include <algorithm>
#include <utility>

namespace fidservo::design {

std::vector<Exchange> exchanges(const gap::Diagnosis& diagnosis) {
    std::vector<Exchange> all;
    for (std::size_t k = 0; k < diagnosis.effects.size(); ++k)
        for (const plant::EffectSetting& rival : diagnosis.effects[k].rivals) {
            const bool is_found =
                std::ranges::find(diagnosis.hypothesis, rival.effect, &plant::EffectSetting::effect) !=
                diagnosis.hypothesis.end();
            if (is_found) continue;
            gap::Hypothesis exchanged = diagnosis.hypothesis;
            exchanged[k] = rival;
            all.push_back({k, rival.effect, std::move(exchanged)});
        }
    return all;
}

}  // namespace fidservo::design

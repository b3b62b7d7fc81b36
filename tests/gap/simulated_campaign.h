// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "gap/evidence.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"
#include "tests/gap/effects.h"
#include "tests/reference_rig.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fidservo::testing {

/// The recordings of a rig with effects, two of each experiment.
inline std::vector<Recording> recordings_of(const gap::Hypothesis& truth,
                                            std::initializer_list<std::string_view> kinds,
                                            const Rig& true_rig = reference_rig()) {
    std::vector<Recording> recordings;
    for (const std::string_view kind : kinds)
        for (const std::uint64_t seed : {21, 22}) {
            const std::string name = std::string(kind) + "-" + std::to_string(seed);
            recordings.push_back(
                simulate(true_rig, truth, make_experiment(kind, true_rig, seed, name), name, seed));
        }
    return recordings;
}

/// Those recordings, with the reference rig's file.
inline gap::Evidence campaign(const gap::Hypothesis& truth, std::initializer_list<std::string_view> kinds,
                              const Rig& true_rig = reference_rig()) {
    return {reference_rig(), recordings_of(truth, kinds, true_rig)};
}

}  // namespace fidservo::testing

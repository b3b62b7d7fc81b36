// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/rig/abilities.h"

#include "core/rig.h"
#include "src/record/foresight.h"
#include "src/simulation/experiments.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// What a session of motions needs: positioner_params (src/session/motion_params.h), and tags to find the
/// way.
std::vector<std::string> missing_for_motion(const Rig& rig, bool is_plate_elsewhere) {
    std::vector<std::string> missing;
    if (!rig.micro) missing.emplace_back("micro");
    if (!rig.camera) missing.emplace_back("camera");
    if (!rig.macro.pd) missing.emplace_back("macro.pd");
    if (rig.micro && !rig.micro->pi) missing.emplace_back("micro.pi");
    if (!rig.fiducials && !is_plate_elsewhere) missing.emplace_back("fiducials");
    return missing;
}

/// Why `record` would refuse an experiment of a kind, by simulation; empty if it would not.
std::string why_not_recorded(const Rig& rig, std::string_view kind) {
    constexpr std::uint64_t seed = 1;
    return draw_for(rig, kind, seed, fmt::format("{}-1", kind), std::nullopt).why_not.value_or("");
}

std::string listed(const std::vector<std::string>& keys) {
    return fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace

std::vector<Ability> abilities_of(const Rig& rig, bool has_board) {
    const std::vector<std::string> for_motion = missing_for_motion(rig, false);
    const std::string motion = listed(for_motion);
    const std::string micro = rig.micro ? "" : "micro";
    std::vector<Ability> abilities{{"inspect", listed(missing_for_motion(rig, true)), {}},
                                   {"goto", motion, {}},
                                   {"home", motion, {}},
                                   {"record, at rest", motion, {}}};
    for (const std::string_view kind : experiment_kinds()) {
        std::vector<std::string> missing = for_motion;
        if (std::string key = missing_for(kind, rig); !key.empty() && std::ranges::count(missing, key) == 0)
            missing.push_back(std::move(key));
        Ability ability{fmt::format("record {}", kind), listed(missing), {}};
        if (missing.empty()) ability.reason = why_not_recorded(rig, kind);
        abilities.push_back(std::move(ability));
    }
    for (const std::string_view kind : experiment_kinds())
        abilities.push_back({fmt::format("simulate {}", kind), missing_for(kind, rig), {}});
    abilities.insert(abilities.end(), {{"calibrate stage", motion, {}},
                                       {"calibrate camera", "", {}},
                                       {"calibrate hall", micro, {}},
                                       {"identify macro", "", {}},
                                       {"identify hysteresis", micro, {}},
                                       {"identify heater", micro, {}},
                                       {"replay", "", {}},
                                       {"diagnose", "", {}},
                                       {"--stage comedi:NODE", has_board ? "" : "stage.comedi", {}}});
    return abilities;
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/wire_path.h"

#include "core/demand.h"
#include "core/preisach.h"
#include "core/rig.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {

std::vector<float> wire_path_mm(const Evidence& evidence, std::size_t run) {
    FIDSERVO_DEMAND(evidence.rig().micro.has_value());
    const FodTable& table = *evidence.rig().micro->fod;
    std::vector<float> values = evidence.course(run).temperature_degC;
    const auto known = std::ranges::find_if(values, [](float value) { return std::isfinite(value); });
    if (known == values.end()) return std::vector<float>(values.size(), 0.0F);
    PreisachMemory wire = preisach_start(table, static_cast<double>(*known));
    for (float& value : values) {
        if (std::isfinite(value)) preisach_step(table, wire, static_cast<double>(value));
        value = static_cast<float>(wire.contraction_mm);
    }
    return values;
}

std::vector<float> behind_play(std::vector<float> path_mm, double width_mm) {
    if (path_mm.empty()) return path_mm;
    const auto half_mm = static_cast<float>(0.5 * width_mm);
    float place_mm = path_mm.front();
    for (float& value : path_mm) {
        place_mm = std::clamp(place_mm, value - half_mm, value + half_mm);
        value = place_mm;
    }
    return path_mm;
}

}  // namespace fidservo::gap

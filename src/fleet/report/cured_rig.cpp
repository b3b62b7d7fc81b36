// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/cured_rig.h"

#include "core/rig.h"
#include "src/files/rig/rig_edit.h"

#include <algorithm>
#include <vector>

namespace fidservo::fleet {

bool write_cured_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                     const FleetFindings& findings) {
    std::vector<StatedEffect> cures;
    for (const Judgement& judgement : findings.judgements) {
        if (judgement.whose != Whose::all || judgement.matter != Matter::deviation) continue;
        const Quantity& quantity = findings.quantities[judgement.quantity].quantity;
        auto cure = std::ranges::find(cures, quantity.effect, &StatedEffect::name);
        if (cure == cures.end()) cure = cures.insert(cures.end(), StatedEffect{quantity.effect, {}});
        cure->parameters.push_back({quantity.parameter, quantity.in_units(judgement.size.value)});
    }
    if (cures.empty()) return false;
    RigEdit edit(source);
    for (const StatedEffect& cure : cures) edit.add_effect(cure);
    std::filesystem::remove(file);
    edit.save(file);
    return true;
}

}  // namespace fidservo::fleet

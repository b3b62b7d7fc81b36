#pragma once
#include "plant/effects/catalogue.h"
#include "tests/plant/reference_rig.h"

#include <string_view>

namespace fidservo::plant {

/// The reference rig with one effect, as --effect would state it.
inline StagePlant plant_with(std::string_view effect) {
    const EffectSetting setting = parse_effect(effect);
    return make_stage_plant(reference_rig(), {&setting, 1});
}

}  // namespace fidservo::plant

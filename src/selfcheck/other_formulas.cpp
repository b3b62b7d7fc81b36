#include "src/selfcheck/other_formulas.h"

#include "gap/candidate.h"

#include <array>

namespace fidservo::selfcheck {
namespace {

using reference::Departures;

void lens_division(Departures& rig, double size, NoiseStream& draw) {
    rig.camera.division = random_sign(draw) * size;
}

constexpr std::array others{
    EffectDraw{"lens_distortion", "division", 3.4e-2, 1.5, lens_division},
};

}  // namespace

std::span<const EffectDraw> other_formulas() {
    return others;
}

std::vector<const EffectDraw*> other_formulas_of(std::string_view class_name) {
    std::vector<const EffectDraw*> found;
    for (const EffectDraw& way : others)
        if (gap::class_of(way.effect) == class_name) found.push_back(&way);
    return found;
}

}  // namespace fidservo::selfcheck

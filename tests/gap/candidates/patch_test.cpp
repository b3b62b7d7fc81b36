// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects of the catalogue are friction around a place.
#include "gap/candidates/patch.h"

#include "plant/effects/catalogue.h"

#include <string_view>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

TEST(Patch, OfTheCatalogue_OnlyTheRailPatchIsOne) {
    for (const plant::Effect* effect : plant::effect_catalogue())
        EXPECT_EQ(patch_of(*effect).has_value(), effect->name == std::string_view("rail_patch"))
            << effect->name;
}

TEST(Patch, ItsParametersAreLevelPlaceAndWidth) {
    const plant::Effect& effect = *plant::parse_effect("rail_patch").effect;
    const auto patch = patch_of(effect);
    ASSERT_TRUE(patch.has_value());
    EXPECT_EQ(effect.parameters[patch->level].unit, "V");
    EXPECT_EQ(effect.parameters[patch->centre].unit, "mm");
    EXPECT_EQ(effect.parameters[patch->width].unit, "mm");
    EXPECT_NE(patch->centre, patch->width);
}

}  // namespace
}  // namespace fidservo

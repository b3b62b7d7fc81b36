// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "tests/plant/reference_rig.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(ParseEffect, NameAlone_TakesTypicalValues) {
    const EffectSetting setting = parse_effect("airflow");
    EXPECT_EQ(setting.effect->name, "airflow");
    EXPECT_THAT(setting.values, ElementsAre(setting.effect->parameters[0].typical));
}

TEST(ParseEffect, NamedParameter_TakesItsValue) {
    EXPECT_THAT(parse_effect("airflow:factor=0.85").values, ElementsAre(0.85));
    EXPECT_THAT(parse_effect("drive_offset:offset_V=-1e-1").values, ElementsAre(-0.1));
}

TEST(ParseEffect, Mistakes_AreOneLineThatNamesThemAndWhatIsAllowed) {
    const std::vector<std::pair<const char*, const char*>> mistakes{
        {"", "no such effect; known: drive_gain"},
        {"airflo", "no such effect; known: drive_gain"},
        {"airflow:", "PARAMETER=VALUE is missing"},
        {"airflow:factor=0.5,", "PARAMETER=VALUE is missing"},
        {"airflow:factor", "is not PARAMETER=VALUE"},
        {"airflow:faktor=0.5", "\"faktor\" is no parameter of airflow; allowed: factor = 0.2 .. 3"},
        {"airflow:factor=", "\"\" is not a number"},
        {"airflow:factor=half", "\"half\" is not a number"},
        {"airflow:factor=0.5x", "\"0.5x\" is not a number"},
        {"airflow:factor=nan", "\"nan\" is not a number"},
        {"airflow:factor=inf", "\"inf\" is not a number"},
        {"airflow:factor=7", "7 is out of bounds; allowed: 0.2 .. 3 (1: no effect)"},
        {"airflow:factor=0.5,factor=0.6", "factor is given twice"},
    };
    for (const auto& [text, message] : mistakes) {
        SCOPED_TRACE(text);
        try {
            parse_effect(text);
            ADD_FAILURE() << "must throw";
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(message));
            EXPECT_THAT(error.what(), HasSubstr("--effect: " + std::string(text)));
            EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
        }
    }
}

TEST(StatedEffect, InTheRigFile_IsInThePlant) {
    Rig rig = reference_rig();
    const double nominal = plant_parameters(rig).axis.drive_gain;
    rig.effects = {{"drive_gain", {{"factor", 1.07}}}};
    EXPECT_DOUBLE_EQ(plant_parameters(rig).axis.drive_gain, 1.07 * nominal);
    rig.effects[0].parameters[0].value = 1.0;
    EXPECT_EQ(plant_parameters(rig).axis.drive_gain, nominal);
}

}  // namespace
}  // namespace fidservo::plant

// SPDX-License-Identifier: GPL-3.0-or-later
// What rig check finds: nothing in a sound rig, and each mistake by its key.
#include "core/input_error.h"
#include "core/preisach.h"
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/rig/abilities.h"
#include "src/rig/finding.h"
#include "src/session/motion_params.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

std::vector<std::string> keys_of(const Rig& rig) {
    std::vector<std::string> keys;
    for (const Finding& finding : findings_of(rig)) keys.push_back(finding.key);
    return keys;
}

TEST(RigFindings, ReferenceRig_HasNone) {
    for (const Finding& finding : findings_of(reference_rig()))
        ADD_FAILURE() << finding.key << ": " << finding.value << ": " << finding.why;
}

struct Mistake {
    const char* key;
    std::function<void(Rig&)> make;
};

TEST(RigFindings, OneMistake_IsNamedByItsKeyAndNothingElseIs) {
    const Mistake mistakes[] = {
        {"tick_s",
         [](Rig& rig) {
             rig.tick_s = 0.05;
             rig.macro.velocity_pole = 0.2;
             rig.macro.pd.reset();
             rig.macro.pid.reset();
             rig.micro->pi.reset();
         }},
        {"macro.velocity_pole",
         [](Rig& rig) {
             rig.macro.velocity_pole = 1.0 - 1e-8;
             rig.macro.pd.reset();
             rig.macro.pid.reset();
         }},
        {"macro.velocity_pole",
         [](Rig& rig) {
             rig.macro.velocity_pole = 1e-4;
             rig.macro.pd.reset();
             rig.macro.pid.reset();
         }},
        {"macro.velocity_gain_mm_per_s_per_V",
         [](Rig& rig) {
             rig.macro.velocity_gain_mm_per_s_per_V *= 1000.0;
             rig.macro.pd.reset();
             rig.macro.pid.reset();
         }},
        {"macro.velocity_gain_mm_per_s_per_V",
         [](Rig& rig) {
             rig.macro.velocity_gain_mm_per_s_per_V *= 1e-3;
             rig.macro.pd.reset();
             rig.macro.pid.reset();
         }},
        {"macro.velocity_gain_mm_per_s_per_V",
         [](Rig& rig) {
             rig.macro.velocity_gain_mm_per_s_per_V *= 1e-5;
             rig.macro.pd.reset();
             rig.macro.pid.reset();
         }},
        {"macro.encoder_resolution_mm",
         [](Rig& rig) {
             rig.macro.encoder_resolution_mm = 2.5;
             rig.micro.reset();
             rig.macro.pd.reset();
             rig.macro.pid.reset();
             rig.camera.reset();
         }},
        {"macro.pd",
         [](Rig& rig) {
             rig.macro.pd->e1_V_per_count *= -1.0;
             rig.macro.pd->e0_V_per_count *= -1.0;
         }},
        {"macro.pd",
         [](Rig& rig) {
             rig.macro.pd->e0_V_per_count *= 1e4;
             rig.macro.pd->e1_V_per_count *= 1e4;
         }},
        {"macro.pd", [](Rig& rig) { rig.macro.pd->e1_V_per_count = -rig.macro.pd->e0_V_per_count; }},
        {"macro.pd.friction_V", [](Rig& rig) { rig.macro.pd->friction_V = 0.3; }},
        {"macro.pid", [](Rig& rig) { rig.macro.pid->ki_V_per_count_s *= 1000.0; }},
        {"micro.travel_mm",
         [](Rig& rig) {
             rig.micro->low_mm = 1.5;
             rig.micro->high_mm = 2.5;
             rig.micro->fod =
                 std::make_shared<const FodTable>(std::vector{10.0, 120.0}, std::vector{0.0, 0.0, 1.0});
         }},
        {"micro.heater.heating_tau_s", [](Rig& rig) { rig.micro->heater.heating_tau_s = 550.0; }},
        {"micro.heater.cooling_tau_s",
         [](Rig& rig) {
             rig.micro->heater.cooling_tau_s = 1e-4;
             rig.micro->pi.reset();
         }},
        {"micro.heater.gain_degC_per_V",
         [](Rig& rig) {
             rig.micro->heater.gain_degC_per_V = 2720.0;
             rig.micro->pi.reset();
         }},
        {"micro.heater.gain_degC_per_V", [](Rig& rig) { rig.micro->heater.gain_degC_per_V = 27.2; }},
        {"micro.preisach_fod",
         [](Rig& rig) {
             rig.micro->fod =
                 std::make_shared<const FodTable>(std::vector{10.0, 120.0}, std::vector{0.0, 0.0, 0.4});
         }},
        {"micro.hall.half_range_mm", [](Rig& rig) { rig.micro->hall.cubic = 0.9; }},
        {"micro.hall.span_V", [](Rig& rig) { rig.micro->hall.mid_V = 4.0; }},
        {"micro.hall.adc_bits", [](Rig& rig) { rig.micro->hall.adc_bits = 5; }},
        {"micro.pi.high_V", [](Rig& rig) { rig.micro->pi->high_V = 5.0; }},
        {"micro.pi.low_V", [](Rig& rig) { rig.micro->pi->low_V = 1.8; }},
        {"micro.pi", [](Rig& rig) { rig.micro->pi->kp_V_per_mm = 3000.0; }},
        {"camera.focal_px",
         [](Rig& rig) {
             rig.camera->geometry.focal_px = 25.0;
             rig.camera->geometry.distance_mm = 0.1;
         }},
        {"camera.principal_point_px",
         [](Rig& rig) {
             rig.camera->geometry.principal_point_px = {0.0, 479.5};
             rig.fiducials.reset();
         }},
        {"camera.latency_s", [](Rig& rig) { rig.camera->latency_s = 30.0; }},
        {"camera.distance_mm",
         [](Rig& rig) {
             rig.camera->geometry.distance_mm = 2.0;
             rig.fiducials.reset();
         }},
        {"fiducials.side_mm", [](Rig& rig) { rig.fiducials->side_mm = 0.1; }},
        {"fiducials.side_mm",
         [](Rig& rig) {
             rig.fiducials->side_mm = 3.3;
             rig.fiducials->pitch_x_mm = 4.0;
         }},
        {"fiducials.pitch_mm",
         [](Rig& rig) {
             rig.fiducials->pitch_x_mm = 5.0;
             rig.fiducials->columns = 41;
         }},
        {"fiducials.count", [](Rig& rig) { rig.fiducials->columns = 50; }},
        {"fiducials.count", [](Rig& rig) {
             rig.macro.low_mm = 300.0;
             rig.macro.high_mm = 500.0;
         }}};
    for (const Mistake& mistake : mistakes) {
        Rig rig = reference_rig();
        mistake.make(rig);
        EXPECT_EQ(keys_of(rig), std::vector<std::string>{mistake.key});
    }
}

TEST(RigFindings, TravelInMicrometres_IsNotOverlooked) {
    Rig rig = reference_rig();
    rig.camera.reset();
    rig.macro.high_mm = 200'000.0;
    EXPECT_EQ(keys_of(rig), std::vector<std::string>{"macro.velocity_gain_mm_per_s_per_V"});
    rig.macro.high_mm = 0.2;
    EXPECT_EQ(keys_of(rig), std::vector<std::string>{"macro.encoder_resolution_mm"});
}

TEST(RigFindings, PlateWithRowsThatTheCameraNeverSees_IsNoneOfItsBusiness) {
    Rig rig = reference_rig();
    rig.fiducials->rows = 3;
    rig.fiducials->pitch_y_mm = 20.0;
    EXPECT_EQ(keys_of(rig), std::vector<std::string>{});
}

/// The PD's loop by hand: a small gain on an axis with p -> 0 is y+ = y - g e0 y, stable for g e0 < 2.
TEST(RigFindings, PdLoop_TurnsUnstableWhereTheDifferenceEquationDoes) {
    Rig rig = reference_rig();
    rig.macro.pid.reset();
    rig.macro.velocity_pole = 0.0068;
    rig.macro.dead_zone.slope = 1.0;
    const double tau_s = -rig.tick_s / std::log(rig.macro.velocity_pole);
    const double g = rig.macro.velocity_gain_mm_per_s_per_V / rig.macro.encoder_resolution_mm;
    rig.macro.pd->e1_V_per_count = 0.0;
    // Jury's conditions of z^2 - (1 + p - push e0) z + p + (way speed - push p) e0, state (y, v):
    const double p = rig.macro.velocity_pole, way_s = tau_s * (1.0 - p);
    const double push = g * (rig.tick_s - way_s), speed = g * (1.0 - p);
    const double limit_by_minus_one = 2.0 * (1.0 + p) / (push * (1.0 + p) - way_s * speed);
    const double limit_by_radius = (1.0 - p) / (way_s * speed - push * p);
    double limit = limit_by_radius;
    if (limit_by_minus_one > 0.0) limit = std::min(limit, limit_by_minus_one);
    rig.macro.pd->e0_V_per_count = 0.99 * limit;
    EXPECT_EQ(keys_of(rig), std::vector<std::string>{});
    rig.macro.pd->e0_V_per_count = 1.01 * limit;
    EXPECT_EQ(keys_of(rig), std::vector<std::string>{"macro.pd"});
}

std::string missing(const Rig& rig, const std::string& command) {
    const std::vector<Ability> abilities = abilities_of(rig, false);
    const auto found = std::ranges::find(abilities, command, &Ability::command);
    if (found == abilities.end()) ADD_FAILURE() << command;
    return found == abilities.end() ? "" : found->missing;
}

TEST(RigAbilities, PartsThatARigLacks_AreNamed) {
    Rig rig = reference_rig();
    for (const Ability& ability : abilities_of(rig, true))
        EXPECT_TRUE(ability.is_possible()) << ability.command;
    EXPECT_EQ(missing(rig, "--stage comedi:NODE"), "stage.comedi");
    rig.fiducials.reset();
    EXPECT_EQ(missing(rig, "goto"), "fiducials");
    EXPECT_EQ(missing(rig, "inspect"), "");
    rig.micro.reset();
    rig.camera.reset();
    EXPECT_EQ(missing(rig, "inspect"), "micro, camera");
    EXPECT_EQ(missing(rig, "simulate macro-square"), "");
    EXPECT_EQ(missing(rig, "simulate micro-steps"), "micro");
    EXPECT_EQ(missing(rig, "identify heater"), "micro");
    EXPECT_EQ(missing(rig, "identify macro"), "");
    rig.macro.pd.reset();
    EXPECT_EQ(missing(rig, "simulate macro-square"), "macro.pd");
}

TEST(RigAbilities, ExperimentForWhichTheTravelIsTooShort_IsNoneToBeRecorded) {
    Rig rig = reference_rig();
    rig.macro.high_mm = 60.0;
    const std::vector<Ability> abilities = abilities_of(rig, false);
    const auto sweep = std::ranges::find(abilities, "record macro-sweep", &Ability::command);
    ASSERT_NE(sweep, abilities.end());
    EXPECT_FALSE(sweep->is_possible());
    EXPECT_EQ(sweep->missing, "");
    EXPECT_NE(sweep->reason.find("would leave its travel, 0 to 60 mm"), std::string::npos) << sweep->reason;
    const auto rest = std::ranges::find(abilities, "record rest", &Ability::command);
    ASSERT_NE(rest, abilities.end());
    EXPECT_TRUE(rest->is_possible()) << rest->reason;
}

TEST(RigAbilities, Motions_AreThoseThatPositioningTakes) {
    for (int parts = 0; parts < 16; ++parts) {
        Rig rig = reference_rig();
        if (parts & 1) rig.micro->pi.reset();
        if (parts & 2) rig.micro.reset();
        if (parts & 4) rig.camera.reset();
        if (parts & 8) rig.macro.pd.reset();
        bool is_taken = true;
        try {
            (void)positioner_params(rig, 0.005);
        } catch (const InputError&) {
            is_taken = false;
        }
        EXPECT_EQ(missing(rig, "inspect").empty(), is_taken) << parts;
    }
}

}  // namespace
}  // namespace fidservo

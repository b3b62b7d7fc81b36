// SPDX-License-Identifier: GPL-3.0-or-later
// Effects that only show in combination with another one.
#include "gap/diagnose.h"
#include "tests/effort.h"
#include "tests/gap/effect_names.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::effects;
using testing::names;

Diagnosis diagnosed(std::initializer_list<std::string_view> truth,
                    std::initializer_list<std::string_view> kinds, const std::vector<std::string>& tried) {
    return diagnose(campaign(effects(truth), kinds), {.only = tried, .without = {}, .selection = {}});
}

const FoundEffect& found(const Diagnosis& diagnosis, std::string_view name) {
    return *std::ranges::find(diagnosis.effects, name, &FoundEffect::effect);
}

/// Alone, the pair looks like a small offset, and a gain fitted from there does not improve.
TEST(SlowDiagnosis, TwoEffectsThatHideEachOther_AreBothNamed) {
    const Diagnosis diagnosis = diagnosed({"drive_offset:offset_V=-0.257", "drive_gain:factor=1.081"},
                                          {"macro-sweep", "macro-pulses", "macro-square"},
                                          {"drive_offset", "drive_gain", "friction_asymmetry", "payload"});
    ASSERT_EQ(names(diagnosis), (std::vector<std::string>{"drive_gain", "drive_offset"}));
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
    EXPECT_NEAR(found(diagnosis, "drive_offset").parameters.front().value, -0.257, 1e-3);
    EXPECT_NEAR(found(diagnosis, "drive_gain").parameters.front().value, 1.081, 1e-3);
}

/// Far from its true value a creep speed only increases the loss.
TEST(SlowDiagnosis, FrictionThatCreeps_IsFoundWithItsCreepSpeed) {
    constexpr std::array all{"coulomb_friction", "stribeck_friction"};
    for (const std::string name : std::span(all).first(static_cast<std::size_t>(testing::draws(2, 1)))) {
        const Diagnosis diagnosis = diagnosed({name + ":level_V=0.4,creep_mm_per_s=0.5"},
                                              {"macro-sweep", "macro-pulses", "macro-square"},
                                              {"coulomb_friction", "stribeck_friction", "drive_gain"});
        ASSERT_EQ(names(diagnosis), std::vector<std::string>{name});
        EXPECT_EQ(diagnosis.verdict, Verdict::explained) << name;
        const auto& parameters = diagnosis.effects.front().parameters;
        ASSERT_EQ(parameters.back().name, "creep_mm_per_s") << name;
        EXPECT_NEAR(parameters.back().value, 0.5, 0.1) << name;
    }
}

TEST(SlowDiagnosis, FrictionThatBrakesOnlyWhileItCoasts_IsFoundAsThat) {
    const Diagnosis diagnosis = diagnosed({"coulomb_friction:level_V=0,dead_zone_share=0.04,only_coasting=1"},
                                          {"macro-sweep", "macro-pulses", "macro-square"},
                                          {"coulomb_friction", "presliding", "viscous_friction", "payload"});
    ASSERT_EQ(names(diagnosis), std::vector<std::string>{"coulomb_friction"});
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
    const auto& parameters = diagnosis.effects.front().parameters;
    EXPECT_EQ(parameters.back().name, "only_coasting");
    const auto share = std::ranges::find(parameters, "dead_zone_share", &FittedParameter::name);
    ASSERT_NE(share, parameters.end());
    EXPECT_NEAR(share->value, 0.04, 1e-3);
}

TEST(SlowDiagnosis, FrictionThatDoesNotCreep_HasNoCreepSpeed) {
    const Diagnosis diagnosis =
        diagnosed({"coulomb_friction:level_V=0.3,dead_zone_share=0"},
                  {"macro-sweep", "macro-pulses", "macro-square"}, {"coulomb_friction", "drive_gain"});
    ASSERT_EQ(names(diagnosis), std::vector<std::string>{"coulomb_friction"});
    for (const FittedParameter& parameter : diagnosis.effects.front().parameters)
        EXPECT_NE(parameter.name, "creep_mm_per_s");
}

/// With effects that do not show in the balance of forces.
TEST(SlowDiagnosis, SearchWhoseEffortIsSpent_KeepsWhatItHasFoundAndSaysSo) {
    const Evidence evidence =
        campaign(effects({"drive_delay:delay_ms=8", "backlash"}), {"macro-sweep", "macro-square"});
    DiagnosisOptions options{.only = {"drive_delay", "backlash"}, .without = {}, .selection = {}};
    options.selection.search.most_effort = 1e-3;
    const Diagnosis diagnosis = diagnose(evidence, options);
    EXPECT_EQ(names(diagnosis).size(), 1U);
    EXPECT_EQ(diagnosis.verdict, Verdict::partly_explained);
    EXPECT_TRUE(std::ranges::any_of(diagnosis.notes, [](const std::string& note) {
        return note.find("the search was ended") != std::string::npos;
    }));
}

/// What is fitted to one half helps the other a little, but what is fitted to that one does harm.
TEST(SlowDiagnosis, HalvesThatContradictEachOther_AreEndedWithAnAnswer) {
    std::vector<Recording> recordings;
    for (const std::string_view kind : {"macro-square", "macro-sweep"})
        for (const auto& [seed, more] : {std::pair(21, 0.0006), std::pair(22, 0.0036)}) {
            const std::string setting =
                fmt::format("friction_asymmetry:right_V_s_per_mm={},left_V_s_per_mm={}", more, -more);
            const Hypothesis truth = effects({setting});
            const std::string name = fmt::format("{}-{}", kind, seed);
            const Rig& rig = reference_rig();
            recordings.push_back(simulate(rig, truth, make_experiment(kind, rig, seed, name), name, seed));
        }
    const Diagnosis diagnosis =
        diagnose({reference_rig(), std::move(recordings)},
                 {.only = {"friction_asymmetry", "viscous_friction"}, .without = {}, .selection = {}});
    EXPECT_NE(diagnosis.verdict, Verdict::no_gap);
    EXPECT_NE(diagnosis.verdict, Verdict::explained);
}

/// Up to 50 mm from a place, the error of a distance from it is at most 0.04 mm, which is less than a count.
TEST(SlowDiagnosis, SmallFalseScaleOfEitherSign_IsFound) {
    for (const double factor : {0.9992, 1.0008}) {
        const std::string text = fmt::format("encoder_scale:factor={}", factor);
        const Diagnosis diagnosis = diagnosed({text}, {"macro-square", "integrated"},
                                              {"encoder_scale", "viscous_friction", "camera_tilt"});
        ASSERT_EQ(names(diagnosis), std::vector<std::string>{"encoder_scale"})
            << text << ", gap " << diagnosis.gap.before;
        EXPECT_NEAR(diagnosis.effects.front().parameters.front().value, factor, 1e-4);
    }
}

/// The patch lies between the points of the coarse grid of places that the search tries.
TEST(SlowDiagnosis, NarrowPatchOfFriction_IsFoundWithItsPlace) {
    const Diagnosis diagnosis = diagnosed({"rail_patch:level_V=0.15,centre_mm=73,width_mm=3"},
                                          {"macro-square", "macro-sweep", "macro-pulses"},
                                          {"rail_patch", "viscous_friction", "drive_gain"});
    ASSERT_EQ(names(diagnosis), std::vector<std::string>{"rail_patch"}) << diagnosis.gap.before;
    EXPECT_NEAR(diagnosis.effects.front().parameters[0].value, 0.15, 0.01);
    EXPECT_NEAR(diagnosis.effects.front().parameters[1].value, 73.0, 0.2);
    EXPECT_NEAR(diagnosis.effects.front().parameters[2].value, 3.0, 0.2);
}

/// A tilted camera explains nearly all of the effect on the tags, but nothing of that on the encoder.
TEST(SlowDiagnosis, FalseScaleThatIsWithheld_IsNoMatterOfTheCamera) {
    const Diagnosis diagnosis = diagnosed({"encoder_scale:factor=1.001"}, {"macro-square", "integrated"},
                                          {"camera_tilt", "viscous_friction", "drive_gain"});
    ASSERT_FALSE(diagnosis.where.empty());
    EXPECT_EQ(diagnosis.where.front().block, "macro.encoder");
    for (const FoundEffect& effect : diagnosis.effects) EXPECT_LT(effect.probability, 0.5) << effect.effect;
}

/// Its period is constant on the rail, which the encoder reads with a scale error.
TEST(SlowDiagnosis, RippleBesideAFalseScale_IsFoundWithItsPeriod) {
    const Diagnosis diagnosis =
        diagnosed({"encoder_scale:factor=1.01", "encoder_ripple:amplitude_um=60,period_mm=8,phase_rad=1"},
                  {"macro-sweep", "integrated"}, {"encoder_scale", "encoder_ripple", "viscous_friction"});
    ASSERT_EQ(names(diagnosis), (std::vector<std::string>{"encoder_ripple", "encoder_scale"}));
    EXPECT_NEAR(found(diagnosis, "encoder_ripple").parameters[0].value, 60.0, 3.0);
    EXPECT_NEAR(found(diagnosis, "encoder_ripple").parameters[1].value, 8.0, 0.01);
}

/// The platform's excitation is fitted first with the carriage's nominal motion, which is wrong.
TEST(SlowDiagnosis, PlatformThatFeelsACarriageOfAnotherGain_HasNoThirdEffect) {
    const Diagnosis diagnosis =
        diagnosed({"drive_gain:factor=0.97", "macro_coupling"}, {"macro-square", "macro-sweep", "integrated"},
                  {"drive_gain", "macro_coupling", "payload", "stroke_change", "hall_crosstalk"});
    EXPECT_EQ(names(diagnosis), (std::vector<std::string>{"drive_gain", "macro_coupling"}));
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
}

}  // namespace
}  // namespace fidservo

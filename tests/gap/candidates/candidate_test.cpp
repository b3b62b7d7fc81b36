// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/candidates/candidate.h"

#include "core/rig.h"
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/slopes.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::effects;

TEST(PlainForm, OfARicherEffect_HasAboutItsSize) {
    const auto plain = [](std::string_view richer, std::string_view plainer) {
        const plant::EffectSetting form = plain_form(effects({richer}).front(), reference_rig().macro);
        EXPECT_EQ(form.effect->name, plainer);
        return form.values.front();
    };
    EXPECT_DOUBLE_EQ(plain("presliding:level_V=0.2", "coulomb_friction"), 0.2);
    EXPECT_DOUBLE_EQ(plain("stribeck_friction:level_V=0.3", "coulomb_friction"), 0.3);
    EXPECT_DOUBLE_EQ(
        plain("friction_asymmetry:right_V_s_per_mm=0.0002,left_V_s_per_mm=0.0004", "viscous_friction"),
        0.0003);
    EXPECT_NEAR(plain("cable_force:stiffness_V_per_mm=0.0002,centre_mm=600", "drive_offset"), 0.1, 1e-12)
        << "a long spring pulls towards where it is slack";
}

TEST(SettingsWithinCounts, OfAScaleErrorAlone_AreSteppedToEitherSide) {
    for (const Candidate& candidate : candidates(testing::campaign({}, {"macro-pulses"}), {}, {})) {
        const std::vector<plant::EffectSetting> settings = settings_within_counts(candidate);
        if (candidate.effect->name != "encoder_scale") {
            EXPECT_TRUE(settings.empty()) << candidate.effect->name;
            continue;
        }
        ASSERT_GT(candidate.step_within_counts, 0.0);
        ASSERT_EQ(settings.size(), 32U) << "four counts to either side, in quarters";
        std::vector<double> steps;
        steps.reserve(settings.size());
        for (const plant::EffectSetting& setting : settings)
            steps.push_back((setting.values.front() - 1.0) / candidate.step_within_counts);
        EXPECT_NEAR(steps.front(), -16.0, 1e-9);
        EXPECT_NEAR(steps[15], -1.0, 1e-9);
        EXPECT_NEAR(steps[16], 1.0, 1e-9);
        EXPECT_NEAR(steps.back(), 16.0, 1e-9);
    }
}

TEST(RichForms, OfAPlainEffect_HaveItsSizeAndWhatTheyShare_AlongTheShapes) {
    const std::vector<Candidate> all = candidates(testing::campaign({}, {"macro-pulses"}), {}, {});
    const auto forms_of = [&](std::string_view plain, std::string_view richer) {
        const auto named = [&](const Candidate& candidate) { return candidate.effect->name == richer; };
        return rich_forms(effects({plain}).front(), *std::ranges::find_if(all, named));
    };
    const auto bristles = forms_of("coulomb_friction:level_V=0.25", "presliding");
    ASSERT_EQ(bristles.size(), 6U) << "three lengths, springs or not";
    for (const plant::EffectSetting& form : bristles) EXPECT_EQ(form.values[0], 0.25);
    EXPECT_EQ(bristles[0].values[1], 10.0);
    EXPECT_EQ(bristles[5].values[1], 250.0);
    EXPECT_EQ(bristles[5].values[3], 1.0);
    const auto creeping = forms_of("coulomb_friction:level_V=0.25,creep_mm_per_s=0.4", "stribeck_friction");
    ASSERT_FALSE(creeping.empty());
    for (const plant::EffectSetting& form : creeping) EXPECT_EQ(form.values[2], 0.4);
    EXPECT_TRUE(forms_of("coulomb_friction:level_V=0.25", "rail_patch").empty()) << "at many places";
    EXPECT_TRUE(forms_of("drive_offset:offset_V=0.1", "cable_force").empty());
}

TEST(Candidates, OfARigWithoutAMicroStage_AreNoneOfIt) {
    std::vector<Recording> recordings = testing::campaign({}, {"integrated"}).recordings();
    for (Recording& recording : recordings) {
        recording.columns.hall = recording.columns.micro_command = recording.columns.micro_setpoint = false;
        for (StageRow& row : recording.rows)
            row.hall_adc = row.micro_command_V = row.micro_setpoint_mm = not_in_force;
    }
    Rig rig = reference_rig();
    rig.micro.reset();
    const Evidence evidence(rig, std::move(recordings));
    const std::vector<Candidate> tried = candidates(evidence, {}, {});
    EXPECT_FALSE(tried.empty());
    for (const Candidate& candidate : tried)
        EXPECT_FALSE(candidate.effect->block.starts_with("micro.")) << candidate.effect->name;
}

TEST(PlainForm, IsThatOfALimitOnly) {
    const auto is_limit = [](std::string_view plainer, std::string_view richer) {
        return is_limit_of(*plant::find_effect(plainer), *plant::find_effect(richer));
    };
    EXPECT_TRUE(is_limit("drive_offset", "cable_force"));
    EXPECT_FALSE(is_limit("cable_force", "drive_offset"));
    EXPECT_FALSE(is_limit("drive_gain", "cable_force"));
}

TEST(Refinements, AreWhatAnEffectMayBeWithoutAndCountAsNoParameter) {
    using Names = std::vector<std::string_view>;
    const std::map<std::string_view, Names> expected{{"coulomb_friction", {"creep_mm_per_s"}},
                                                     {"stribeck_friction", {"creep_mm_per_s", "exponent"}},
                                                     {"rail_patch", {"creep_mm_per_s", "edge"}},
                                                     {"second_thermal_mass", {"heating", "diffusion_s"}},
                                                     {"hall_offset", {"shift_um"}},
                                                     {"hall_crosstalk", {"lag_ms"}},
                                                     {"cogging", {"second_sine", "second_cosine"}},
                                                     {"hall_drift", {"settling_per_s"}}};
    for (const auto& [name, refined] : expected) {
        const plant::Effect& effect = *plant::find_effect(name);
        Names names;
        for (const Refinement& refinement : refinements_of(effect)) {
            names.push_back(refinement.name);
            const plant::EffectParameter& parameter = effect.parameters[refinement.parameter];
            for (const double value : refinement.values) {
                EXPECT_TRUE(value >= parameter.low && value <= parameter.high) << name << " " << value;
                EXPECT_FALSE(parameter.is_negligible(value)) << name << " " << value;
            }
        }
        EXPECT_EQ(names, refined) << name;
        const auto choices = std::ranges::count_if(
            effect.parameters, [](const plant::EffectParameter& parameter) { return parameter.is_choice(); });
        EXPECT_EQ(unrefined_parameters(effect) + refined.size() + static_cast<std::size_t>(choices),
                  effect.parameters.size())
            << name;
    }
    EXPECT_TRUE(refinements_of(*plant::find_effect("presliding")).empty());
}

/// The derivative by an optional parameter at its vanishing value is zero without a prediction; a negative
/// value is not a vanishing one.
TEST(Slope, OfWhatAnEffectIsWithout_IsZeroUnasked) {
    int asked = 0;
    const Predict predict = [&](const Hypothesis& hypothesis) {
        ++asked;
        return Errors{static_cast<float>(hypothesis.front().values[2])};
    };
    const ScaledParameters rigid(effects({"coulomb_friction"}));
    EXPECT_TRUE(rigid.is_level(2));
    EXPECT_EQ(slope(predict, rigid, 2, {0.0F}), Errors{0.0F});
    EXPECT_EQ(asked, 0);
    const ScaledParameters creeping(effects({"coulomb_friction:creep_mm_per_s=0.4"}));
    EXPECT_FALSE(creeping.is_level(2));
    EXPECT_GT(slope(predict, creeping, 2, {0.4F}).front(), 0.0F);
    const ScaledParameters wave(effects({"cogging:phase_rad=-1"}));
    EXPECT_FALSE(wave.is_level(2));
    EXPECT_GT(slope(predict, wave, 2, {-1.0F}).front(), 0.0F);
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// From recordings of the simulated rig to its effect.
#include "gap/diagnose.h"

#include "core/rig.h"
#include "gap/search/search.h"
#include "tests/effort.h"
#include "tests/gap/effect_names.h"
#include "tests/gap/simulated_campaign.h"

#include <atomic>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::campaign;
using testing::effects;
using testing::names;
using testing::recordings_of;

TEST(Diagnosis, RigAsItsFileSays_HasNoGap) {
    const Diagnosis diagnosis = diagnose(
        campaign({}, {"macro-sweep", "macro-square"}),
        {.only = {"drive_gain", "viscous_friction", "coulomb_friction"}, .without = {}, .selection = {}});
    EXPECT_EQ(diagnosis.verdict, Verdict::no_gap);
    EXPECT_TRUE(diagnosis.effects.empty());
    EXPECT_EQ(diagnosis.gap.before, 1.0);
    EXPECT_EQ(diagnosis.candidates.size(), 3U);
}

TEST(SlowDiagnosis, EffectIsNamedAmongItsLikes_WithItsValueWithinItsError) {
    const Diagnosis diagnosis =
        diagnose(campaign(effects({"viscous_friction:damping_V_s_per_mm=0.0004"}),
                          {"macro-sweep", "macro-pulses", "macro-square"}),
                 {.only = {"drive_gain", "viscous_friction", "coulomb_friction", "payload"},
                  .without = {},
                  .selection = {}});
    ASSERT_EQ(names(diagnosis), std::vector<std::string>{"viscous_friction"});
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
    EXPECT_EQ(diagnosis.where.front().block, "macro.friction");
    EXPECT_GT(diagnosis.effects.front().probability, 0.9);
    const FittedParameter& damping = diagnosis.effects.front().parameters.front();
    EXPECT_NEAR(damping.value, 0.0004, 5.0 * damping.std + 1e-6);
    EXPECT_GT(damping.std, 0.0);
    EXPECT_GT(diagnosis.gap.removed(), 0.99);
    EXPECT_LT(diagnosis.gap.after, 1.1);
}

TEST(SlowDiagnosis, OfAnAxisAlone_TakesNothingFromWhatItDoesNotHave) {
    std::vector<Recording> recordings = recordings_of(
        effects({"drive_gain:factor=0.95", "coulomb_friction:level_V=0.2"}), {"macro-sweep", "macro-pulses"});
    for (Recording& recording : recordings) {
        recording.detections.clear();
        recording.columns.hall = recording.columns.micro_command = recording.columns.micro_setpoint = false;
        for (StageRow& row : recording.rows)
            row.hall_adc = row.micro_command_V = row.micro_setpoint_mm = not_in_force;
    }
    Rig rig = reference_rig();
    rig.micro.reset();
    rig.camera.reset();
    const Evidence evidence(rig, std::move(recordings));
    const Diagnosis diagnosis = diagnose(
        evidence,
        {.only = {"drive_gain", "coulomb_friction", "encoder_scale"}, .without = {}, .selection = {}});
    EXPECT_THAT(names(diagnosis), ::testing::UnorderedElementsAre("drive_gain", "coulomb_friction"));
}

TEST(Diagnosis, EffectThatIsWithheld_LeavesWhatNothingExplains) {
    const Diagnosis diagnosis = diagnose(
        campaign(effects({"hall_nonlinearity:cubic_shift=-0.1"}), {"micro-steps", "micro-triangle"}),
        {.only = {"hall_nonlinearity", "hall_crosstalk"}, .without = {"hall_nonlinearity"}, .selection = {}});
    EXPECT_EQ(diagnosis.verdict, Verdict::unexplained);
    ASSERT_TRUE(diagnosis.unexplained.has_value());
    EXPECT_TRUE(diagnosis.unexplained->block.starts_with("micro.")) << diagnosis.unexplained->block;
    EXPECT_GT(diagnosis.gap.before, 2.0);
}

TEST(SlowDiagnosis, RicherEffect_IsNotNamedForWhatItSharesWithThePlainerOne) {
    const Evidence evidence =
        campaign(effects({"coulomb_friction:level_V=0.1"}), {"macro-sweep", "macro-pulses", "macro-square"});
    const Diagnosis diagnosis =
        diagnose(evidence, {.only = {"presliding", "payload"}, .without = {}, .selection = {}});
    EXPECT_TRUE(diagnosis.effects.empty());
    EXPECT_EQ(diagnosis.verdict, Verdict::unexplained);
    EXPECT_EQ(diagnosis.where.front().block, "macro.friction");
    for (const TriedEffect& tried : diagnosis.candidates) EXPECT_NE(tried.effect, "coulomb_friction");
}

TEST(SlowDiagnosis, TwoEffectsInTwoBlocks_AreBothNamed) {
    const Diagnosis diagnosis =
        diagnose(campaign(effects({"drive_gain:factor=0.97", "airflow:factor=0.9"}),
                          {"macro-sweep", "macro-square", "micro-steps"}),
                 {.only = {"drive_gain", "payload", "airflow", "heater_gain", "hall_offset"},
                  .without = {},
                  .selection = {}});
    EXPECT_EQ(names(diagnosis), (std::vector<std::string>{"airflow", "drive_gain"}));
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
}

TEST(Diagnosis, EffectThatClearsOneSignal_IsRealThoughAnotherIsFurtherOff) {
    const std::vector<Candidate> tried;
    const Evidence evidence = campaign({}, {"macro-square", "micro-steps"});
    const Search search(evidence, tried, {});
    CrossFit without, with;
    for (const Window& window : evidence.windows())
        without.mean_squares.push_back(window.signal == Signal::encoder ? 1e6 : 1e3);
    with = without;
    for (std::size_t w = 0; w < with.mean_squares.size(); ++w)
        if (evidence.windows()[w].signal == Signal::hall) with.mean_squares[w] = 1.0;
    EXPECT_TRUE(search.is_real(without, with));
    EXPECT_FALSE(search.is_real(without, without));
    EXPECT_TRUE(search.off(with)[index_of(Signal::encoder)]);
    EXPECT_FALSE(search.off(with)[index_of(Signal::hall)]);
}

/// If the law of the main effect is not quite right, many other effects gain a little.
TEST(Diagnosis, EffectThatClearsCrumbsOfALargeGap_IsNotReal) {
    const std::vector<Candidate> tried;
    const Evidence evidence = campaign(effects({"stress_shift:shift_degC=6"}), {"micro-steps"});
    const Search search(evidence, tried, {});
    const auto with_hall_at = [&](double mean_square) {
        CrossFit cross;
        for (const Window& window : evidence.windows())
            cross.mean_squares.push_back(window.signal == Signal::hall ? mean_square : 1.0);
        return cross;
    };
    EXPECT_FALSE(search.is_real(with_hall_at(25.0), with_hall_at(6.0)));
    EXPECT_TRUE(search.is_real(with_hall_at(25.0), with_hall_at(1.0))) << "it leaves nothing";
    EXPECT_TRUE(search.is_real(search.nothing(), with_hall_at(6.0)));
}

/// Alone, either of the two is worse than a compromise of others; the one found first has absorbed part of
/// the other.
TEST(SlowDiagnosis, TwoEffectsOfOneStretch_AreBothNamed) {
    const Diagnosis diagnosis =
        diagnose(campaign(effects({"heater_gain:factor=1.1", "second_thermal_mass"}),
                          {"micro-steps", "micro-triangle", "micro-servo"}),
                 {.only = {"heater_gain", "second_thermal_mass", "airflow", "heating_lag"},
                  .without = {},
                  .selection = {}});
    EXPECT_EQ(names(diagnosis), (std::vector<std::string>{"heater_gain", "second_thermal_mass"}));
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
}

/// Fits to its halves of the data end in a long curved valley of the loss, which needs many steps.
TEST(SlowDiagnosis, MassThatConductsAndLosesHeat_IsFoundWithItsConductanceAndCapacity) {
    const Diagnosis diagnosis = diagnose(
        campaign(effects({"second_thermal_mass:conductance=0.117,mass_tau_s=62,taken=3.65,diffusion_s=1"}),
                 {"micro-steps", "micro-triangle", "micro-servo"}),
        {.only = {"second_thermal_mass", "airflow"}, .without = {}, .selection = {}});
    ASSERT_EQ(names(diagnosis), std::vector<std::string>{"second_thermal_mass"});
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
    const std::vector<FittedParameter>& found = diagnosis.effects.front().parameters;
    EXPECT_NEAR(found[0].value, 0.117, 0.002);
    EXPECT_NEAR(found[1].value, 62.0, 2.0);
    EXPECT_NEAR(found[2].value, 3.65, 0.1);
}

TEST(SlowDiagnosis, RippleOfTheReading_IsFoundWithItsAmplitude) {
    const Diagnosis diagnosis =
        diagnose(campaign(effects({"encoder_ripple:amplitude_um=60,period_mm=8,phase_rad=1"}),
                          {"macro-sweep", "macro-square"}),
                 {.only = {"encoder_ripple", "cogging"}, .without = {}, .selection = {}});
    ASSERT_EQ(names(diagnosis), std::vector<std::string>{"encoder_ripple"});
    EXPECT_NEAR(diagnosis.effects.front().parameters[0].value, 60.0, 2.0);
    EXPECT_NEAR(diagnosis.effects.front().parameters[1].value, 8.0, 0.01);
}

/// Jumps between tags distinguish it from an encoder with shorter counts, which explains nearly everything.
TEST(SlowDiagnosis, PlateOfAnotherPitch_AccusesThePlate) {
    Rig wider = reference_rig();
    wider.fiducials->pitch_x_mm *= 1.0008;
    const Diagnosis diagnosis = diagnose(
        campaign({}, {"macro-sweep", "macro-square", "macro-pulses", "integrated"}, wider),
        {.only = {"encoder_scale", "pixel_scale", "camera_latency"}, .without = {}, .selection = {}});
    EXPECT_GT(diagnosis.gap.before, 5.0);
    EXPECT_NE(diagnosis.verdict, Verdict::explained);
    ASSERT_FALSE(diagnosis.where.empty());
    EXPECT_EQ(diagnosis.where.front().block, "plate");
    for (const FoundEffect& effect : diagnosis.effects) EXPECT_LT(effect.probability, 0.5) << effect.effect;
}

TEST(SlowDiagnosis, WaveAlongTheRail_IsFoundWithItsPeriodAndPhase) {
    struct Truth {
        double amplitude_V, period_mm, phase_rad;
    };
    constexpr double middle_mm = 100.0;
    if (!fidservo::testing::has_all_draws())
        GTEST_SKIP() << "the self-check knows a wave, EffectRecovery another: one of all draws";
    for (const Truth& truth : {Truth{0.05, 5.0, 1.0}, Truth{0.1, 2.2, -2.0}}) {
        const std::string text = fmt::format("cogging:amplitude_V={},period_mm={},phase_rad={}",
                                             truth.amplitude_V, truth.period_mm, truth.phase_rad);
        const Diagnosis diagnosis =
            diagnose(campaign(effects({text}), {"macro-sweep", "macro-pulses", "macro-square"}),
                     {.only = {"cogging"}, .without = {}, .selection = {}});
        ASSERT_EQ(names(diagnosis), std::vector<std::string>{"cogging"});
        const std::vector<FittedParameter>& found = diagnosis.effects.front().parameters;
        EXPECT_NEAR(found[0].value, truth.amplitude_V, 0.01 * truth.amplitude_V);
        EXPECT_NEAR(found[1].value, truth.period_mm, 5e-4 * truth.period_mm);
        const auto phase_there = [&](double period_mm, double phase_rad) {
            return 2.0 * std::numbers::pi * middle_mm / period_mm + phase_rad;
        };
        EXPECT_NEAR(std::remainder(phase_there(found[1].value, found[2].value) -
                                       phase_there(truth.period_mm, truth.phase_rad),
                                   2.0 * std::numbers::pi),
                    0.0, 0.05);
        EXPECT_GT(diagnosis.gap.removed(), 0.999);
    }
}

/// At any point of the search.
TEST(SlowDiagnosis, SearchThatIsStopped_Ends) {
    for (const int asked_before : {1, 30, 100, 300, 1000, 3000, 10'000, 30'000}) {
        std::atomic<int> asked = 0;
        std::atomic<bool> is_prepared = false;
        const auto budget =
            std::make_shared<const Budget>(1e6, 1e6, [&] { return is_prepared && ++asked > asked_before; });
        const Evidence evidence(
            reference_rig(),
            recordings_of(effects({"drive_gain:factor=1.01", "drive_offset:offset_V=0.05"}), {"macro-sweep"}),
            budget);
        is_prepared = true;
        DiagnosisOptions options{.only = {"payload", "friction_asymmetry", "drive_delay", "cable_force"},
                                 .without = {},
                                 .selection = {}};
        try {
            const Diagnosis diagnosis = diagnose(evidence, options);
            EXPECT_EQ(diagnosis.ended, Ended::interrupted) << asked_before;
            EXPECT_GT(diagnosis.gap.before, 3.0);
            EXPECT_TRUE(asked_before > 100 || diagnosis.effects.empty());
        } catch (const BudgetEnded& end) {
            EXPECT_EQ(end.how(), Ended::interrupted);
            EXPECT_LE(asked_before, 30);
        }
        EXPECT_GT(asked, asked_before);
    }
}

/// What is said of recordings of macro-sweep and micro-steps if the search is stopped where the carriage's
/// forces would be balanced.
Diagnosis stopped_at_the_carriage(std::initializer_list<std::string_view> truth,
                                  const std::vector<std::string>& tried) {
    std::atomic<bool> is_over = false;
    const Evidence evidence(reference_rig(), recordings_of(effects(truth), {"macro-sweep", "micro-steps"}),
                            std::make_shared<const Budget>(1e6, 1e6, [&] { return is_over.load(); }));
    DiagnosisOptions options{.only = tried, .without = {}, .selection = {}};
    options.selection.search.tell = [&](std::string_view what) {
        if (what == "what balances the carriage's forces") is_over = true;
    };
    return diagnose(evidence, options);
}

TEST(SlowDiagnosis, SearchThatIsStoppedAtTheCarriage_KeepsWhatTheHallReadingHasTold) {
    const Diagnosis one = stopped_at_the_carriage({"heater_gain:factor=1.02", "drive_delay:delay_ms=10"},
                                                  {"heater_gain", "airflow", "drive_delay", "drive_gain"});
    EXPECT_EQ(one.ended, Ended::interrupted);
    EXPECT_EQ(names(one), std::vector<std::string>{"heater_gain"});
    const Diagnosis two = stopped_at_the_carriage(
        {"heater_gain:factor=1.02", "hall_offset:offset_V=0.03", "drive_delay:delay_ms=10"},
        {"heater_gain", "hall_offset", "drive_delay", "drive_gain"});
    EXPECT_EQ(two.ended, Ended::interrupted);
    EXPECT_EQ(names(two), (std::vector<std::string>{"hall_offset", "heater_gain"}));
    for (const FoundEffect& effect : two.effects)
        for (const FittedParameter& parameter : effect.parameters)
            EXPECT_NE(parameter.std, 0.0) << effect.effect << ": known to the last digit, or not known";
}

}  // namespace

}  // namespace fidservo

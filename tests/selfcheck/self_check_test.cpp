#include "src/selfcheck/self_check.h"

#include "core/failure.h"
#include "src/config/rig_file.h"
#include "tests/src/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

using ::testing::HasSubstr;

TEST(SelfCheckCommand, OptionsThatDoNotGoTogether_AreRefused) {
    const fidservo::testing::TemporaryFolder here;
    const auto refused = [&](const std::vector<std::string>& arguments, const char* what) {
        std::vector<std::string> all{"diagnose", "--rig", FIDSERVO_ASSETS_DIR "/rig.yaml"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const auto run = fidservo::testing::run_program(all, here.path());
        EXPECT_EQ(run.exit_code, 2) << what;
        EXPECT_THAT(run.err, HasSubstr(what));
    };
    refused({"--self-check", "somewhere"}, "--self-check: it makes its own recordings");
    refused({"--self-check", "--without", "cogging"}, "--self-check: it withholds effects itself");
    refused({"--self-check", "--kinds", "three"}, "three");
    refused({"--cases", "3"}, "--self-check");
}

TEST(SelfCheck, RigWithoutMicroStage_IsRefusedBeforeAnyCase) {
    Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    rig.micro.reset();
    EXPECT_THROW(run_self_check(rig, {}, [](const SelfCheck&) { FAIL(); }), InputError);
}

/// The first case of a kind, diagnosed with three effects to choose from.
Outcome first_case(CaseKind kind) {
    SelfCheckOptions options;
    options.cases = 1;
    options.kinds = {kind};
    options.seed = 3;
    options.only = {"hall_gain", "drive_gain", "stress_shift"};
    SelfCheck check =
        run_self_check(load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml"), options, [](const SelfCheck&) {});
    EXPECT_TRUE(check.failures.empty());
    return check.outcomes.at(0);
}

TEST(SlowSelfCheck, OneEffectAndNone_AreRecordedDiagnosedAndScored) {
    const Outcome none = first_case(CaseKind::none);
    EXPECT_EQ(none.score.verdict, gap::Verdict::no_gap) << line_of(none);
    EXPECT_NEAR(none.score.floors, 1.0, 0.05);
    const Outcome one = first_case(CaseKind::one);
    ASSERT_EQ(one.label.effects.front().effect, "stress_shift") << "the draw has changed: offer its effect";
    EXPECT_TRUE(one.score.right_effect_first && one.score.right_block_first) << line_of(one);
    EXPECT_GT(one.score.floors, 3.0);
}

/// A case by its number, the whole catalogue to choose from.
Outcome case_of(std::uint64_t seed, std::size_t number) {
    SelfCheckOptions options;
    options.cases = 1;
    options.first = number;
    options.seed = seed;
    SelfCheck check =
        run_self_check(load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml"), options, [](const SelfCheck&) {});
    return check.outcomes.at(0);
}

TEST(SlowSelfCheck, BristlesThatBendOverNoWay_AreCalledCoulombFriction) {
    const Outcome coulomb = case_of(2028, 54);
    ASSERT_EQ(coulomb.label.effects.front().effect, "coulomb_friction") << "the draw has changed";
    EXPECT_TRUE(coulomb.score.right_effect_first) << line_of(coulomb);
}

TEST(SlowSelfCheck, SmallHallGain_IsNoOffsetBesideAnotherHeater) {
    const Outcome gain = case_of(2027, 83);
    ASSERT_EQ(gain.label.effects.front().effect, "hall_gain") << "the draw has changed";
    EXPECT_TRUE(gain.score.right_effect_first) << line_of(gain);
}

TEST(SlowSelfCheck, ScaleOfTheEncoder_NeedsNoBacklashBesideIt) {
    const Outcome scale = case_of(2028, 14);
    ASSERT_EQ(scale.label.effects.front().effect, "encoder_scale") << "the draw has changed";
    EXPECT_TRUE(scale.score.right_effect_first) << line_of(scale);
    EXPECT_THAT(line_of(scale), ::testing::Not(HasSubstr("backlash")));
}

TEST(SlowSelfCheck, HysteresisOfDuhemsKind_IsNotTheHeaters) {
    const Outcome duhem = case_of(2028, 40);
    ASSERT_EQ(duhem.label.effects.front().effect, "duhem_hysteresis") << "the draw has changed";
    EXPECT_TRUE(duhem.score.right_block_first) << line_of(duhem);
}

TEST(SlowSelfCheck, EffectsThatHideEachOther_AreBothNamed) {
    const Outcome hidden = case_of(2042, 99);
    ASSERT_EQ(hidden.label.effects.front().effect, "payload") << "the draw has changed";
    EXPECT_TRUE(hidden.score.all_right) << line_of(hidden);
}

TEST(SlowSelfCheck, SupplyOfTheHallSensor_IsFoundThoughALittleOfItSeemsToDoHarm) {
    const Outcome supply = case_of(2075, 171);
    ASSERT_EQ(supply.label.effects.front().effect, "hall_gain") << "the draw has changed";
    EXPECT_TRUE(supply.score.right_effect_first && supply.score.all_right) << line_of(supply);
}

TEST(SlowSelfCheck, SensorThatWarmsUp_IsNoOffset) {
    const Outcome warm = case_of(2075, 9);
    ASSERT_EQ(warm.label.effects.front().effect, "hall_drift") << "the draw has changed";
    EXPECT_TRUE(warm.score.all_right) << line_of(warm);
}

TEST(SlowSelfCheck, WeakWave_IsFoundByTheBalanceOfForces) {
    const Outcome wave = case_of(2081, 78);
    ASSERT_EQ(wave.label.effects.front().effect, "cogging") << "the draw has changed";
    EXPECT_TRUE(wave.score.right_effect_first && wave.score.all_right) << line_of(wave);
}

/// Its command shows as acceleration does: mass and belt together stand in for it.
TEST(SlowSelfCheck, LateCommand_IsNoMassBesideABelt) {
    const Outcome late = case_of(2081, 294);
    ASSERT_EQ(late.label.effects.front().effect, "drive_delay") << "the draw has changed";
    EXPECT_TRUE(late.score.all_right) << line_of(late);
}

/// One half of the data ends in a valley beside that of the other half.
TEST(SlowSelfCheck, HardeningCable_IsFoundFromEitherHalf) {
    const Outcome cable = case_of(2081, 266);
    ASSERT_EQ(cable.label.effects.back().formula, "hardening") << "the draw has changed";
    EXPECT_TRUE(cable.score.all_right) << line_of(cable);
    EXPECT_LT(cable.score.after, 1.1) << line_of(cable);
}

TEST(SlowSelfCheck, TagsOfAnotherSize_AreNoScaleOfTheCamera) {
    const Outcome side = case_of(2028, 120);
    ASSERT_EQ(side.label.effects.front().effect, "tag_side") << "the draw has changed";
    EXPECT_TRUE(side.score.right_block_first && !side.score.is_confident_wrong) << line_of(side);
}

}  // namespace
}  // namespace fidservo::selfcheck

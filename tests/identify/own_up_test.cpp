// SPDX-License-Identifier: GPL-3.0-or-later
// The answer of identify macro if the recordings contradict each other, or the model does not fit them.
#include "src/identify/identify.h"
#include "tests/identify/owned_recordings.h"
#include "tests/src/temporary_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Identified identify(const std::vector<Carriage>& carriages, double duration_s = 6.0) {
    std::mt19937_64 random(1);
    std::vector<Recording> recordings;
    recordings.reserve(carriages.size());
    for (const Carriage& carriage : carriages)
        recordings.push_back(recorded(carriage, fmt::format("recording-{}", recordings.size() + 1),
                                      drawn_pulses(random, duration_s), duration_s, random));
    return identify_macro({rig_of(carriages.front()), std::move(recordings), std::nullopt, 0.0});
}

std::string reason_of(const Identified& identified, const std::string& key) {
    for (const Undetermined& undetermined : identified.undetermined)
        if (undetermined.key == key) return undetermined.reason;
    return {};
}

TEST(IdentifyOwnsUp, RecordingsOfOneCarriage_GiveItsNumbers) {
    const Carriage carriage;
    const Identified identified = identify({carriage, carriage});
    EXPECT_TRUE(identified.undetermined.empty()) << describe(identified);
    EXPECT_TRUE(identified.contradictions.empty()) << describe(identified);
    for (const auto& [key, truth] : truth_of(carriage)) {
        const IdentifiedValue* value = find_value(identified, key);
        ASSERT_NE(value, nullptr) << key;
        EXPECT_NEAR(value->value, truth, 4.0 * value->std) << key;
        EXPECT_LT(value->std, 0.05 * std::max(truth, 0.1)) << key;
    }
}

TEST(IdentifyOwnsUp, GainThatDiffersBetweenTwoRecordings_IsNotStatedAndBothAreNamed) {
    Carriage other;
    other.gain_mm_per_s_per_V = 52.0;
    const Identified identified = identify({Carriage{}, other});
    const std::string key = "macro.velocity_gain_mm_per_s_per_V";
    EXPECT_EQ(find_value(identified, key), nullptr) << describe(identified);
    EXPECT_THAT(reason_of(identified, key),
                AllOf(HasSubstr("contradict each other by"), HasSubstr("recording-1 says 39.9"),
                      HasSubstr("recording-2 says 51.9"), HasSubstr("no common value")));
    ASSERT_FALSE(identified.contradictions.empty());
    EXPECT_EQ(identified.contradictions[0].key, key);
    EXPECT_GT(identified.contradictions[0].standard_errors, 10.0);
    const TemporaryFolder folder;
    write_identification_json(folder / "new.json", identified);
    const auto json = nlohmann::json::parse(text_of(folder / "new.json"));
    EXPECT_EQ(json["contradictions"][0]["low"]["recording"], "recording-1");
    EXPECT_NEAR(json["contradictions"][0]["high"]["value"].get<double>(), 52.0, 1.0);
}

/// A force that the model lacks, several times its friction, in two recordings of a carriage that reverses.
TEST(IdentifyOwnsUp, ModelThatMissesMostOfTheForce_IsRefusedForACauseThatIsThere) {
    Carriage carriage;
    carriage.friction_V = 0.0;
    carriage.other.mechanics.cogging_V = 2.5;
    carriage.other.mechanics.cogging_period_mm = 7.0;
    const Identified identified = identify({carriage, carriage});
    EXPECT_TRUE(identified.values.empty()) << describe(identified);
    const std::string reason = reason_of(identified, "macro");
    EXPECT_THAT(reason, AllOf(HasSubstr("the model misses"), HasSubstr("% of the force"),
                              Not(HasSubstr("neither coasted nor reversed")),
                              Not(HasSubstr("without the carriage coasting or reversing"))));
    EXPECT_FALSE(fits_a_rig_file(identified));
    EXPECT_EQ(reason.find('\n'), std::string::npos);
}

TEST(IdentifyOwnsUp, CarriageThatNeitherCoastsNorReverses_IsTheCauseNamedOnlyThen) {
    std::mt19937_64 random(2);
    const Carriage carriage;
    const Recording recording = recorded(
        carriage, "one-step", [](double t_s) { return t_s < 0.05 ? 0.0 : 3.0; }, 2.0, random);
    const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
    EXPECT_THAT(reason_of(identified, "coulomb_friction"), HasSubstr("neither coasted nor reversed"))
        << describe(identified);
}

TEST(IdentifyOwnsUp, MotionTooShortForASteadySpeed_GivesTheAccelerationPerVolt) {
    std::mt19937_64 random(3);
    Carriage carriage;
    carriage.time_constant_s = 6.0;
    carriage.gain_mm_per_s_per_V = 3000.0;
    carriage.friction_V = carriage.offset_V = 0.0;
    const Recording recording = recorded(
        carriage, "short", [](double t_s) { return t_s < 0.05 ? 0.0 : 3.0; }, 0.25, random);
    const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
    EXPECT_EQ(find_value(identified, "macro.velocity_gain_mm_per_s_per_V"), nullptr) << describe(identified);
    const IdentifiedValue* ratio = find_value(identified, "gain_over_time_constant");
    ASSERT_NE(ratio, nullptr) << describe(identified);
    EXPECT_NEAR(ratio->value, 500.0, 4.0 * ratio->std) << ratio->std;
}

/// Without friction an offset moves the carriage before the step: taking it as zero would bias the other
/// parameters.
TEST(IdentifyOwnsUp, CarriageThatCreepsBeforeItIsDriven_HasItsOffsetCounted) {
    std::mt19937_64 random(4);
    Carriage carriage;
    carriage.friction_V = 0.0;
    carriage.offset_V = 0.2;
    const Recording recording = recorded(
        carriage, "creeps", [](double t_s) { return t_s < 0.3 ? 0.0 : 3.0; }, 2.0, random);
    const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
    EXPECT_THAT(reason_of(identified, "drive_offset"), HasSubstr("drive offset less friction is 0."))
        << describe(identified);
    for (const char* key : {"macro.velocity_gain_mm_per_s_per_V", "time_constant"}) {
        const IdentifiedValue* value = find_value(identified, key);
        ASSERT_NE(value, nullptr) << describe(identified);
        const double truth =
            std::string(key) == "time_constant" ? carriage.time_constant_s : carriage.gain_mm_per_s_per_V;
        EXPECT_NEAR(value->value, truth, 4.0 * value->std) << key;
        EXPECT_LT(value->std, 0.1 * truth) << key;
    }
}

/// At 100 Hz the noise of the readings hides the accelerations: that must not count as a force that the model
/// misses.
TEST(IdentifyOwnsUp, AccelerationsThatDrownInNoise_AreNoForceThatTheModelMisses) {
    constexpr int draws = 20;
    Carriage carriage;
    carriage.time_constant_s = 0.3;
    int stated = 0;
    for (std::uint64_t seed = 1; seed <= draws; ++seed) {
        std::mt19937_64 random(seed);
        const Recording recording = recorded(
            carriage, "step", [](double t_s) { return t_s < 0.05 ? 0.0 : 2.0; }, 1.5, random, 0.03);
        const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
        stated += find_value(identified, "macro.velocity_gain_mm_per_s_per_V") != nullptr ? 1 : 0;
        EXPECT_THAT(reason_of(identified, "macro"), Not(HasSubstr("% of the force;"))) << "seed " << seed;
    }
    EXPECT_GT(stated, draws / 2);
}

/// A carriage far from its steady speed is compatible with any higher one: intervals are wider on that side.
TEST(SlowIdentifyOwnsUp, MotionFarFromItsSteadySpeed_HasStandardErrorsThatHold) {
    constexpr int draws = 40;
    Carriage carriage;
    carriage.friction_V = carriage.offset_V = 0.0;
    carriage.time_constant_s = 1.5;
    double farthest = 0.0;
    for (std::uint64_t seed = 1; seed <= draws; ++seed) {
        std::mt19937_64 random(seed);
        const Recording recording = recorded(
            carriage, "short", [](double t_s) { return t_s < 0.05 ? 0.0 : 3.0; }, 1.0, random);
        const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
        if (const IdentifiedValue* value = find_value(identified, "time_constant"))
            farthest = std::max(farthest, std::abs(value->value - carriage.time_constant_s) / value->std);
    }
    EXPECT_LT(farthest, 4.0);
}

TEST(IdentifyOwnsUp, FrictionAtItsBound_HasAOneSidedInterval) {
    Carriage carriage;
    carriage.friction_V = 0.0;
    int at_bound = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        std::mt19937_64 random(seed);
        const Recording recording = recorded(carriage, "free", drawn_pulses(random, 4.0), 4.0, random, 0.02);
        const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
        const IdentifiedValue* friction = find_value(identified, "coulomb_friction");
        ASSERT_NE(friction, nullptr) << describe(identified);
        if (!friction->interval || friction->value > 1e-6) continue;
        ++at_bound;
        EXPECT_EQ(friction->interval->low, 0.0);
        EXPECT_GT(friction->interval->high, 0.0);
        EXPECT_THAT(describe(identified), HasSubstr("at its bound of 0"));
    }
    EXPECT_GT(at_bound, 0);
}

}  // namespace
}  // namespace fidservo

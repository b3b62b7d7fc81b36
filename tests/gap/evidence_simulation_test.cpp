// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings of the simulated rig and the hypothesis of its effect.
#include "core/input_error.h"
#include "core/random.h"
#include "core/rig.h"
#include "gap/evidence.h"
#include "gap/fit/score.h"
#include "gap/links/tag_link.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"
#include "tests/gap/effects.h"
#include "tests/gap/root_mean_square.h"
#include "tests/gap/simulated_campaign.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using testing::rms;

std::vector<Recording> simulated(const Hypothesis& truth, std::initializer_list<std::string_view> kinds,
                                 std::uint64_t seed) {
    std::vector<Recording> recordings;
    for (const std::string_view kind : kinds) {
        const std::string name(kind);
        recordings.push_back(
            simulate(reference_rig(), truth, make_experiment(kind, reference_rig(), seed, name), name, seed));
    }
    return recordings;
}

struct Case {
    std::string_view effect;
    Signal signal;  ///< the signal that shows it
    double least;   ///< least error in floors without the hypothesis
};

void PrintTo(const Case& one, std::ostream* stream) {
    *stream << one.effect;
}

class SimulatedEffect : public ::testing::TestWithParam<Case> {};

TEST_P(SimulatedEffect, TruthIsAtTheFloor_NothingIsNot) {
    constexpr std::uint64_t seed = 11;
    const Hypothesis truth = effects({GetParam().effect});
    const Evidence evidence(reference_rig(), simulated(truth, {"rest", "macro-sweep", "integrated"}, seed));
    const Errors nothing = evidence.errors({}, everything(evidence));
    const Errors known = evidence.errors(truth, everything(evidence));
    EXPECT_GT(rms(evidence, nothing, GetParam().signal), GetParam().least) << "seed " << seed;
    EXPECT_LT(rms(evidence, known, Signal::encoder), 1.1) << "seed " << seed;
    EXPECT_LT(rms(evidence, known, Signal::hall), 1.03) << "seed " << seed;
    EXPECT_LT(rms(evidence, known, Signal::tag), 1.1) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(
    Effects, SimulatedEffect,
    ::testing::Values(Case{"drive_gain:factor=1.02", Signal::encoder, 2.0},
                      Case{"drive_delay:delay_ms=3", Signal::encoder, 2.0},
                      Case{"backlash:width_um=300", Signal::encoder, 1.5},
                      Case{"encoder_scale:factor=1.01", Signal::tag, 2.0},
                      Case{"encoder_ripple:amplitude_um=200", Signal::encoder, 1.2},
                      Case{"heater_gain", Signal::hall, 5.0}, Case{"macro_coupling", Signal::hall, 2.0},
                      Case{"hall_crosstalk", Signal::hall, 2.0}, Case{"hall_drift", Signal::hall, 2.0},
                      Case{"camera_latency:delay_ms=30", Signal::tag, 2.0},
                      Case{"clock_skew:skew_ppm=1000", Signal::tag, 1.2},
                      Case{"rolling_shutter", Signal::tag, 1.2}, Case{"pixel_scale", Signal::tag, 5.0},
                      Case{"camera_tilt:axis_height=0.5", Signal::tag, 5.0}));

TEST(Evidence, SensorThatWouldReadHighAtAColdWire_IsNoWarmWire) {
    const Evidence evidence(reference_rig(), simulated({}, {"micro-steps"}, 9));
    const auto rms_with = [&](std::string_view effect) {
        return rms(evidence, evidence.errors(effects({effect}), everything(evidence)), Signal::hall);
    };
    // From a cold wire both gains predict readings a few LSB below the recorded ones, as if it were warm.
    EXPECT_LT(rms_with("hall_gain:factor=1.005"), 2.2 * rms_with("hall_gain:factor=1.0025"));
}

/// Soft bristles let the carriage oscillate about the edge of a count, where its controller brings it: each
/// reading there is off by half a count.
TEST(Evidence, CarriageThatFlickersBetweenTwoCounts_IsNoFurtherOffThanIsExpected) {
    constexpr std::uint64_t seed = 11;
    const Hypothesis truth = effects({"presliding:level_V=0.01,distance_um=390"});
    const Evidence evidence(reference_rig(), simulated(truth, {"integrated"}, seed));
    const auto squares = mean_squares(evidence.windows(), evidence.errors(truth, everything(evidence)));
    double found = 0.0, expected = 0.0;
    for (std::size_t w = 0; w < squares.size(); ++w) {
        if (evidence.windows()[w].signal != Signal::encoder) continue;
        found += squares[w];
        expected += evidence.windows()[w].expected_square;
    }
    EXPECT_LT(found, 1.1 * expected) << "seed " << seed;
}

/// These sweeps run into the ends of travel, where bristles stay bent as they came.
/// However far off the carriage was predicted before: the readings say where it stands, to within a count.
TEST(Evidence, TagsOfACarriageThatStands_AreWhereItsCountsAre_UnderAFalseHypothesis) {
    const Evidence evidence =
        testing::campaign(effects({"cogging:amplitude_V=0.0084,period_mm=8.06,phase_rad=0.21"}),
                          {"macro-sweep", "macro-pulses", "macro-square", "integrated"});
    const Errors errors = evidence.errors({}, everything(evidence));
    constexpr std::ptrdiff_t lead_of_100_ms = 100;
    constexpr double px_per_count = 12.5, surely_px = 1.0;
    const auto stands = [&](const Window& window) {
        const std::vector<StageRow>& rows = evidence.recordings()[window.run].rows;
        const auto first = rows.begin() + static_cast<std::ptrdiff_t>(window.first_row);
        return std::all_of(first - lead_of_100_ms, first + static_cast<std::ptrdiff_t>(window.rows),
                           [&](const StageRow& row) { return row.encoder_count == first->encoder_count; });
    };
    int judged = 0;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::tag || !stands(window)) continue;
        for (std::size_t k = window.begin, i = window.first_detection; k < window.end;
             k += corner_values, ++i) {
            const double floor_px = evidence.sighting(window.run, i).floors_px[0];
            if (floor_px > surely_px) continue;
            ++judged;
            EXPECT_LT(std::abs(errors[k]) * floor_px, 0.5 * px_per_count)
                << "run " << window.run << ", row " << window.first_row;
        }
    }
    EXPECT_GT(judged, 1000);
}

TEST(Evidence, BristlesBehindAnEndOfTravel_AreAsTheWayBentThem) {
    for (const std::uint64_t seed : {2, 4, 8}) {
        const Hypothesis truth = effects({"presliding:level_V=0.02,distance_um=220"});
        const Evidence evidence(reference_rig(), simulated(truth, {"macro-sweep"}, seed));
        const Errors errors = evidence.errors(truth, everything(evidence));
        EXPECT_LT(rms(evidence, errors, Signal::tag), 1.1) << "seed " << seed;
        EXPECT_LT(rms(evidence, errors, Signal::encoder), 1.0) << "seed " << seed;
    }
}

TEST(Evidence, MechanismThatRemembers_IsPredictedAsWellWithoutTheWindowsBefore) {
    constexpr std::uint64_t seed = 12;
    for (const char* effect : {"presliding:level_V=0.05,distance_um=100", "backlash:width_um=300"}) {
        const Hypothesis truth = effects({effect});
        const Evidence evidence(reference_rig(), simulated(truth, {"macro-pulses", "macro-square"}, seed));
        const std::vector<Window>& windows = evidence.windows();
        Wanted few(windows.size(), 0);
        for (std::size_t w = 0; w < windows.size(); ++w)
            few[w] = windows[w].signal == Signal::encoder && w % 3 == 0 ? 1 : 0;
        const auto sum_of_few = [&](const Errors& errors) {
            const auto squares = mean_squares(windows, errors);
            double sum = 0.0;
            for (std::size_t w = 0; w < windows.size(); ++w) sum += few[w] != 0 ? squares[w] : 0.0;
            return sum;
        };
        EXPECT_LT(sum_of_few(evidence.errors(truth, few)),
                  1.2 * sum_of_few(evidence.errors(truth, everything(evidence))))
            << effect << ", seed " << seed;
    }
}

TEST(Evidence, RecordingThatBeginsWarm_IsFollowed) {
    auto recordings = simulated({}, {"micro-steps"}, 9);
    Recording& recording = recordings.front();
    const auto warmest = std::ranges::max_element(recording.rows, {}, &StageRow::hall_adc);
    recording.rows.erase(recording.rows.begin(), warmest);
    const Evidence evidence(reference_rig(), recordings);
    EXPECT_LT(rms(evidence, evidence.errors({}, everything(evidence)), Signal::hall), 1.05);
}

TEST(Evidence, EffectThatDoesNotReachASignal_LeavesItsErrorsAsTheyAre) {
    const Evidence evidence(reference_rig(), simulated({}, {"integrated"}, 3));
    const Errors nothing = evidence.errors({}, everything(evidence));
    for (const plant::Effect* effect : plant::effect_catalogue()) {
        const Hypothesis typical{plant::parse_effect(effect->name)};
        const Errors errors = evidence.errors(typical, everything(evidence));
        ASSERT_EQ(errors.size(), nothing.size()) << effect->name;
        const auto reach = reach_of(*effect);
        for (const Window& window : evidence.windows()) {
            if (std::ranges::find(reach, window.signal) != reach.end()) continue;
            for (std::size_t k = window.begin; k < window.end; ++k)
                ASSERT_EQ(errors[k], nothing[k]) << effect->name << " " << name_of(window.signal);
        }
        const Errors vanishing = evidence.errors({plant::vanishing_setting(*effect)}, everything(evidence));
        for (std::size_t k = 0; k < nothing.size(); ++k)
            ASSERT_EQ(vanishing[k], nothing[k]) << effect->name << " at its vanishing values";
    }
}

TEST(Evidence, HypothesisThatThePlantRefuses_GivesNothing) {
    const Evidence evidence(reference_rig(), simulated({}, {"rest"}, 3));
    const Hypothesis twice = effects({"airflow:factor=0.8", "airflow:factor=0.9"});
    EXPECT_TRUE(evidence.errors(twice, everything(evidence)).empty());
}

TEST(Evidence, WhatIsNotWanted_IsLeftOut) {
    const Evidence evidence(reference_rig(), simulated({}, {"rest", "macro-sweep"}, 3));
    Wanted wanted = everything(evidence);
    const auto is_wanted = [](const Window& window) {
        return window.run == 1 && window.signal != Signal::hall && window.start_ns > 2'000'000'000;
    };
    for (std::size_t w = 0; w < wanted.size(); ++w) wanted[w] = is_wanted(evidence.windows()[w]) ? 1 : 0;
    const Errors errors = evidence.errors(effects({"drive_gain:factor=1.02"}), wanted);
    for (const Window& window : evidence.windows()) {
        for (std::size_t k = window.begin; k < window.end; ++k)
            ASSERT_EQ(std::isfinite(errors[k]), is_wanted(window));
    }
}

TEST(Evidence, RowsDroppedAtRandom_TheTruthStaysAtTheFloor) {
    constexpr std::uint64_t seed = 5;
    const Hypothesis truth = effects({"drive_gain:factor=1.02", "airflow:factor=0.8"});
    const auto whole = simulated(truth, {"rest", "macro-sweep", "micro-steps"}, seed);
    NoiseStream draw(seed, "dropped rows");
    for (const double pause_s : {5.0, 2.0, 1.0}) {
        auto recordings = whole;
        for (Recording& recording : recordings)
            std::erase_if(recording.rows, [&](const StageRow&) { return draw.uniform() < 1e-3 / pause_s; });
        const Evidence evidence(reference_rig(), recordings);
        const Errors errors = evidence.errors(truth, everything(evidence));
        EXPECT_LT(rms(evidence, errors, Signal::encoder), 1.03) << pause_s << " s, seed " << seed;
        EXPECT_LT(rms(evidence, errors, Signal::hall), 1.05) << pause_s << " s, seed " << seed;
        EXPECT_LT(rms(evidence, errors, Signal::tag), 1.15) << pause_s << " s, seed " << seed;
    }
}

TEST(Evidence, RecordingsThatLackThings_AreJudgedAsFarAsTheyGo) {
    const auto whole = simulated({}, {"integrated"}, 9).front();
    std::vector<Recording> recordings(8, whole);
    recordings[0].rows.clear();
    recordings[0].detections.clear();
    recordings[1].rows.resize(200);
    recordings[2].detections.clear();
    recordings[3].rows.erase(recordings[3].rows.begin() + 5000, recordings[3].rows.begin() + 9000);
    for (std::size_t k = 0; k < recordings[4].rows.size(); ++k) {
        StageRow& row = recordings[4].rows[k];
        row.encoder_count = row.macro_command_V = row.macro_setpoint_mm = not_in_force;
    }
    for (std::size_t k = 7000; k < 9000; ++k) recordings[5].rows[k].hall_adc = k % 2 == 0 ? 0.0 : 4095.0;
    for (TagDetection& detection : recordings[6].detections) detection.tag_id += 300;
    for (std::size_t k = 0; k < recordings[7].rows.size(); k += 50)
        recordings[7].rows[k].hall_adc = recordings[7].rows[k].encoder_count = not_in_force;
    const Evidence evidence(reference_rig(), recordings);
    const Hypothesis any =
        effects({"drive_gain:factor=1.02", "macro_coupling", "camera_latency:delay_ms=400"});
    ASSERT_FALSE(evidence.errors(any, everything(evidence)).empty());
    const Errors errors = evidence.errors({}, everything(evidence));
    for (std::size_t run = 2; run < 7; ++run)
        EXPECT_FALSE(rms(evidence, errors, Signal::hall, run) > 1.05) << run;
    for (const Window& window : evidence.windows()) {
        EXPECT_GT(window.run, 1U);
        EXPECT_LE(window.first_row + window.rows, recordings[window.run].rows.size());
    }
    for (const std::size_t run : {5U, 6U, 7U})
        EXPECT_TRUE(std::ranges::any_of(evidence.omissions(), [&](const Omission& omission) {
            return omission.recording == recordings[run].name;
        }));
}

TEST(Evidence, RecordingOfAnotherTickOrRig_IsRefused) {
    auto recordings = simulated({}, {"rest"}, 3);
    Rig without_micro = reference_rig();
    without_micro.micro.reset();
    EXPECT_THROW(Evidence(without_micro, recordings), InputError);
    recordings[0].tick_s = 0.002;
    EXPECT_THROW(Evidence(reference_rig(), recordings), InputError);
}

TEST(Evidence, OtherGains_AreAGapOfTheController) {
    const auto recordings = simulated({}, {"integrated"}, 3);
    Rig other = reference_rig();
    other.macro.pd->e0_V_per_count *= 1.1;
    other.macro.pid.reset();
    other.micro->pi->kp_V_per_mm *= 1.1;
    const Evidence evidence(other, recordings);
    const Errors errors = evidence.errors({}, everything(evidence));
    EXPECT_GT(rms(evidence, errors, Signal::macro_command), 1.0);
    EXPECT_GT(rms(evidence, errors, Signal::micro_command), 1.0);
}

TEST(Evidence, Course_FollowsTheStage) {
    const auto recordings = simulated({}, {"integrated"}, 3);
    const Evidence evidence(reference_rig(), recordings);
    const gap::Course& course = evidence.course(0);
    ASSERT_EQ(course.position_mm.size(), recordings[0].rows.size());
    for (std::size_t k = 0; k < course.position_mm.size(); ++k) {
        ASSERT_NEAR(course.position_mm[k], 0.05 * recordings[0].rows[k].encoder_count, 0.051) << k;
        ASSERT_GE(course.temperature_degC[k], 21.9F);
        ASSERT_NEAR(course.contraction_mm[k], 2.0F, 2.1F);
    }
}

}  // namespace

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// If the true effect is withheld from the search: the quantity on which the remaining errors are found to
// depend, and the block that is accused.
#include "core/hall.h"
#include "core/random.h"
#include "core/rig.h"
#include "gap/diagnose.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::HasSubstr;

/// A diagnosis that may not try any effect which could explain the recordings.
Diagnosis unnamed(const Rig& true_rig, const Hypothesis& truth, std::initializer_list<std::string_view> kinds,
                  const std::string& tried) {
    return diagnose(testing::campaign(truth, kinds, true_rig),
                    {.only = {tried}, .without = {}, .selection = {}});
}

std::string first_dependence(const Diagnosis& diagnosis) {
    if (!diagnosis.unexplained || diagnosis.unexplained->depends_on.empty()) return "none";
    return diagnosis.unexplained->depends_on.front();
}

TEST(Surrogate, TagsOfAnotherSize_AccuseThePlate) {
    Rig rig = reference_rig();
    rig.fiducials->side_mm *= 1.003;
    const Diagnosis diagnosis = unnamed(rig, {}, {"rest", "micro-servo"}, "clock_skew");
    EXPECT_EQ(first_dependence(diagnosis), "size of the tag");
    EXPECT_EQ(diagnosis.where.front().block, "plate");
}

TEST(Trust, TagsOfNearlyTheirSize_AreNoScaleOfTheCameraThoughThatLeavesNothing) {
    Rig rig = reference_rig();
    const auto scale_of = [&rig](std::initializer_list<std::string_view> truth) {
        return unnamed(rig, testing::effects(truth), {"rest", "micro-servo"}, "pixel_scale");
    };
    EXPECT_EQ(scale_of({"pixel_scale:factor=1.0005"}).verdict, Verdict::explained);
    rig.fiducials->side_mm *= 1.0005;
    const Diagnosis side = scale_of({});
    EXPECT_EQ(side.verdict, Verdict::partly_explained);
    EXPECT_EQ(side.where.front().block, "plate");
}

/// What all corners of a detection are displaced by in the image, px, by the tag's number.
Diagnosis with_tags_displaced(const std::function<Eigen::Vector2d(int)>& displacement_px) {
    std::vector<Recording> recordings = testing::recordings_of({}, {"macro-square", "integrated"});
    for (Recording& recording : recordings)
        for (TagDetection& detection : recording.detections)
            for (Eigen::Vector2d& corner : detection.corners_px) corner += displacement_px(detection.tag_id);
    return diagnose(Evidence(reference_rig(), std::move(recordings)),
                    {.only = {"clock_skew"}, .without = {}, .selection = {}});
}

TEST(Surrogate, FramesThatRepeatTheOneBefore_AccuseTheTiming) {
    std::vector<Recording> recordings = testing::recordings_of({}, {"macro-square", "integrated"});
    for (Recording& recording : recordings) {
        NoiseStream random(7, "stale frames");
        std::map<int, TagDetection> before, here;
        TimeNs frame_ns = 0;
        bool is_stale = false;
        for (TagDetection& detection : recording.detections) {
            if (detection.time_ns != frame_ns) {
                before = std::exchange(here, {});
                frame_ns = detection.time_ns;
                is_stale = random.uniform() < 0.1;
            }
            if (is_stale && before.contains(detection.tag_id))
                detection.corners_px = before.at(detection.tag_id).corners_px;
            here[detection.tag_id] = detection;
        }
    }
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), std::move(recordings)),
                                         {.only = {"clock_skew"}, .without = {}, .selection = {}});
    EXPECT_EQ(diagnosis.where.front().block, "camera.timing") << first_dependence(diagnosis);
}

TEST(Surrogate, PlateThatIsTurned_IsToldFromACameraThatIs) {
    constexpr double turned_rad = 0.004, px_per_mm = 250.0, pitch_mm = 2.0;
    const Diagnosis plate = with_tags_displaced(
        [](int id) { return Eigen::Vector2d(0.0, turned_rad * px_per_mm * (pitch_mm * id - 100.0)); });
    EXPECT_EQ(plate.where.front().block, "plate") << first_dependence(plate);
    const Diagnosis camera = unnamed(reference_rig(), testing::effects({"camera_rotation:angle_deg=0.5"}),
                                     {"macro-square", "integrated"}, "clock_skew");
    EXPECT_EQ(first_dependence(camera), "place in the image");
    EXPECT_EQ(camera.where.front().block, "camera.geometry");
}

TEST(Surrogate, TagsThatAreMisplacedEachByItself_AccuseThePlate) {
    const Diagnosis diagnosis = with_tags_displaced([](int id) {
        NoiseStream random(static_cast<std::uint64_t>(id), "misprint");
        const double u_px = random.normal(), v_px = random.normal();
        return Eigen::Vector2d(u_px, v_px);
    });
    EXPECT_EQ(first_dependence(diagnosis), "which tag it is");
    EXPECT_EQ(diagnosis.where.front().block, "plate");
}

TEST(Surrogate, LateFrames_AccuseTheClock_AndALens_AccusesTheCamera) {
    const Diagnosis late = unnamed(reference_rig(), testing::effects({"camera_latency:delay_ms=20"}),
                                   {"micro-servo", "integrated"}, "lens_distortion");
    EXPECT_EQ(first_dependence(late), "velocity");
    EXPECT_EQ(late.where.front().block, "camera.timing");
    const Diagnosis bent = unnamed(reference_rig(), testing::effects({"lens_distortion:k1=0.3"}),
                                   {"micro-servo", "integrated"}, "clock_skew");
    EXPECT_EQ(first_dependence(bent), "place in the image");
    EXPECT_EQ(bent.where.front().block, "camera.geometry");
}

TEST(SlowSurrogate, PeriodOfTheReading_IsToldFromThatOfAForce) {
    const Diagnosis reading =
        unnamed(reference_rig(), testing::effects({"encoder_ripple:amplitude_um=60,period_mm=8,phase_rad=1"}),
                {"macro-sweep", "macro-pulses", "macro-square"}, "clock_skew");
    EXPECT_THAT(first_dependence(reading), HasSubstr("in the reading"));
    EXPECT_EQ(reading.where.front().block, "macro.encoder");
    const Diagnosis force =
        unnamed(reference_rig(), testing::effects({"cogging:amplitude_V=0.02,period_mm=8,phase_rad=1"}),
                {"macro-sweep", "macro-pulses", "macro-square"}, "clock_skew");
    EXPECT_EQ(force.where.front().block, "macro.mechanics") << first_dependence(force);
}

/// Some of them are strong and make the carriage move in jumps.
TEST(SlowSurrogate, ForcesOnTheCarriage_AccuseTheirBlock) {
    struct Case {
        std::string_view effect, block, dependence;
    };
    for (const Case& it :
         {Case{"cable_force", "macro.mechanics", "position"},
          Case{"cogging", "macro.mechanics", "position, periodic"},
          Case{"payload", "macro.mechanics", "acceleration"},
          Case{"drive_delay", "macro.drive", "changes of the command"},
          Case{"drive_gain", "macro.drive", "command"}, Case{"drive_offset", "macro.drive", "nothing"},
          Case{"viscous_friction", "macro.friction", "velocity"},
          Case{"rail_patch", "macro.friction", "position, against the motion"},
          Case{"coulomb_friction", "macro.friction", "direction"}}) {
        const Diagnosis found = unnamed(reference_rig(), testing::effects({it.effect}),
                                        {"macro-sweep", "macro-pulses", "macro-square"}, "clock_skew");
        ASSERT_FALSE(found.where.empty()) << it.effect;
        EXPECT_EQ(found.where.front().block, it.block) << it.effect;
        EXPECT_THAT(first_dependence(found), HasSubstr(std::string(it.dependence))) << it.effect;
    }
}

TEST(Surrogate, BodyThatStoresHeat_AccusesTheHeater) {
    const Diagnosis diagnosis = unnamed(reference_rig(), testing::effects({"second_thermal_mass"}),
                                        {"micro-steps", "micro-triangle", "micro-servo"}, "clock_skew");
    EXPECT_EQ(diagnosis.where.front().block, "micro.heater") << first_dependence(diagnosis);
}

/// Such a wire hardly contracts, which could be mistaken for a small stroke.
TEST(SlowSurrogate, WireThatIsHeatedFarTooLittle_AccusesTheHeater) {
    for (const char* effect : {"heater_gain:factor=0.7", "heater_gain:factor=0.55", "airflow:factor=0.5"}) {
        const Diagnosis diagnosis = unnamed(reference_rig(), testing::effects({effect}),
                                            {"micro-steps", "micro-triangle", "micro-servo"}, "clock_skew");
        EXPECT_EQ(diagnosis.where.front().block, "micro.heater")
            << effect << ": " << first_dependence(diagnosis);
    }
}

/// A longer stroke must not be taken for another heater, although a warmer wire contracts further, too.
using Change = std::function<void(Recording&)>;

/// The diagnosis of recordings of the reference rig after a change of their values.
Diagnosis of_changed(std::initializer_list<std::string_view> kinds, const Change& change) {
    std::vector<Recording> recordings = testing::recordings_of({}, kinds);
    for (Recording& recording : recordings) change(recording);
    return diagnose(Evidence(reference_rig(), std::move(recordings)),
                    {.only = {"clock_skew"}, .without = {}, .selection = {}});
}

/// Recordings of the wire and its Hall reading without tags, with the platform moved from x to moved_mm(x),
/// row after row.
Diagnosis of_moved_platform(const std::function<std::function<double(double)>()>& begin) {
    return of_changed({"micro-steps", "micro-triangle"}, [&](Recording& recording) {
        const HallParameters& hall = reference_rig().micro->hall;
        const auto moved_mm = begin();
        recording.detections.clear();
        for (StageRow& row : recording.rows) {
            const double place_mm = hall_position_mm_of_adc(hall, row.hall_adc);
            const double moved_lsb =
                (moved_mm(place_mm) - place_mm) * hall_slope_V_per_mm(hall, place_mm) / hall_lsb_V(hall);
            row.hall_adc = std::round(row.hall_adc + moved_lsb);
        }
    });
}

TEST(Surrogate, PlatformThatMeetsASpring_AccusesTheMechanics) {
    const Diagnosis diagnosis = of_moved_platform(
        [] { return [](double wire_mm) { return wire_mm - 0.1 * std::max(0.0, wire_mm - 2.5); }; });
    EXPECT_EQ(first_dependence(diagnosis), "place of the platform");
    EXPECT_EQ(diagnosis.where.front().block, "micro.mechanics");
}

TEST(Surrogate, PlayBetweenWireAndPlatform_AccusesTheMechanics) {
    const Diagnosis diagnosis = of_moved_platform([] {
        return [place_mm = 0.0](double wire_mm) mutable {
            constexpr double half_mm = 0.04;
            return place_mm = std::clamp(place_mm, wire_mm - half_mm, wire_mm + half_mm);
        };
    });
    EXPECT_EQ(first_dependence(diagnosis), "way since the wire turned");
    EXPECT_EQ(diagnosis.where.front().block, "micro.mechanics");
}

TEST(Surrogate, WireThatCreeps_AccusesTheHysteresis) {
    const Diagnosis diagnosis = of_moved_platform([] {
        return [slow_mm = 0.0](double wire_mm) mutable {
            constexpr double share = 0.05, tau_s = 3.0, tick_s = 1e-3;
            slow_mm += (wire_mm - slow_mm) * tick_s / tau_s;
            return wire_mm + share * (slow_mm - wire_mm);
        };
    });
    EXPECT_EQ(first_dependence(diagnosis), "contraction before");
    EXPECT_EQ(diagnosis.where.front().block, "micro.hysteresis");
}

TEST(SlowSurrogate, LongerStroke_AccusesTheHysteresis) {
    for (const char* stroke : {"stroke_change:factor=1.013", "stroke_change:factor=0.93"}) {
        const Diagnosis diagnosis = unnamed(reference_rig(), testing::effects({stroke}),
                                            {"micro-steps", "micro-triangle", "micro-servo"}, "clock_skew");
        EXPECT_EQ(diagnosis.where.front().block, "micro.hysteresis") << stroke;
        EXPECT_EQ(first_dependence(diagnosis), "contraction") << stroke;
    }
}

}  // namespace

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/simulated_rig.h"

#include "core/rig.h"
#include "plant/actual_camera.h"
#include "plant/effects/catalogue.h"
#include "src/session/sight.h"
#include "tests/session/watched_rig.h"
#include "vision/tags/tag_choice.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

struct RigAndCamera {
    explicit RigAndCamera(const plant::CameraDeviation& deviation = {},
                          const std::vector<std::string>& effects = {}) {
        plant::PlantParameters physics = reference_physics();
        physics.camera = deviation;
        for (const std::string& effect : effects) {
            const plant::EffectSetting setting = plant::parse_effect(effect);
            plant::apply_effects(physics, {&setting, 1});
        }
        rig = std::make_unique<SimulatedRig>(physics, camera, reference_plate(), 4);
    }

    CameraParameters camera = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml").camera.value();
    std::unique_ptr<SimulatedRig> rig;
};

TEST(SimulatedRig, Frames_ComeAtTheirRateAndAfterTheirLatency) {
    for (const double delay_s : {0.0, 0.03}) {
        SCOPED_TRACE(delay_s);
        RigAndCamera set({.delay_s = delay_s});
        int frames = 0;
        for (int k = 0; k < 500; ++k) {
            if (const auto frame = set.rig->poll()) {
                const double exposed_s = 0.0033 + 0.02 * static_cast<double>(frame->sequence);
                EXPECT_EQ(frame->time_ns, nanoseconds(exposed_s + delay_s));
                EXPECT_EQ(frame->arrival_ns, nanoseconds(exposed_s + delay_s + set.camera.latency_s));
                EXPECT_LE(frame->arrival_ns, set.rig->now_ns());
                EXPECT_GT(frame->arrival_ns + ns_per_ms, set.rig->now_ns());
                EXPECT_EQ(frame->sequence, static_cast<std::uint64_t>(frames++));
            }
            set.rig->write({});
        }
        EXPECT_EQ(frames, 1 + static_cast<int>((0.4995 - 0.0033 - delay_s - set.camera.latency_s) / 0.02));
    }
}

TEST(SimulatedRig, NobodyLooksForAWhile_TheNewestFrameIsHandedOut) {
    RigAndCamera set;
    for (int k = 0; k < 300; ++k) set.rig->write({});
    const auto frame = set.rig->poll();
    ASSERT_TRUE(frame);
    EXPECT_GT(frame->arrival_ns, set.rig->now_ns() - 20 * ns_per_ms);
    EXPECT_FALSE(set.rig->poll());
}

TEST(SimulatedRig, MovingCamera_AFrameShowsWhereItWasInTheMiddleOfTheExposure) {
    RigAndCamera set;
    Sight sight(set.camera, reference_plate());
    std::vector<double> past_mm;
    int seen = 0;
    for (int k = 0; k < 1500; ++k) {
        past_mm.push_back(plant::camera_position_mm(set.rig->truth()));
        if (const auto frame = set.rig->poll(); frame && k > 200) {
            const double tick = seconds(frame->time_ns) / 0.001;
            const auto before = static_cast<std::size_t>(tick);
            const double part = tick - static_cast<double>(before);
            const double truth_mm = past_mm[before] + part * (past_mm[before + 1] - past_mm[before]);
            if (const auto fit = sight.locate_anywhere(*frame)) {
                ++seen;
                EXPECT_NEAR(fit->position.s_mm, truth_mm, 0.0002);
            }
        }
        set.rig->write({0.0, 1.58});
    }
    EXPECT_EQ(seen, 65);
}

TEST(SimulatedRig, SkewedCameraClock_StampsItsOwnTime) {
    RigAndCamera set({.clock_rate = 1.005});
    int frames = 0;
    for (int k = 0; k < 1000; ++k) {
        if (const auto frame = set.rig->poll()) {
            const double shown_s = 0.0033 + 0.02 * static_cast<double>(frame->sequence);
            EXPECT_EQ(frame->time_ns, nanoseconds(shown_s));
            EXPECT_EQ(frame->arrival_ns, nanoseconds(shown_s / 1.005 + set.camera.latency_s));
            EXPECT_EQ(frame->sequence, static_cast<std::uint64_t>(frames++));
        }
        set.rig->write({});
    }
    EXPECT_EQ(frames, 1 + static_cast<int>(((0.9995 - set.camera.latency_s) * 1.005 - 0.0033) / 0.02));
}

TEST(SimulatedRig, DeviatingCamera_IsWhatTheFramesShow) {
    const plant::CameraDeviation deviation{.pixel_scale = 1.05};
    RigAndCamera set(deviation);
    for (int k = 0; k < 100; ++k) set.rig->write({});
    const auto frame = set.rig->poll();
    ASSERT_TRUE(frame);
    vision::TagDetector detector;
    const auto tags = detector.detect(frame->image, frame->time_ns);
    ASSERT_FALSE(tags.empty());
    const Eigen::Vector2d diagonal = tags[0].corners_px[1] - tags[0].corners_px[3];
    EXPECT_NEAR(diagonal.norm(), 1.05 * 300.0 * std::sqrt(2.0), 0.5);
}

/// A square tag seen by a tilted camera is none. If the corners on record were fitted with the rig file's
/// camera, which is not tilted, they would be those of a square, some hundredths of a pixel beside.
TEST(SimulatedRig, TiltedCamera_CornersOnRecordAreThoseOfThePicture) {
    const plant::CameraDeviation tilted{.tilt_rad = {0.002, 0.0015}};
    RigAndCamera set(tilted);
    Sight sight(set.camera, reference_plate());
    const plant::ActualCamera actual = plant::actual_camera(set.camera.geometry, tilted);
    for (int k = 0; k < 500; ++k) set.rig->write({});
    for (int seen = 0; seen < 10;) {
        set.rig->write({});
        const auto frame = set.rig->poll();
        if (!frame) continue;
        ++seen;
        const auto fit = sight.locate_anywhere(*frame);
        ASSERT_TRUE(fit);
        const std::vector<TagDetection> measured = sight.measured(*frame);
        ASSERT_EQ(measured.size(), 1u);
        const TagDetection& tag = measured.front();
        const auto corners_mm = vision::corners_mm(*vision::find_tag(reference_plate(), tag.tag_id));
        const double s_mm = plant::camera_position_mm(set.rig->truth());
        for (std::size_t c = 0; c < 4; ++c)
            EXPECT_LT((tag.corners_px[c] - actual.image_px(corners_mm[c], s_mm)).norm(), 0.01) << c;
    }
}

TEST(SimulatedRig, SnapshotRestored_SameReadingsAndSameBytes) {
    const std::vector<std::string> effects{"heater_delay:delay_ms=3.7", "second_thermal_mass",
                                           "macro_coupling", "hall_drift:rate_mV_per_s=20", "hall_crosstalk"};
    RigAndCamera first({}, effects), second({}, effects);
    for (int k = 0; k < 300; ++k) first.rig->write({4.0, 1.6});
    second.rig->restore(first.rig->snapshot());
    for (int k = 0; k < 200; ++k) {
        const auto a = first.rig->read(), b = second.rig->read();
        ASSERT_EQ(a.time_ns, b.time_ns);
        ASSERT_EQ(a.encoder_count, b.encoder_count);
        ASSERT_EQ(a.hall_adc, b.hall_adc);
        const auto f = first.rig->poll(), g = second.rig->poll();
        ASSERT_EQ(f.has_value(), g.has_value());
        if (f) {
            ASSERT_TRUE(std::equal(f->image.datastart, f->image.dataend, g->image.datastart));
        }
        first.rig->write({0.0, 1.5});
        second.rig->write({0.0, 1.5});
    }
}

}  // namespace
}  // namespace fidservo

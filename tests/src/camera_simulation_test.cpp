// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated camera in recordings: detections that are not made from images and frames with the real
// detector must agree, for any camera.
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/recording/reader.h"
#include "src/simulation/filmed_recording.h"
#include "src/simulation/simulate.h"
#include "tests/reference_rig.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

/// The wire heats up: the camera moves at some mm/s, uniformly within the table's cells.
Experiment heating() {
    return {
        .kind = "micro-steps", .duration_s = 0.7, .carriage_mm = 99.2, .micro_V = [](double) { return 1.5; }};
}

std::vector<plant::EffectSetting> settings(const std::vector<std::string>& texts) {
    std::vector<plant::EffectSetting> effects;
    effects.reserve(texts.size());
    for (const std::string& text : texts) effects.push_back(plant::parse_effect(text));
    return effects;
}

using ByTimeAndTag = std::map<std::pair<TimeNs, int>, std::array<Eigen::Vector2d, 4>>;

ByTimeAndTag corners_of(const Recording& recording) {
    ByTimeAndTag result;
    for (const TagDetection& tag : recording.detections) result[{tag.time_ns, tag.tag_id}] = tag.corners_px;
    return result;
}

class CameraOfARecording : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(CameraOfARecording, DetectionsWithAndWithoutImages_Agree) {
    Rig rig = reference_rig();
    rig.camera->corner_noise_px = 0.0;
    rig.camera->read_noise_e = 0.5;  // what is left is the detector's: 0.01 px
    rig.camera->full_well_e = 1e6;
    rig.camera->frame_rate_hz = 7.0;
    const auto effects = settings(GetParam());
    const ByTimeAndTag without = corners_of(simulate(rig, effects, heating(), "a", 3));
    const ByTimeAndTag with =
        corners_of(simulate(rig, effects, heating(), "a", 3, [](TimeNs, const cv::Mat&) {}));
    int compared = 0;
    double worst_px = 0.0;
    for (const auto& [key, corners] : without) {
        const auto found = with.find(key);
        if (found == with.end()) continue;  // the last frames are not over when the recording ends
        ++compared;
        for (std::size_t k = 0; k < 4; ++k)
            worst_px = std::max(worst_px, (corners[k] - found->second[k]).norm());
    }
    EXPECT_GE(compared, 4);
    // A perspective picture is fitted; a distorting lens shifts its corners by 0.04 px.
    const bool bends = GetParam().size() == 1 && GetParam()[0].starts_with("lens_distortion");
    EXPECT_LT(worst_px, bends ? 0.05 : 0.01);
    std::printf("%d frames, corners within %.4f px of each other\n", compared, worst_px);
}

INSTANTIATE_TEST_SUITE_P(
    Effects, CameraOfARecording,
    ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"pixel_scale:factor=0.97"},
                      std::vector<std::string>{"camera_rotation:angle_deg=2"},
                      std::vector<std::string>{"camera_tilt:about_u_deg=0.87,about_v_deg=0.5"},
                      std::vector<std::string>{"lens_distortion:k1=-0.1"},
                      std::vector<std::string>{"clock_skew:skew_ppm=3000", "camera_latency:delay_ms=12"},
                      std::vector<std::string>{"motion_blur:extra_exposure_ms=8"},
                      std::vector<std::string>{"rolling_shutter:readout_ms=12"},
                      std::vector<std::string>{"rolling_shutter:readout_ms=-12",
                                               "camera_rotation:angle_deg=-3",
                                               "motion_blur:extra_exposure_ms=3"}));

TEST(ClockSkew, SkewedClock_StampsTrueTimesTimesItsRate) {
    // The same motion, seen by a clock that runs 2000 ppm fast: a stamp c shows where the camera was at
    // c/1.002.
    Rig rig = reference_rig();
    rig.camera->corner_noise_px = 0.0;
    const Experiment rise{
        .kind = "micro-steps", .duration_s = 3.0, .carriage_mm = 99.2, .micro_V = [](double t_s) {
            return 1.4 + 0.05 * t_s;
        }};
    const Recording fast = simulate(rig, settings({"clock_skew:skew_ppm=2000"}), rise, "a", 3);
    rig.camera->frame_rate_hz = 1000.0;
    const Recording right = simulate(rig, {}, rise, "a", 3);
    ASSERT_EQ(right.detections.size(), 2997U);
    // The corner's place on the plate's own grid, whichever tag it is of.
    const auto place_px = [](const TagDetection& tag) { return tag.corners_px[0].x() - 500.0 * tag.tag_id; };
    double worst_px = 0.0, largest_shift_px = 0.0;
    for (const TagDetection& tag : fast.detections) {
        const auto place_at = [&](double time_ms) {
            const double row = time_ms - 3.3;
            const auto before = std::min(static_cast<std::size_t>(row), right.detections.size() - 2);
            const double from = place_px(right.detections[before]),
                         to = place_px(right.detections[before + 1]);
            return from + (row - static_cast<double>(before)) * (to - from);
        };
        const double stamp_ms = 1e3 * seconds(tag.time_ns);
        if (stamp_ms < 10.0 || stamp_ms > 2990.0) continue;
        worst_px = std::max(worst_px, std::abs(place_px(tag) - place_at(stamp_ms / 1.002)));
        largest_shift_px = std::max(largest_shift_px, std::abs(place_px(tag) - place_at(stamp_ms)));
    }
    EXPECT_GT(largest_shift_px, 0.5);
    EXPECT_LT(worst_px, 0.01);
}

TEST(FilmedRecording, Folder_HasTheFramesAndWhatIsFoundInThem) {
    const Rig& rig = reference_rig();
    const fidservo::testing::TemporaryFolder folder;
    const auto effects = settings({"camera_latency:delay_ms=7"});
    Experiment experiment = heating();
    experiment.duration_s = 0.1;
    write_filmed_recording(folder / "film", rig, effects, experiment, "a", 3);
    const Recording recording = read_recording(folder / "film");
    ASSERT_EQ(recording.rows.size(), 100U);
    ASSERT_EQ(recording.frames.size(), 5U);
    for (std::size_t k = 0; k < recording.frames.size(); ++k) {
        EXPECT_EQ(recording.frames[k].time_ns, 10'300'000 + static_cast<TimeNs>(k) * 20'000'000);
        const cv::Mat image = cv::imread((folder / "film/cam0/data" / recording.frames[k].filename).string(),
                                         cv::IMREAD_UNCHANGED);
        EXPECT_EQ(image.size(), cv::Size(1280, 960));
        EXPECT_EQ(image.type(), CV_8UC1);
    }
    EXPECT_GE(recording.detections.size(), 5U);
    EXPECT_EQ(recording.detections.front().time_ns, recording.frames.front().time_ns);
}

TEST(FilmedRecording, StageRows_AreThoseWithoutFrames) {
    const Rig& rig = reference_rig();
    Experiment experiment = heating();
    experiment.duration_s = 0.1;
    const Recording plain = simulate(rig, {}, experiment, "a", 3);
    const Recording filmed = simulate(rig, {}, experiment, "a", 3, [](TimeNs, const cv::Mat&) {});
    for (std::size_t k = 0; k < plain.rows.size(); ++k) {
        EXPECT_EQ(plain.rows[k].hall_adc, filmed.rows[k].hall_adc);
        EXPECT_EQ(plain.rows[k].encoder_count, filmed.rows[k].encoder_count);
    }
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Appearances of tags predicted from a camera, and the diagnosis of frames of the simulated rig.
#include "gap/links/image_link.h"

#include "core/rig.h"
#include "gap/candidates/candidate.h"
#include "gap/diagnose.h"
#include "src/diagnose/frame_looks.h"
#include "tests/effort.h"
#include "tests/gap/effect_names.h"
#include "tests/gap/looks.h"
#include "tests/gap/simulated_campaign.h"

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo {
namespace {

using namespace gap;
using testing::effects;
using testing::looks_in_even_motion;
using testing::names;

/// R.m.s. error in floors of each value; the speed of edges is only known in frames with neighbours on both
/// sides.
std::map<std::size_t, double> errors_of(const plant::CameraDeviation& claimed, Recording recording) {
    const CameraParameters camera = *reference_rig().camera;
    const ImageRun run = image_run(recording, camera);
    std::map<std::size_t, double> squares;
    for (const ImageErrors& errors : image_errors({camera, claimed}, recording, run))
        for (std::size_t k = 0; k < image_values; ++k)
            if (!std::isnan(errors[k])) squares[k] += errors[k] * errors[k] / 50.0;
    for (auto& [k, square] : squares) square = std::sqrt(square);
    return squares;
}

TEST(ImageLink, TrueCamera_HasNoErrors) {
    for (const plant::CameraDeviation& truth :
         {plant::CameraDeviation{}, plant::CameraDeviation{.extra_exposure_s = 4e-3, .extra_blur_px = 1.5},
          plant::CameraDeviation{.extra_read_noise_e = 60.0,
          .gain_spread = 0.02,
          .light_gradient = {0.2, -0.1},
          .vignetting = 0.3}}) {
        const std::map<std::size_t, double> errors = errors_of(truth, looks_in_even_motion(truth));
        ASSERT_EQ(errors.size(), image_values);
        for (const auto& [k, error] : errors) EXPECT_LT(error, 0.01) << "value " << k;
    }
}

TEST(ImageLink, EachCause_ShowsInItsOwnValuesOnly) {
    const Recording plain = looks_in_even_motion({});
    const auto off = [&](const plant::CameraDeviation& claimed) {
        std::string flags;
        for (const auto& [k, error] : errors_of(claimed, plain)) flags += error > 0.5 ? '!' : '.';
        return flags;
    };
    EXPECT_EQ(off({.extra_blur_px = 1.0}), "!!!!......");
    EXPECT_EQ(off({.extra_exposure_s = 5e-3}), ".!.!......");
    EXPECT_EQ(off({.light_gradient = {0.2, 0.0}}), "....!!!!..");
    EXPECT_EQ(off({.extra_read_noise_e = 30.0}), "........!!");
    EXPECT_EQ(off({.delay_s = 0.01, .readout_s = 0.01}), "..........");
}

/// Paper that compression has made uniformly grey has no noise that could be compared.
TEST(ImageLink, StripOfOneGrey_IsJudgedByItsOtherValuesOnly) {
    Recording recording = looks_in_even_motion({});
    for (TagAppearance& seen : recording.appearances) seen.white.variance_grey2 = 0.0;
    const CameraParameters camera = *reference_rig().camera;
    const ImageRun run = image_run(recording, camera);
    for (const ImageErrors& errors : image_errors({camera, {}}, recording, run))
        for (std::size_t k = 0; k < image_values; ++k)
            EXPECT_EQ(std::isfinite(errors[k]), k != 8) << "value " << k;
}

TEST(ImageLink, FramesOfAnotherClock_AreNotJudged) {
    Recording recording = looks_in_even_motion({});
    constexpr TimeNs unix_time_ns = 1'700'000'000'000'000'000;
    for (TagDetection& detection : recording.detections) detection.time_ns += unix_time_ns;
    for (TagAppearance& seen : recording.appearances) seen.time_ns += unix_time_ns;
    EXPECT_TRUE(image_run(recording, *reference_rig().camera).windows.empty());
    EXPECT_TRUE(recording.appearances.empty());
}

TEST(ImageLink, EveryFrameWithNeighbours_IsAWindow) {
    Recording recording = looks_in_even_motion({});
    const ImageRun run = image_run(recording, *reference_rig().camera);
    ASSERT_EQ(run.windows.size(), 46U);
    EXPECT_EQ(run.windows.front().first_row, 43U);
    EXPECT_EQ(run.windows.front().end_row, 63U);
    for (std::size_t k = 0; k < run.windows.size(); ++k) {
        EXPECT_EQ(run.windows[k].first, k);
        EXPECT_EQ(run.windows[k].end, k + 1);
    }
}

TEST(ImageLink, MeanSquareThatAWindowExpects_IsThatOfNoiseAndOfErrorsWithinTheirAllowance) {
    Recording still = looks_in_even_motion({}, 0.0);
    const ImageRun run = image_run(still, *reference_rig().camera);
    const TagAppearance& seen = still.appearances.front();
    double sum = 0.0;
    const auto add = [&](double noise, double allowance) {
        const double floor2 = noise * noise + allowance * allowance;
        sum += (noise * noise + allowance * allowance / 3.0) / floor2;
    };
    for (const TagSide& side : seen.sides) {
        add(side.variance_std_px2 / side.variance_px2, 0.02);
        add(side.white_std_grey / side.white_grey, 2e-3);
    }
    add(seen.white.std_share, 0.06);
    add(seen.black.std_share, 0.06);
    EXPECT_NEAR(run.windows.front().expected_square, sum / image_values, 1e-3);
    still.appearances.front().sides[0] = {};  // not measured: the other values count
    EXPECT_GT(image_run(still, *reference_rig().camera).windows.front().expected_square, 0.3);
}

TEST(ImageLink, TagThatStartsBetweenTwoFrames_IsNotJudgedThere) {
    // The differences to both neighbours of frame 20 are equal, and yet it is at rest there.
    Recording recording = looks_in_even_motion({});
    for (std::size_t frame = 0; frame < recording.detections.size(); ++frame) {
        const double u_px = frame <= 20 ? 200.0 : 200.0 + 140.0 * static_cast<double>(frame - 20);
        TagDetection& tag = recording.detections[frame];
        for (std::size_t k = 0; k < 4; ++k)
            tag.corners_px[k] = Eigen::Vector2d(u_px, 480.0) + 150.0 * tag_corners[k];
    }
    const TimeNs start_ns = recording.detections[20].time_ns;
    image_run(recording, *reference_rig().camera);
    EXPECT_GT(recording.appearances.size(), 40U);
    for (const TagAppearance& judged : recording.appearances) EXPECT_NE(judged.time_ns, start_ns);
}

TEST(ImageLink, WithoutFrames_NoEffectOfTheImageIsTried) {
    const Evidence evidence = testing::campaign({}, {"rest"});
    for (const Candidate& candidate : candidates(evidence, {}, {}))
        EXPECT_NE(candidate.effect->block, "camera.image");
    EXPECT_TRUE(std::isnan(evidence.floor(Signal::image)));
}

/// A quarter of the reference image, so that rendering takes less.
Rig small_image_rig() {
    Rig rig = reference_rig();
    rig.camera->geometry.width_px = 640;
    rig.camera->geometry.height_px = 480;
    rig.camera->geometry.principal_point_px = {319.5, 239.5};
    return rig;
}

Diagnosis diagnosed_with_frames(const Hypothesis& truth) {
    const Rig rig = small_image_rig();
    std::vector<Recording> recordings;
    for (const char* kind : {"micro-steps", "macro-square"})
        for (const std::uint64_t seed : {31, 32}) {
            const std::string name = std::string(kind) + "-" + std::to_string(seed);
            Experiment experiment = make_experiment(kind, rig, seed, name);
            experiment.duration_s = 4.7;
            std::vector<std::pair<TimeNs, cv::Mat>> frames;
            recordings.push_back(
                simulate(rig, truth, experiment, name, seed,
                         [&](TimeNs time_ns, const cv::Mat& image) { frames.emplace_back(time_ns, image); }));
            for (const auto& [time_ns, image] : frames)
                diagnose::add_appearances(recordings.back(), time_ns, image);
        }
    return gap::diagnose({rig, std::move(recordings)}, {});
}

TEST(SlowImageEffects, RigAsItsFileSays_HasNoGap) {
    const Diagnosis diagnosis = diagnosed_with_frames({});
    EXPECT_EQ(diagnosis.verdict, Verdict::no_gap) << diagnosis.gap.before;
    const auto image = std::ranges::find(diagnosis.signals, Signal::image, &SignalGap::signal);
    ASSERT_NE(image, diagnosis.signals.end());
    EXPECT_LT(image->before, 1.05);
    EXPECT_GT(image->before, 0.3);
}

TEST(SlowImageEffects, EachEffect_IsNamedWithItsSize) {
    struct Case {
        std::string_view text;
        std::string_view name;
        std::vector<double> values;
        std::vector<double> tolerances;
    };
    // The last three are also among the known cases of the self-check.
    const std::array all{
        Case{"uneven_light:gradient_u=-0.1,gradient_v=0.15,vignetting=0.2",
             "uneven_light",
             {-0.1, 0.15, 0.2},
             {0.01, 0.01, 0.05}},
        Case{"sensor_noise:read_noise_e=40,gain_spread=0.01", "sensor_noise", {40.0, 0.01}, {2.0, 1e-3}},
        Case{"defocus:blur_px=0.8", "defocus", {0.8}, {0.03}},
        Case{"motion_blur:extra_exposure_ms=8", "motion_blur", {8.0}, {0.4}},
        Case{"rolling_shutter:readout_ms=3", "rolling_shutter", {3.0}, {0.1}}};
    for (const Case& one : std::span(all).first(static_cast<std::size_t>(testing::draws(5, 2)))) {
        const Diagnosis diagnosis = diagnosed_with_frames(effects({one.text}));
        EXPECT_EQ(names(diagnosis), std::vector<std::string>{std::string(one.name)}) << diagnosis.gap.before;
        if (diagnosis.effects.empty()) continue;
        EXPECT_EQ(diagnosis.verdict, Verdict::explained) << one.text;
        EXPECT_EQ(diagnosis.where.front().block, "camera.image");
        const std::vector<FittedParameter>& found = diagnosis.effects.front().parameters;
        for (std::size_t k = 0; k < one.values.size(); ++k)
            EXPECT_NEAR(found[k].value, one.values[k], one.tolerances[k])
                << one.text << ", std " << found[k].std;
    }
}

}  // namespace
}  // namespace fidservo

// The effects' equations against an independent model's: one value, estimated on one recording of a rig with
// the effect, must explain the readings of all others.
#include "plant/effects/catalogue.h"
#include "src/recording/reader.h"
#include "tests/plant/campaign_residual.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// The value of an effect's only parameter with the smallest Hall residual: golden-section search, the
/// residual grows to either side.
double estimated_value(const Effect& effect, const Recording& recording) {
    double low = effect.parameters[0].low, high = effect.parameters[0].high;
    const double shrink = 1.0 / std::numbers::phi;
    const auto rms_lsb = [&](double value) {
        const EffectSetting setting{&effect, {value}};
        return hall_residual(make_stage_plant(reference_rig(), {&setting, 1}), recording).rms_lsb;
    };
    constexpr double resolution = 1e-6;
    while (high - low > resolution) {
        const double left = high - shrink * (high - low);
        const double right = low + shrink * (high - low);
        if (rms_lsb(left) < rms_lsb(right))
            high = right;
        else
            low = left;
    }
    return 0.5 * (low + high);
}

class PracticeCampaign : public testing::TestWithParam<std::string_view> {};

TEST_P(PracticeCampaign, ValueOfOneRecording_ExplainsTheOthersToTheNoiseFloor) {
    const Effect& effect = *find_effect(GetParam());
    const auto recordings = campaign(effect.name);
    if (recordings.empty()) GTEST_SKIP() << "the shared data are absent";
    const auto estimated_on = std::ranges::find(recordings, "micro-triangle-1",
                                                [](const auto& path) { return path.filename().string(); });
    ASSERT_NE(estimated_on, recordings.end());
    const EffectSetting setting{&effect, {estimated_value(effect, read_recording(*estimated_on))}};
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = make_stage_plant(reference_rig(), {&setting, 1});

    std::printf("%s %.4f, by micro-triangle-1\n", effect.parameters[0].name.data(), setting.values[0]);
    std::printf("recording           Hall r.m.s., LSB: nominal   with it  expected   sigma\n");
    double worst_nominal_lsb = 0.0;
    for (const auto& path : recordings) {
        const Recording recording = read_recording(path);
        SCOPED_TRACE(recording.name);
        const HallResidual before = hall_residual(nominal, recording),
                           after = hall_residual(plant, recording);
        std::printf("%-18s                  %9.4f  %8.4f  %8.4f  %+6.2f\n", recording.name.c_str(),
                    before.rms_lsb, after.rms_lsb, after.expected_rms_lsb, after.sigma());
        worst_nominal_lsb = std::max(worst_nominal_lsb, before.rms_lsb);
        EXPECT_LE(std::abs(after.sigma()), 4.0);
    }
    EXPECT_GT(worst_nominal_lsb, 3.0) << "there must be something to explain";
}

INSTANTIATE_TEST_SUITE_P(MicroStage, PracticeCampaign, testing::Values("airflow", "hall_nonlinearity"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace fidservo::plant

// SPDX-License-Identifier: GPL-3.0-or-later
// Fed with the commands of recordings that an independent model of the reference rig made, the plant must
// follow the recorded encoder and Hall readings to their noise floor.
#include "src/files/recording/reader.h"
#include "tests/campaign.h"
#include "tests/plant/campaign_residual.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

TEST(NoEffectCampaign, RecordedCommands_GiveTheRecordedReadingsToTheNoiseFloor) {
    const auto recordings = testing::campaign("no-effect");
    if (recordings.empty()) GTEST_SKIP() << "the shared data are absent";
    EXPECT_EQ(recordings.size(), 16u);
    const StagePlant plant = make_stage_plant(reference_rig());
    const double count_floor = std::sqrt(1.0 / 12.0);
    const double noise_lsb = plant.micro->hall.parameters.noise_lsb;
    const double hall_floor_lsb = std::sqrt(noise_lsb * noise_lsb + 1.0 / 12.0);

    std::printf(
        "                            encoder, counts (floor %.4f)         Hall, LSB (floor %.4f)\n"
        "recording           ticks   wrong  r.m.s.  beyond  unrounded     r.m.s.  expected   sigma\n",
        count_floor, hall_floor_lsb);
    double worst_count_rms = 0.0, worst_beyond = 0.0, worst_hall_sigma = 0.0;
    for (const auto& path : recordings) {
        const Recording recording = read_recording(path);
        SCOPED_TRACE(recording.name);
        const EncoderResidual encoder = best_encoder_residual(plant, recording);
        const HallResidual hall = hall_residual(plant, recording);
        const double beyond = std::max(0.0, encoder.largest - 0.5);
        std::printf("%-18s %6zu   %5d  %.4f  %.5f     %.4f     %.4f    %.4f   %+5.2f\n",
                    recording.name.c_str(), recording.rows.size(), encoder.wrong_counts, encoder.count_rms,
                    beyond, encoder.position_rms, hall.rms_lsb, hall.expected_rms_lsb, hall.sigma());
        worst_count_rms = std::max(worst_count_rms, encoder.count_rms);
        worst_beyond = std::max(worst_beyond, beyond);
        worst_hall_sigma = std::max(worst_hall_sigma, std::abs(hall.sigma()));

        // Commands are recorded to 1e-7 V and the rig file's gain to 1e-8, which make some 1e-5 counts over a
        // run. The excess over the half count of rounding may hardly be larger; it changes a reading only at
        // the edge of a count.
        EXPECT_LE(beyond, 1e-4);
        EXPECT_LE(encoder.count_rms, 0.1 * count_floor);
        EXPECT_LE(std::abs(hall.sigma()), 4.0);
    }
    std::printf("worst: encoder %.4f counts r.m.s., %.5f beyond rounding; Hall %.2f sigma from its floor\n",
                worst_count_rms, worst_beyond, worst_hall_sigma);
}

}  // namespace
}  // namespace fidservo::plant

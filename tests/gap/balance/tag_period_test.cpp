// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/tag_period.h"

#include "gap/links/tag_sight.h"
#include "tests/gap/hidden_formula.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// A wave along the rail, and an offset that differs from window to window.
Errors wave_in_tags(const Evidence& evidence, double amplitude_floors, double period_mm) {
    Errors errors(evidence.windows().back().end, std::numeric_limits<float>::quiet_NaN());
    for (const Window& window : evidence.windows())
        for (std::size_t i = 0; window.signal == Signal::tag && window.begin + corner_values * i < window.end;
             ++i) {
            const double place_mm = sight_of(evidence, window.run, window.first_detection + i).position_mm;
            errors[window.begin + corner_values * i] = static_cast<float>(
                amplitude_floors * std::sin(2.0 * std::numbers::pi * place_mm / period_mm + 1.0) +
                static_cast<double>(window.first_row % 7));
        }
    return errors;
}

TEST(TagPeriod, OfAWaveInTheTags_IsItsPeriod) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses", "macro-square", "micro-servo"});
    for (const double period_mm : {5.2, 9.3, 17.0})
        EXPECT_NEAR(strongest_tag_period_mm(evidence, wave_in_tags(evidence, 10.0, period_mm)), period_mm,
                    0.05 * period_mm);
}

/// What stands tells most of it: no offset of a window is free.
TEST(TagPeriod, OfAWaveAlongTheCamerasWay_IsFoundToAHundredth) {
    const Evidence evidence =
        testing::campaign({testing::hidden_formula("camera.x", "camera.geometry",
                                                   "size * sin(2 * pi * camera_place / 12)", 0.1)},
                          {"macro-square", "integrated"});
    const Errors errors = evidence.errors({}, everything(evidence));
    EXPECT_NEAR(strongest_tag_period_mm(evidence, errors, WaveOf::camera), 12.0, 0.12);
}

TEST(TagPeriod, WithoutTags_IsNone) {
    Recording recording = testing::recordings_of({}, {"macro-pulses"}).front();
    recording.detections.clear();
    const Evidence evidence(reference_rig(), {std::move(recording)});
    EXPECT_EQ(strongest_tag_period_mm(evidence, wave_in_tags(evidence, 10.0, 9.3)), 0.0);
}

}  // namespace

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/thinned.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::diagnose {
namespace {

Recording lasting(const std::string& name, double duration_s) {
    Recording recording;
    recording.name = name;
    recording.tick_s = 0.1;
    const auto rows = static_cast<std::size_t>(std::lround(duration_s / recording.tick_s));
    recording.rows.resize(rows);
    for (std::size_t k = 0; k < rows; ++k) {
        recording.rows[k].time_ns = static_cast<TimeNs>(k) * 100'000'000;
        if (k % 10 == 0) {
            recording.detections.emplace_back();
            recording.detections.back().time_ns = recording.rows[k].time_ns;
        }
    }
    return recording;
}

double duration_s(const std::vector<Recording>& recordings) {
    double sum_s = 0.0;
    for (const Recording& recording : recordings)
        sum_s += static_cast<double>(recording.rows.size()) * recording.tick_s;
    return sum_s;
}

TEST(Thinned, TenMinutes_StayAsTheyAre) {
    std::vector<std::string> notes;
    const auto kept = thinned({lasting("a", 300.0), lasting("b", 300.0)}, notes);
    EXPECT_EQ(kept.size(), 2U);
    EXPECT_EQ(kept[0].rows.size(), 3000U);
    EXPECT_TRUE(notes.empty());
}

TEST(Thinned, WhatHoldsForTheWhole_HoldsForItsParts) {
    std::vector<std::string> notes;
    Recording hour = lasting("hour", 3600.0);
    hour.rig = "r";
    hour.encoder_zero = EncoderZero{-3.0, 0.1, "end stop"};
    hour.plate = {{.id = 3, .centre_mm = {1.0, 0.0}, .side_mm = 1.2}};
    hour.macro_setpoint_step_mm = 1e-2;
    for (const Recording& part : thinned({hour}, notes)) {
        EXPECT_TRUE(part.name.starts_with("hour from "));
        EXPECT_EQ(part.rig, "r");
        EXPECT_EQ(part.encoder_zero->count, -3.0);
        EXPECT_EQ(part.plate, hour.plate);
        EXPECT_EQ(part.macro_setpoint_step_mm, 1e-2);
        EXPECT_EQ(part.tick_s, hour.tick_s);
    }
}

TEST(Thinned, AnHour_IsTenMinutesSpreadOverIt_AndShortOnesStay) {
    std::vector<std::string> notes;
    const auto kept = thinned({lasting("short", 60.0), lasting("hour", 3600.0)}, notes);
    EXPECT_EQ(kept.front().name, "short");
    EXPECT_EQ(kept.front().rows.size(), 600U);
    EXPECT_NEAR(duration_s(kept), 600.0, 60.0);
    EXPECT_EQ(notes.size(), 1U);
    const Recording& last = kept.back();
    EXPECT_GT(last.rows.front().time_ns, 3000'000'000'000);
    ASSERT_FALSE(last.detections.empty());
    EXPECT_EQ(last.detections.front().time_ns, last.rows.front().time_ns);
    EXPECT_LE(last.detections.back().time_ns, last.rows.back().time_ns);
    for (std::size_t k = 1; k < kept.size(); ++k) EXPECT_EQ(kept[k].rows.size(), 600U);
}

}  // namespace
}  // namespace fidservo::diagnose

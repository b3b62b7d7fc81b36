#include "core/failure.h"
#include "src/config/rig_file.h"
#include "src/identify/identify.h"
#include "tests/src/message_of.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using testing::message_of;

/// A carriage with tau = 50 ms and K = 40 mm/s/V, driven back and forth, its position exact to 1 um.
IdentifyInput direct_drive(double zero_mm) {
    constexpr double tau_s = 0.05, gain = 40.0, tick_s = 0.001;
    Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    rig.macro.dead_zone = {};
    rig.macro.encoder_resolution_mm = 0.001;
    Recording recording;
    recording.name = "direct";
    recording.tick_s = tick_s;
    recording.columns.macro_command = recording.columns.position = true;
    double place_mm = zero_mm, speed = 0.0;
    for (int k = 0; k < 3000; ++k) {
        StageRow row;
        row.time_ns = k * ns_per_ms;
        row.macro_command_V = (k / 250) % 2 == 0 ? 2.0 : -2.0;
        row.position_mm = 0.001 * std::round(1000.0 * place_mm);
        recording.rows.push_back(row);
        const double excess = speed - gain * row.macro_command_V, kept = std::exp(-tick_s / tau_s);
        place_mm += gain * row.macro_command_V * tick_s + excess * tau_s * (1.0 - kept);
        speed = gain * row.macro_command_V + excess * kept;
    }
    return {std::move(rig), {recording}, std::nullopt, 0.0};
}

double value_of(const Identified& identified, const std::string& key) {
    const auto found = std::ranges::find(identified.values, key, &IdentifiedValue::key);
    return found == identified.values.end() ? NAN : found->value;
}

TEST(IdentifyMacro, DirectDrive_GivesRigFileKeysAndNoEffects) {
    const Identified identified = identify_macro(direct_drive(100.0));
    EXPECT_NEAR(value_of(identified, "macro.velocity_gain_mm_per_s_per_V"), 40.0, 0.01);
    EXPECT_NEAR(value_of(identified, "macro.velocity_pole"), std::exp(-0.001 / 0.05), 1e-5);
    EXPECT_NEAR(value_of(identified, "time_constant"), 0.05, 1e-4);
    EXPECT_TRUE(identified.effects.empty());
    EXPECT_TRUE(identified.undetermined.empty());
    ASSERT_EQ(identified.residuals.size(), 1U);
    EXPECT_NEAR(identified.residuals[0].rms, *identified.residuals[0].floor, 0.02);
}

TEST(IdentifyMacro, UnknownOrigin_IsSaid) {
    const Identified identified = identify_macro(direct_drive(-40.0));
    EXPECT_NEAR(value_of(identified, "macro.velocity_gain_mm_per_s_per_V"), 40.0, 0.01);
    EXPECT_THAT(identified.notes, Contains(HasSubstr("zero is taken as unknown")));
}

TEST(IdentifyMacro, RecordingAtRest_SaysWhy) {
    IdentifyInput input = direct_drive(100.0);
    for (StageRow& row : input.recordings[0].rows) row.macro_command_V = 0.0, row.position_mm = 100.0;
    const Identified identified = identify_macro(input);
    EXPECT_TRUE(identified.values.empty());
    EXPECT_THAT(identified.undetermined,
                Contains(Field(&Undetermined::reason, HasSubstr("command was zero"))));
}

TEST(IdentifyMacro, RecordingWithoutPosition_IsRefused) {
    IdentifyInput input = direct_drive(100.0);
    input.recordings[0].columns.position = false;
    EXPECT_THAT(
        message_of([&] { static_cast<void>(identify_macro(input)); }),
        HasSubstr("direct: identify macro needs macro_command [V] and encoder [count] or position [mm]"));
}

TEST(IdentifyMacro, MissingRows_SplitTheRecording) {
    IdentifyInput input = direct_drive(100.0);
    auto& rows = input.recordings[0].rows;
    rows.erase(rows.begin() + 1200, rows.begin() + 1300);
    rows[600].position_mm = not_in_force;
    EXPECT_NEAR(value_of(identify_macro(input), "macro.velocity_gain_mm_per_s_per_V"), 40.0, 0.01);
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// What a rig file may say about its stage.
#include "src/files/rig/stage_keys.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "tests/src/temporary_folder.h"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;

/// The example of docs/devices.md, one piece replaced.
std::string example(const std::string& piece = "", const std::string& by = "") {
    std::string text = R"(comedi:
  macro:   { subdevice: 1, channel: 0, range_V: [-5, 5] }
  micro:   { subdevice: 1, channel: 1 }
  hall:    { subdevice: 0, channel: 0 }
  encoder: { subdevice: 4, channel: 0 }
watchdog: { late_ticks: 20 }
)";
    if (!piece.empty()) text.replace(text.find(piece), piece.size(), by);
    return text;
}

StageKeys keys_of(const std::string& text) {
    return read_stage_keys(YamlValue::parse(text, "rig.yaml"));
}

std::string refusal(const std::string& text) {
    try {
        (void)keys_of(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no refusal";
}

TEST(StageKeys, Example_IsTakenAsItStands) {
    const StageKeys keys = keys_of(example());
    const control::comedi::ChannelMap& map = keys.comedi.value();
    EXPECT_EQ(map.macro.output.range, (control::comedi::VoltageRange{-5.0, 5.0}));
    EXPECT_FALSE(map.macro.reversed);
    EXPECT_FALSE(map.macro.direction);
    EXPECT_EQ(map.micro.channel, 1);
    EXPECT_EQ(map.encoder.input.subdevice, 4);
    EXPECT_FALSE(map.encoder.mm_per_V);
    EXPECT_EQ(keys.watchdog.late_ticks, 20);
}

TEST(StageKeys, DirectionReversalAndPositionInVolts_AreTaken) {
    const auto macro =
        keys_of(example("range_V: [-5, 5]", "reversed: true, direction: { subdevice: 3, channel: 7 }"))
            .comedi.value()
            .macro;
    EXPECT_TRUE(macro.reversed);
    EXPECT_EQ(macro.direction.value().channel, 7);
    const auto encoder =
        keys_of(example("subdevice: 4, channel: 0", "subdevice: 0, channel: 1, mm_per_V: 20, reversed: true"))
            .comedi.value()
            .encoder;
    EXPECT_EQ(encoder.mm_per_V, 20.0);
    EXPECT_TRUE(encoder.reversed);
}

TEST(StageKeys, WrongKeysAndValues_AreNamed) {
    EXPECT_THAT(refusal(example("hall:    {", "hal:    {")), HasSubstr("comedi.hal"));
    EXPECT_THAT(refusal(example("  micro:   { subdevice: 1, channel: 1 }\n", "")),
                HasSubstr("comedi.micro: missing"));
    EXPECT_THAT(refusal(example("[-5, 5]", "[5, -5]")), HasSubstr("comedi.macro.range_V"));
    EXPECT_THAT(refusal(example("subdevice: 4", "subdevice: -1")), HasSubstr("comedi.encoder.subdevice: -1"));
    EXPECT_THAT(refusal(example("subdevice: 4", "range_V: [0, 5], subdevice: 4")),
                HasSubstr("mm_per_V is missing"));
    EXPECT_THAT(refusal(example("late_ticks: 20", "late_ticks: 2")), HasSubstr("watchdog.late_ticks: 2"));
    EXPECT_THAT(refusal(example("late_ticks", "later_ticks")), HasSubstr("watchdog.later_ticks"));
}

TEST(StageKeys, InARigFile_AreCheckedWithIt) {
    const testing::TemporaryFolder folder;
    std::ifstream in(FIDSERVO_ASSETS_DIR "/rig.yaml");
    std::string rig{std::istreambuf_iterator<char>(in), {}};
    rig.replace(rig.find("preisach_fod.csv"), 16, FIDSERVO_ASSETS_DIR "/preisach_fod.csv");
    const auto file = folder.write("rig.yaml", rig + "stage:\n  watchdog: { wire_limit_degC: 120 }\n");
    const Rig loaded = load_rig(file);
    EXPECT_DOUBLE_EQ(watchdog_params(loaded, load_stage_keys(file).watchdog).wire_limit_degC, 120.0);
    EXPECT_DOUBLE_EQ(watchdog_params(loaded, {}).wire_limit_degC, 135.0);
    EXPECT_FALSE(load_stage_keys(file).comedi);
    const auto wrong = folder.write("wrong.yaml", rig + "stage: { comedy: {} }\n");
    EXPECT_THROW((void)load_rig(wrong), InputError);
}

}  // namespace
}  // namespace fidservo

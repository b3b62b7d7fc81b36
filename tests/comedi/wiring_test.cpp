// SPDX-License-Identifier: GPL-3.0-or-later
// Channel maps against boards.
#include "control/comedi/wiring.h"

#include "core/input_error.h"
#include "tests/comedi/fake_board.h"
#include "tests/reference_rig.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::control::comedi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const ChannelMap& map, const std::vector<FakeSubdevice>& board) {
    try {
        (void)wire(map, FakeBoard(board, std::make_shared<FakeRegisters>()), reference_rig());
    } catch (const InputError& error) {
        return error.what();
    }
    return "no refusal";
}

Wiring wired(const ChannelMap& map, const std::vector<FakeSubdevice>& board) {
    return wire(map, FakeBoard(board, std::make_shared<FakeRegisters>()), reference_rig());
}

TEST(Wiring, NumberOfVolts_EndsAndMiddleOfTheRange) {
    const Terminal terminal{{}, {-5.0, 5.0}, 4095};
    EXPECT_EQ(number_of(terminal, -5.0), 0U);
    EXPECT_EQ(number_of(terminal, 5.0), 4095U);
    EXPECT_EQ(number_of(terminal, 0.0), 2048U);  // 2047.5, rounded
    EXPECT_EQ(number_of(terminal, 7.0), 4095U);
    EXPECT_EQ(number_of(terminal, -7.0), 0U);
    for (const std::uint32_t number : {0U, 1U, 2000U, 4095U})
        EXPECT_EQ(number_of(terminal, volts_of(terminal, number)), number);
}

TEST(Wiring, MultiQ3_FitsThePapersStage) {
    const Wiring wiring = wired(multiq3_map(), multiq3());
    EXPECT_EQ(wiring.macro.range, (VoltageRange{-5.0, 5.0}));
    EXPECT_EQ(wiring.micro.max_value, 0xfffU);
    EXPECT_FALSE(wiring.counts_per_V);
    EXPECT_EQ(wiring.encoder.max_value, 0xffffffU);
    EXPECT_DOUBLE_EQ(wiring.hall_lsb_V, 5.0 / 4096.0);
}

TEST(Wiring, NoRangeGiven_NarrowestThatSuffices) {
    ChannelMap map = multiq3_map();
    map.encoder = {{0, 1, {}}, false, 20.0};
    const Wiring wiring = wired(map, analogue_board());
    EXPECT_EQ(wiring.macro.range, (VoltageRange{-5.0, 5.0}));
    EXPECT_EQ(wiring.macro.at.range, 1);
    ASSERT_TRUE(wiring.counts_per_V);
    EXPECT_DOUBLE_EQ(*wiring.counts_per_V, 400.0);  // 20 mm/V of 0.05 mm
}

TEST(Wiring, DirectionByALine_OutputHasTheAmountOnly) {
    auto board = multiq3();
    board[1].ranges = {{0.0, 5.0}};
    ChannelMap map = multiq3_map();
    EXPECT_THAT(refusal(map, board), HasSubstr("stage.comedi.macro.range_V: none given: "));
    map.macro.direction = ChannelChoice{3, 2, {}};
    EXPECT_EQ(wired(map, board).direction.value().at.channel, 2);
}

TEST(Wiring, WrongChoices_NameKeyValueAndWhatIsAllowed) {
    ChannelMap map = multiq3_map();
    map.macro.output.subdevice = 0;
    EXPECT_THAT(refusal(map, multiq3()),
                HasSubstr("stage.comedi.macro.subdevice: 0: is an analogue input on fake board; must be an "
                          "analogue output"));
    map = multiq3_map();
    map.macro.output.subdevice = 9;
    EXPECT_THAT(refusal(map, multiq3()), HasSubstr("stage.comedi.macro.subdevice: 9: is not there"));
    map = multiq3_map();
    map.hall.channel = 8;
    EXPECT_THAT(refusal(map, multiq3()), HasSubstr("stage.comedi.hall.channel: 8: subdevice 0 of fake board "
                                                   "has channels 0 to 7"));
    map = multiq3_map();
    map.macro.output.range = VoltageRange{-10.0, 10.0};
    EXPECT_THAT(refusal(map, multiq3()),
                AllOf(HasSubstr("stage.comedi.macro.range_V: [-10, 10]: "), HasSubstr("[-5, 5]")));
    map = multiq3_map();
    map.micro.channel = 0;
    EXPECT_THAT(refusal(map, multiq3()), HasSubstr("stage.comedi.micro.channel: 0: is the macro stage's"));
    map = multiq3_map();
    map.encoder = {{0, 1, {}}, false, 20.0};
    EXPECT_EQ(refusal(map, multiq3()), "no refusal");
    map.encoder.mm_per_V = 19.0;  // 200 mm are 10.5 V then
    EXPECT_THAT(refusal(map, multiq3()), HasSubstr("stage.comedi.encoder.mm_per_V: 19: the travel takes "));
    map.encoder.mm_per_V = 50.0;  // a step of 0.061 mm
    EXPECT_THAT(refusal(map, multiq3()), HasSubstr("must not be above macro.encoder_resolution_mm"));
    map.encoder.mm_per_V.reset();
    EXPECT_THAT(refusal(map, multiq3()), HasSubstr("stage.comedi.encoder.subdevice: 0: is an analogue input "
                                                   "on fake board; must be a counter"));
}

TEST(Wiring, RangeTooNarrowForTheRig_Refused) {
    auto board = multiq3();
    board[1].ranges = {{-5.0, 5.0}, {-2.5, 2.5}};
    ChannelMap map = multiq3_map();
    map.macro.output.range = VoltageRange{-2.5, 2.5};
    EXPECT_THAT(refusal(map, board), HasSubstr("stage.comedi.macro.range_V: [-2.5, 2.5]: does not hold "
                                               "macro.command_limit_V either way, [-5, 5] V"));
    EXPECT_EQ(wired(multiq3_map(), board).micro.range, (VoltageRange{-2.5, 2.5}));
}

}  // namespace
}  // namespace fidservo::control::comedi

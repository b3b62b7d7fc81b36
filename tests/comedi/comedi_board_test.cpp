// SPDX-License-Identifier: GPL-3.0-or-later
// Volts and counts through a board in memory.
#include "control/comedi/comedi_board.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "tests/comedi/fake_board.h"
#include "tests/reference_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::control::comedi {
namespace {

struct Bench {
    explicit Bench(const ChannelMap& map, std::vector<FakeSubdevice> subdevices = multiq3())
        : parts(std::move(subdevices)), wiring(wire(map, FakeBoard(parts, registers), reference_rig())) {}

    std::unique_ptr<FakeBoard> board() const { return std::make_unique<FakeBoard>(parts, registers); }
    std::uint32_t value(int subdevice, int channel) const { return registers->values[{subdevice, channel}]; }

    std::shared_ptr<FakeRegisters> registers = std::make_shared<FakeRegisters>();
    std::vector<FakeSubdevice> parts;
    Wiring wiring;
};

TEST(ComediOutputs, SignedVoltage_ReachesTheOutputs) {
    Bench bench(multiq3_map());
    ComediOutputs outputs(bench.board(), bench.wiring);
    EXPECT_TRUE(outputs.write({5.0, 1.9}));
    EXPECT_EQ(bench.value(1, 0), 4095U);
    EXPECT_EQ(bench.value(1, 1), 2826U);  // (1.9 + 5) / 10 * 4095 = 2825.55
    EXPECT_TRUE(outputs.write({-5.0, 0.0}));
    EXPECT_EQ(bench.value(1, 0), 0U);
    EXPECT_EQ(bench.value(1, 1), 2048U);
}

TEST(ComediOutputs, Reversed_TurnsTheMotorAlone) {
    ChannelMap map = multiq3_map();
    map.macro.reversed = true;
    Bench bench(map);
    ComediOutputs outputs(bench.board(), bench.wiring);
    EXPECT_TRUE(outputs.write({5.0, 1.9}));
    EXPECT_EQ(bench.value(1, 0), 0U);
    EXPECT_EQ(bench.value(1, 1), 2826U);
}

/// With a line the amount is positive, and is never there while the line changes.
TEST(ComediOutputs, DirectionLine_AmountIsZeroWhileItChanges) {
    ChannelMap map = multiq3_map();
    map.macro.direction = ChannelChoice{3, 2, {}};
    Bench bench(map);
    ComediOutputs outputs(bench.board(), bench.wiring);
    const std::uint32_t zero = number_of(bench.wiring.macro, 0.0);
    EXPECT_TRUE(outputs.write({}));
    for (const double command : {4.0, -4.0, -3.0, 0.0, 2.0}) {
        const std::uint32_t line_before = bench.value(3, 2), amount_before = bench.value(1, 0);
        bench.registers->writes.clear();
        EXPECT_TRUE(outputs.write({command, 0.0}));
        EXPECT_NEAR(volts_of(bench.wiring.macro, bench.value(1, 0)), std::abs(command), 0.0013);
        if (command != 0.0) {
            EXPECT_EQ(bench.value(3, 2), command > 0.0 ? 1U : 0U);
        }
        std::uint32_t amount = amount_before;
        for (const auto& [at, number] : bench.registers->writes) {
            if (at.subdevice == 1 && at.channel == 0) amount = number;
            if (at.subdevice == 3 && number != line_before) {
                EXPECT_EQ(amount, zero);
            }
        }
    }
}

TEST(ComediOutputs, LineOfBothWays_IsMadeAnOutput) {
    ChannelMap map = multiq3_map();
    map.macro.direction = ChannelChoice{3, 2, {}};
    auto parts = multiq3();
    parts[3].kind = SubdeviceKind::digital_io;
    Bench bench(map, parts);
    const ComediOutputs outputs(bench.board(), bench.wiring);
    EXPECT_EQ(bench.registers->lines_made_outputs, 1);
    bench.registers->refuses = true;
    EXPECT_THROW(ComediOutputs(bench.board(), bench.wiring), RunFault);
}

TEST(ComediOutputs, BoardRefuses_IsSaid) {
    Bench bench(multiq3_map());
    ComediOutputs outputs(bench.board(), bench.wiring);
    bench.registers->refuses = true;
    EXPECT_FALSE(outputs.write({}));
}

TEST(Unwrapped, CounterGoesBeyondItsBits_CountGoesOn) {
    Unwrapped counter(0xffffff);
    EXPECT_EQ(counter.follow(0xfffff0), 0);
    EXPECT_EQ(counter.follow(0x000010), 32);
    EXPECT_EQ(counter.follow(0xfffff0), 0);
    EXPECT_EQ(counter.follow(0x800000 - 0x10), -0x800000);  // half a range: the way down
    Unwrapped whole(0xffffffff);
    EXPECT_EQ(whole.follow(5), 0);
    EXPECT_EQ(whole.follow(0xffffffff), -6);
}

TEST(ComediStage, CounterAndHallSensor_InTheRigsUnits) {
    Bench bench(multiq3_map());
    ComediStage stage(bench.board(), bench.wiring, nullptr);
    bench.registers->values[{4, 0}] = 0x800000;
    bench.registers->values[{0, 0}] = number_of(bench.wiring.hall, 2.5);
    EXPECT_EQ(stage.read()->encoder_count, 0) << "an incremental encoder begins anywhere";
    bench.registers->values[{4, 0}] = 0x800000 - 7;
    const auto sample = stage.read();
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->encoder_count, -7);
    EXPECT_NEAR(sample->hall_adc, 2048, 1);  // 2.5 V of 5 V in 12 bit
}

TEST(ComediStage, PositionInVolts_BecomesCounts) {
    ChannelMap map = multiq3_map();
    map.encoder = {{0, 1, {}}, true, 20.0};
    Bench bench(map, analogue_board());
    ComediStage stage(bench.board(), bench.wiring, nullptr);
    bench.registers->values[{0, 1}] = number_of(bench.wiring.encoder, 2.5);  // 50 mm, reversed
    EXPECT_EQ(stage.read()->encoder_count, -1000);
}

TEST(ComediStage, BoardRefuses_Device) {
    Bench bench(multiq3_map());
    ComediStage stage(bench.board(), bench.wiring, nullptr);
    bench.registers->refuses = true;
    const auto sample = stage.read();
    ASSERT_FALSE(sample);
    EXPECT_EQ(sample.error().reason, Reason::device);
}

}  // namespace
}  // namespace fidservo::control::comedi

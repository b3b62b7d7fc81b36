// SPDX-License-Identifier: GPL-3.0-or-later
// Comedi's own test driver (analogue outputs looped back to the inputs) and the MultiQ-3's, by libcomedi and
// a kernel. The first node is the MultiQ-3 without a board, the second comedi_test.
#include "control/comedi/comedi_board.h"
#include "control/comedi/libcomedi_link.h"
#include "control/stage_check.h"
#include "control/stage_loop.h"
#include "core/input_error.h"
#include "src/session/stage_start.h"
#include "tests/comedi/fake_board.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <iostream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::control::comedi {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr const char* multiq3_node = "/dev/comedi0";
constexpr const char* loopback_node = "/dev/comedi1";

/// Motor and heater outputs read back as position and Hall sensor.
ChannelMap looped_back() {
    ChannelMap map;
    map.macro.output = {1, 0, {}};
    map.micro = {1, 1, {}};
    map.encoder = {{0, 0, {}}, false, 20.0};
    map.hall = {0, 1, {}};
    return map;
}

TEST(ComediNode, NotThere_RunFault) {
    EXPECT_THROW((void)open_board("/dev/comedi200"), RunFault);
}

TEST(ComediTest, OutputsComeBackAtTheInputs) {
    const auto board = open_board(loopback_node);
    std::cout << board->name() << '\n';
    EXPECT_THAT(board->name(), HasSubstr("comedi_test"));
    const Wiring wiring = wire(looped_back(), *board, reference_rig());
    EXPECT_EQ(wiring.macro.range, (VoltageRange{-5.0, 5.0}));
    EXPECT_EQ(wiring.macro.max_value, 0xffffU);
    for (std::uint32_t number = 0; number <= 0xffff; number += 257) {
        ASSERT_TRUE(board->write(wiring.macro.at, number));
        std::uint32_t came = 0;
        ASSERT_TRUE(board->read(wiring.encoder.at, came));
        EXPECT_EQ(came, number);
    }
}

/// Every command of a loop at 1 kHz comes back through guardian process and kernel, in order.
TEST(ComediTest, Loop_CommandsComeBackAsSamples) {
    const Wiring wiring = wire(looped_back(), *open_board(loopback_node), reference_rig());
    GuardianOptions options;
    options.timeout = 1000ms;  // an emulated machine stands still at times
    const auto guardian = std::make_shared<Guardian>(
        options, [&] { return std::make_unique<ComediOutputs>(open_board(loopback_node), wiring); });
    constexpr int ticks = 3000;
    struct Staircase {
        std::vector<double> samples_V;
        static LoopStep tick(void* self, const StageSample& sample) {
            auto& stairs = *static_cast<Staircase*>(self);
            stairs.samples_V.push_back(static_cast<double>(sample.encoder_count) / 400.0);
            const auto k = static_cast<int>(stairs.samples_V.size());
            return {{-5.0 + 0.0025 * k, 0.0}, NAN, NAN, k == ticks};
        }
    } stairs;
    stairs.samples_V.reserve(ticks);
    {
        StageLoop loop(std::make_shared<ComediStage>(open_board(loopback_node), wiring, guardian), {});
        loop.start({&stairs, &Staircase::tick});
        while (loop.running()) loop.wait(100ms);
        ASSERT_FALSE(loop.ended()) << loop.ended()->text;
        std::cout << "loop in the virtual machine: " << fidservo::text_of(loop.statistics()) << '\n';
    }
    ASSERT_EQ(stairs.samples_V.size(), static_cast<std::size_t>(ticks));
    std::map<long, int> delays;
    for (int k = 100; k < ticks; ++k) {
        const double came_V = stairs.samples_V[static_cast<std::size_t>(k)];
        const long given = std::lround((came_V + 5.0) / 0.0025);
        ++delays[k - given];
        EXPECT_GE(came_V, stairs.samples_V[static_cast<std::size_t>(k - 1)]) << "tick " << k;
        EXPECT_LE(given, k) << "tick " << k;
    }
    for (const auto& [delay, count] : delays)
        std::cout << count << " commands are seen " << delay << " ticks later\n";
    EXPECT_TRUE(guardian->finish());
    const auto board = open_board(loopback_node);
    std::uint32_t left = 0;
    ASSERT_TRUE(board->read(wiring.encoder.at, left));
    EXPECT_NEAR(volts_of(wiring.encoder, left), 0.0, 1e-4);
}

TEST(MultiQ3, DriverSaysWhatTheMapsExampleExpects) {
    const auto board = open_board(multiq3_node);
    std::cout << board->name() << '\n';
    const auto expected = multiq3();
    for (int subdevice = 0; subdevice < static_cast<int>(expected.size()); ++subdevice) {
        const FakeSubdevice& part = expected[static_cast<std::size_t>(subdevice)];
        EXPECT_EQ(board->kind(subdevice), part.kind) << subdevice;
        EXPECT_EQ(board->channels(subdevice), part.channels) << subdevice;
        EXPECT_EQ(board->max_value(subdevice, 0), part.max_value) << subdevice;
        if (!part.ranges.empty()) {
            EXPECT_EQ(board->ranges(subdevice, 0), part.ranges) << subdevice;
        }
    }
    EXPECT_EQ(board->kind(static_cast<int>(expected.size())), SubdeviceKind::none);
    EXPECT_NO_THROW((void)wire(multiq3_map(), *board, reference_rig()));
}

/// The driver attaches and answers although there is no board: the stage's check is not taken in.
TEST(MultiQ3, NoBoard_TheStageDoesNotPassItsCheck) {
    const Wiring wiring = wire(multiq3_map(), *open_board(multiq3_node), reference_rig());
    GuardianOptions options;
    options.timeout = 1000ms;
    const auto guardian = std::make_shared<Guardian>(
        options, [&] { return std::make_unique<ComediOutputs>(open_board(multiq3_node), wiring); });
    ComediStage stage(open_board(multiq3_node), wiring, guardian);
    const StageCheckParams params = stage_check_params(reference_rig());
    StageCheckState state;
    for (int tick = 0; tick < 30'000 && !stage_check_is_done(state); ++tick) {
        const auto sample = stage.read();
        if (!sample) {
            state.phase = StageCheckPhase::failed;
            state.why = sample.error().text;
            break;
        }
        ASSERT_TRUE(stage.write(stage_check_update(params, state, *sample)));
    }
    EXPECT_EQ(state.phase, StageCheckPhase::failed);
    std::cout << "without a board: " << state.why << '\n';
    EXPECT_FALSE(state.why.empty());
}

}  // namespace
}  // namespace fidservo::control::comedi

// SPDX-License-Identifier: GPL-3.0-or-later
// The guardian, seen from outside: what the board's registers hold during and after a program that ends in
// every way a program can end.
#include "control/guardian.h"

#include "control/guardian_memory.h"
#include "control/guardian_process.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <ostream>
#include <string>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
using testing::ChildProcess;
using testing::text_of;

/// Limit for the time from the end of the program to zero on the board: 20 ms without a heartbeat, two
/// checks, and the scheduler. Where neither the guardian nor this test has real-time priority, a busy machine
/// can delay both.
std::chrono::milliseconds zero_limit() {
    static const bool real_time = take_real_time_priority();
    return real_time ? 50ms : 1000ms;
}

bool is_zero(const StageCommand& command) {
    return command.macro_V == 0.0 && command.micro_V == 0.0;
}

class GuardedRun {
  public:
    GuardedRun() { zero_limit(); }

    std::vector<std::string> command_line(const std::string& heartbeat, const std::string& ending) const {
        return {GUARDED_PROGRAM, registers(), log_file(), heartbeat, ending};
    }
    std::string registers() const { return folder_ / "board.bin"; }
    std::string log_file() const { return folder_ / "guardian.log"; }
    StageCommand outputs() const { return SimulatedBoard::outputs(registers()); }
    /// True as soon as the log holds the text: it is written after the outputs are zero.
    bool log_says(const std::string& text) const {
        const auto start = steady_clock::now();
        while (steady_clock::now() - start < 10s) {
            if (text_of(log_file()).find(text) != std::string::npos) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }

    /// Time until both outputs are zero; the limit of 10 s if they never are.
    std::chrono::milliseconds time_to_zero() const {
        const auto start = steady_clock::now();
        while (!is_zero(outputs()) && steady_clock::now() - start < 10s) std::this_thread::sleep_for(1ms);
        return std::chrono::ceil<std::chrono::milliseconds>(steady_clock::now() - start);
    }

  private:
    testing::TemporaryFolder folder_;
};

class GuardianBySignal : public ::testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(GuardianBySignal, ProgramKilled_OutputsZeroWithin50ms) {
    const auto [heartbeat, signal] = GetParam();
    const GuardedRun run;
    ChildProcess program(run.command_line(heartbeat, "wait"));
    ASSERT_TRUE(program.prints("running")) << program.output();
    EXPECT_EQ(run.outputs().macro_V, -4.5);
    EXPECT_EQ(run.outputs().micro_V, 1.75);

    program.send(signal);
    EXPECT_LE(run.time_to_zero(), zero_limit());
    EXPECT_EQ(program.wait(), -signal);
    EXPECT_TRUE(program.output_ends()) << "the guardian holds the program's output open";
    EXPECT_TRUE(run.log_says("guardian: program ended without saying so; macro 0 V, micro 0 V"));
}

INSTANTIATE_TEST_SUITE_P(EverySignal, GuardianBySignal,
                         ::testing::Combine(::testing::Values("loop", "process"),
                                            ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGKILL)),
                         [](const auto& instance) {
                             return std::get<0>(instance.param) + "_" +
                                    ::sigabbrev_np(std::get<1>(instance.param));
                         });

class GuardianByHeartbeat : public ::testing::TestWithParam<std::string> {};

TEST_P(GuardianByHeartbeat, ProgramStopped_OutputsZeroWithin50msAndProgramLearnsIt) {
    const GuardedRun run;
    ChildProcess program(run.command_line(GetParam(), "wait"));
    ASSERT_TRUE(program.prints("running"));

    program.send(SIGSTOP);
    EXPECT_LE(run.time_to_zero(), zero_limit());
    std::this_thread::sleep_for(200ms);
    program.send(SIGCONT);
    EXPECT_TRUE(program.prints("stood still for more than 20 ms")) << program.output();
    EXPECT_EQ(program.wait(), 3);
    EXPECT_TRUE(is_zero(run.outputs())) << "the outputs came back";
    EXPECT_TRUE(run.log_says("guardian: heartbeat missing; macro 0 V, micro 0 V"));
}

TEST_P(GuardianByHeartbeat, GuardianKilled_ProgramZeroesBoardItself) {
    const GuardedRun run;
    ChildProcess program(run.command_line(GetParam(), "kill-guardian"));
    EXPECT_TRUE(program.prints("guardian process was lost")) << program.output();
    EXPECT_TRUE(is_zero(run.outputs()));
    EXPECT_EQ(program.wait(), 3);
}

TEST_P(GuardianByHeartbeat, GuardianStopped_ProgramZeroesBoardItself) {
    const GuardedRun run;
    ChildProcess program(run.command_line(GetParam(), "stop-guardian"));
    EXPECT_TRUE(program.prints("guardian process was lost")) << program.output();
    EXPECT_TRUE(is_zero(run.outputs()));
    EXPECT_EQ(program.wait(), 3);
}

INSTANTIATE_TEST_SUITE_P(BothKinds, GuardianByHeartbeat, ::testing::Values<std::string>("loop", "process"),
                         [](const auto& instance) { return instance.param; });

struct Ending {
    std::string name;
    int exit_code;
    bool said_so;  ///< the program ended the guardian itself, so nothing is logged
};

void PrintTo(const Ending& ending, std::ostream* out) {
    *out << ending.name;
}

class GuardianByEnding : public ::testing::TestWithParam<Ending> {};

TEST_P(GuardianByEnding, ProgramEnds_OutputsZeroWithin50ms) {
    const GuardedRun run;
    ChildProcess program(run.command_line("loop", GetParam().name));
    ASSERT_TRUE(program.prints("running"));
    EXPECT_FALSE(is_zero(run.outputs()));
    EXPECT_EQ(program.wait(), GetParam().exit_code);
    EXPECT_LE(run.time_to_zero(), zero_limit());
    if (GetParam().said_so) {
        EXPECT_FALSE(std::filesystem::exists(run.log_file())) << text_of(run.log_file());
    } else {
        EXPECT_TRUE(run.log_says("program ended without saying so; macro 0 V, micro 0 V"));
    }
}

INSTANTIATE_TEST_SUITE_P(EveryWay, GuardianByEnding,
                         ::testing::Values(Ending{"finish", 0, true}, Ending{"exit", 0, false},
                                           Ending{"abort", -SIGABRT, false}, Ending{"throw", -SIGABRT, false},
                                           Ending{"segv", -SIGSEGV, false}, Ending{"throw-caught", 3, true}),
                         [](const auto& instance) {
                             std::string name = instance.param.name;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(Guardian, LoopStalls_OutputsZeroAndProgramLearnsIt) {
    const GuardedRun run;
    ChildProcess program(run.command_line("loop", "stall"));
    EXPECT_TRUE(program.prints("stood still for more than 20 ms")) << program.output();
    EXPECT_EQ(program.wait(), 3);
    EXPECT_TRUE(is_zero(run.outputs()));
}

TEST(Guardian, TicksOfSimulationFarApart_DoNotTrip) {
    const GuardedRun run;
    ChildProcess program(run.command_line("process", "stall"));
    ASSERT_TRUE(program.prints("running"));
    EXPECT_FALSE(program.prints("stood still", 500ms)) << program.output();
    EXPECT_FALSE(is_zero(run.outputs()));
    program.send(SIGKILL);
    EXPECT_TRUE(run.log_says("program ended without saying so"));
}

TEST(Guardian, BoardDoesNotOpen_ThrowsWithItsReason) {
    try {
        const Guardian guardian({}, [] { return std::make_unique<SimulatedBoard>("/nowhere/board.bin"); });
        FAIL() << "no exception";
    } catch (const RunFault& fault) {
        EXPECT_NE(std::string(fault.what()).find("/nowhere/board.bin"), std::string::npos) << fault.what();
    }
}

/// Takes the first zero and refuses everything but zero from then on.
class RefusingBoard final : public OutputBoard {
  public:
    bool write(const StageCommand& command) noexcept override { return is_zero(command); }
};

TEST(Guardian, BoardRefusesACommand_Trips) {
    Guardian guardian({}, [] { return std::make_unique<RefusingBoard>(); });
    const auto start = steady_clock::now();
    while (!guardian.tripped() && steady_clock::now() - start < 10s) {
        guardian.apply({0.0, 1.5});
        std::this_thread::sleep_for(1ms);
    }
    ASSERT_TRUE(guardian.tripped());
    EXPECT_NE(guardian.tripped()->find("refused a command"), std::string::npos);
    EXPECT_TRUE(guardian.finish());
}

/// Opens, and then confirms nothing.
class DeadBoard final : public OutputBoard {
  public:
    bool write(const StageCommand&) noexcept override { return ++writes_ == 1; }

  private:
    int writes_ = 0;
};

TEST(Guardian, BoardDoesNotConfirmTheLastZero_FinishFails) {
    Guardian guardian({}, [] { return std::make_unique<DeadBoard>(); });
    const Status status = guardian.finish();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().reason, Reason::device);
}

TEST(Guardian, TwoInOneProgram_EachHasItsBoard) {
    const GuardedRun first_run;
    const GuardedRun second_run;
    const GuardianOptions options{.heartbeat = Heartbeat::process, .log_file = {}};
    Guardian first(options, [&] { return std::make_unique<SimulatedBoard>(first_run.registers()); });
    Guardian second(options, [&] { return std::make_unique<SimulatedBoard>(second_run.registers()); });
    first.apply({1.0, 0.0});
    second.apply({2.0, 0.0});
    const auto start = steady_clock::now();
    while (second_run.outputs().macro_V != 2.0 && steady_clock::now() - start < 10s)
        std::this_thread::sleep_for(1ms);
    EXPECT_EQ(first_run.outputs().macro_V, 1.0);
    EXPECT_EQ(second_run.outputs().macro_V, 2.0);
    EXPECT_TRUE(first.finish());
    EXPECT_TRUE(is_zero(first_run.outputs()));
    EXPECT_EQ(second_run.outputs().macro_V, 2.0);
    EXPECT_TRUE(second.finish());
}

/// Repeated often, so that a stop occurs between any two steps of a command.
TEST(Guardian, StopWhileAnotherThreadCommands_OutputsZeroForGood) {
    for (int round = 0; round < 20; ++round) {
        const GuardedRun run;
        Guardian guardian({.heartbeat = Heartbeat::process, .log_file = {}},
                          [&] { return std::make_unique<SimulatedBoard>(run.registers()); });
        std::atomic<bool> over = false;
        std::thread loop([&] {
            while (!over) guardian.apply({4.5, 1.75});
        });
        const auto start = steady_clock::now();
        while (is_zero(run.outputs()) && steady_clock::now() - start < 10s) std::this_thread::yield();
        EXPECT_FALSE(guardian.tripped());
        guardian.stop();
        run.time_to_zero();
        ASSERT_TRUE(is_zero(run.outputs()));
        for (int look = 0; look < 20; ++look) {
            ASSERT_TRUE(is_zero(run.outputs()));
            std::this_thread::sleep_for(1ms);
        }
        EXPECT_NE(guardian.tripped().value_or("").find("stopped by the user"), std::string::npos);
        over = true;
        loop.join();
        EXPECT_TRUE(guardian.finish());
    }
}

TEST(GuardianMemory, CommandPacked_ComesBackWithFloatResolution) {
    const StageCommand command = unpacked(packed({-3.1415926, 1.7}));
    EXPECT_NEAR(command.macro_V, -3.1415926, 3e-7);
    EXPECT_NEAR(command.micro_V, 1.7, 1e-7);
}

}  // namespace
}  // namespace fidservo::control

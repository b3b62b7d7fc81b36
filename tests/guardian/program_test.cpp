// SPDX-License-Identifier: GPL-3.0-or-later
// The real program on the simulated rig, ended in mid-run in every way: what the board's registers hold then.
#include "control/guardian_process.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/temporary_folder.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace std::chrono_literals;
using control::SimulatedBoard;
using control::StageCommand;
using std::chrono::steady_clock;
using testing::ChildProcess;

/// From the program's end, or from SIGSTOP, to zero on the board.
std::chrono::milliseconds zero_limit() {
    static const bool real_time = control::take_real_time_priority();
    return real_time ? 50ms : 1000ms;
}

/// Waits until a condition holds. False if it does not within two minutes (a sanitizer's build is slow).
template <class Condition>
bool eventually(const Condition& condition) {
    const auto start = steady_clock::now();
    while (!condition()) {
        if (steady_clock::now() - start > 120s) return false;
        std::this_thread::sleep_for(1ms);
    }
    return true;
}

class GuardedProgram : public ::testing::Test {
  public:
    GuardedProgram(const GuardedProgram&) = delete;
    GuardedProgram& operator=(const GuardedProgram&) = delete;

  protected:
    GuardedProgram() {
        registers_ = folder_ / "registers";
        zero_limit();
    }

    /// Starts the program with its temporary files, the board's registers among them, in this test's folder.
    void start(const std::string& arguments, const std::string& before = "") {
        const std::string shell = "export TMPDIR='" + folder_.path().string() + "'; " + before +
                                  " exec '" FIDSERVO_PROGRAM "' " + arguments;
        program_.emplace(std::vector<std::string>{"/bin/sh", "-c", shell});
        program_folder_ = folder_ / ("fidservo-" + std::to_string(program_->pid()));
    }

    void start_inspection(const std::string& before = "") {
        start("inspect '" FIDSERVO_ASSETS_DIR "/demo/recipe.yaml' --out '" + (folder_ / "out").string() + "'",
              before);
    }

    bool outputs_are_zero() const {
        const StageCommand outputs = SimulatedBoard::outputs(registers_);
        return outputs.macro_V == 0.0 && outputs.micro_V == 0.0;
    }

    /// Waits until the heater is on. Keeps the board's registers by a link of our own: the program's goes
    /// with its folder.
    bool in_mid_run() {
        const std::filesystem::path board = program_folder_ / "stage-outputs";
        if (!eventually(
                [&] { return std::filesystem::exists(board) && std::filesystem::file_size(board) > 0; }))
            return false;
        std::filesystem::remove(registers_);
        std::filesystem::create_hard_link(board, registers_);
        return eventually([&] { return SimulatedBoard::outputs(registers_).micro_V != 0.0; });
    }

    std::chrono::milliseconds time_to_zero() const {
        const auto start = steady_clock::now();
        eventually([&] { return outputs_are_zero(); });
        return std::chrono::ceil<std::chrono::milliseconds>(steady_clock::now() - start);
    }

    testing::TemporaryFolder folder_;  ///< outlives the program
    std::filesystem::path registers_;
    std::filesystem::path program_folder_;
    std::optional<ChildProcess> program_;
};

constexpr int exit_fault = 3;

class SlowGuardedProgram : public GuardedProgram {};

TEST_F(SlowGuardedProgram, Holding_SigIntOrSigTerm_EndsInOrderWithOutputsZero) {
    for (const int signal : {SIGINT, SIGTERM}) {
        start("goto --tag 12 --dx-um 150");
        ASSERT_TRUE(program_->prints("\"within_tolerance\":true", 120s)) << program_->output();
        ASSERT_TRUE(in_mid_run());
        program_->send(signal);
        EXPECT_EQ(program_->wait(), 0) << program_->output();
        EXPECT_TRUE(outputs_are_zero());
        EXPECT_FALSE(std::filesystem::exists(program_folder_)) << "nothing to keep after an orderly end";
    }
}

TEST_F(GuardedProgram, Inspecting_SigIntOrSigTerm_EndsInOrderWithOutputsZero) {
    for (const int signal : {SIGINT, SIGTERM}) {
        start_inspection();
        ASSERT_TRUE(in_mid_run()) << program_->output();
        program_->send(signal);
        EXPECT_TRUE(program_->output_ends(120s));
        EXPECT_EQ(program_->wait(), exit_fault) << program_->output();
        EXPECT_TRUE(outputs_are_zero());
        std::filesystem::remove_all(folder_ / "out");
    }
}

TEST_F(GuardedProgram, Inspecting_SigKill_OutputsZeroWithin50ms) {
    start_inspection();
    ASSERT_TRUE(in_mid_run()) << program_->output();
    program_->send(SIGKILL);
    EXPECT_LE(time_to_zero(), zero_limit());
    EXPECT_EQ(program_->wait(), -SIGKILL);
    EXPECT_TRUE(outputs_are_zero());
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(program_folder_ / "guardian.log"); }));
}

TEST_F(GuardedProgram, Inspecting_SigStopAndSigCont_OutputsZeroWithin50msAndProgramEnds) {
    start_inspection();
    ASSERT_TRUE(in_mid_run()) << program_->output();
    program_->send(SIGSTOP);
    EXPECT_LE(time_to_zero(), zero_limit());
    std::this_thread::sleep_for(2s);
    program_->send(SIGCONT);
    EXPECT_TRUE(program_->prints("guardian", 120s)) << program_->output();
    EXPECT_EQ(program_->wait(), exit_fault) << program_->output();
    EXPECT_TRUE(outputs_are_zero());
}

/// The first image meets a limit of the file size, and what writes it throws while the platform is held.
TEST_F(SlowGuardedProgram, Inspecting_ExceptionInMidRun_OutputsZero) {
    start_inspection("trap '' XFSZ; ulimit -f 1100;");
    ASSERT_TRUE(in_mid_run()) << program_->output();
    EXPECT_TRUE(program_->output_ends(120s));
    EXPECT_EQ(program_->wait(), exit_fault) << program_->output();
    EXPECT_TRUE(outputs_are_zero());
    EXPECT_NE(program_->output().find("cannot be written: File too large"), std::string::npos)
        << program_->output();
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// The real program, ended in the middle of a recording and taken up again.
#include "src/files/recording/reader.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/run_program.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::ChildProcess;
using testing::ProgramRun;
using testing::run_program;
using testing::TemporaryFolder;

constexpr const char* short_experiment =
    "name: nudge\ncarriage_mm: 30\nmacro:\n  - { constant_V: 3.6, duration_s: 0.2 }\n"
    "  - { constant_V: 0, duration_s: 3.8 }\n";

class SlowRecordProgram : public ::testing::Test {
  protected:
    ProgramRun record(const std::string& more = "") {
        std::vector<std::string> arguments{"record", experiment_, "--out", out_};
        if (!more.empty()) arguments.push_back(more);
        return run_program(arguments, folder_.path());
    }

    /// Starts a recording and ends it by a signal once the recording has rows. @return its exit code
    int end_in_the_middle(int signal) {
        ChildProcess program({FIDSERVO_PROGRAM, "record", experiment_, "--out", out_});
        const std::filesystem::path rows = std::filesystem::path(out_) / "stage0/data.csv";
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        std::error_code none;
        while (!(std::filesystem::exists(rows) && std::filesystem::file_size(rows, none) > 200) &&
               std::chrono::steady_clock::now() < limit)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        program.send(signal);
        const int code = program.wait();
        program.output_ends();
        output_ = program.output();
        return code;
    }

    TemporaryFolder folder_;
    std::string experiment_ = folder_.write("nudge.yaml", short_experiment).string();
    std::string out_ = (folder_ / "out").string();
    std::string output_;
};

TEST_F(SlowRecordProgram, KilledAndResumed_TheRecordingIsWholeAndNothingIsLost) {
    EXPECT_EQ(end_in_the_middle(SIGKILL), -SIGKILL);
    const Recording cut = read_recording(out_);
    EXPECT_TRUE(cut.is_unfinished);
    EXPECT_EQ(record().exit_code, 2) << "what is there is not overwritten";
    const ProgramRun resumed = record("--resume");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    const Recording kept = read_recording(out_ + ".interrupted-1");
    EXPECT_TRUE(kept.is_unfinished);
    EXPECT_EQ(kept.rows.size(), cut.rows.size());
    const Recording whole = read_recording(out_);
    EXPECT_FALSE(whole.is_unfinished);
    EXPECT_EQ(whole.rows.size(), 4001u);
    EXPECT_EQ(whole.name, "nudge-1");
    EXPECT_EQ(whole.experiment, "nudge");
    const ProgramRun again = record("--resume");
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_NE(again.out.find("nothing to do"), std::string::npos) << again.out;
    folder_.write("nudge.yaml",
                  std::string(short_experiment).replace(std::string(short_experiment).find("3.6"), 3, "3.5"));
    const ProgramRun other = record("--resume");
    EXPECT_EQ(other.exit_code, 2) << "the experiment's file says something else now";
    EXPECT_NE(other.err.find("request_sha256"), std::string::npos) << other.err;
}

TEST_F(SlowRecordProgram, CtrlC_LeavesAnUnfinishedRecordingThatSaysWhy) {
    EXPECT_EQ(end_in_the_middle(SIGINT), 3);
    EXPECT_NE(output_.find("nudge-1: stopped: stopped by the user; --resume goes on from here"),
              std::string::npos)
        << output_;
    const Recording cut = read_recording(out_);
    EXPECT_TRUE(cut.is_unfinished);
    ASSERT_FALSE(cut.events.empty());
    EXPECT_EQ(cut.events.back().what, "stopped");
}

}  // namespace
}  // namespace fidservo

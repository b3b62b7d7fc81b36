// SPDX-License-Identifier: GPL-3.0-or-later
// The real program, ended in mid-run by what can happen to a machine, and taken up again: the results are
// those of a run that nothing happened to, byte for byte.
#include "control/output_board.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/temporary_folder.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <httplib.h>

namespace fidservo {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using testing::ChildProcess;
using testing::text_of;

constexpr int exit_done = 0, exit_fault = 3;

class SlowInterruptedRun : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<testing::TemporaryFolder>();
        ChildProcess whole(shell(program("whole")));
        ASSERT_EQ(whole.wait(), exit_done) << whole.output();
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::vector<std::string> shell(const std::string& script) { return {"/bin/sh", "-c", script}; }
    static std::string program(const std::string& out) {
        return "exec '" FIDSERVO_PROGRAM "' inspect '" FIDSERVO_SOURCE_DIR
               "/tests/faults/drill.yaml' --out '" +
               (*folder_ / out).string() + "'";
    }

    /// Runs until a site has been measured.
    static bool is_past_first_site(ChildProcess& run) { return run.prints("1 of 3", 120s); }

    static void expect_resumes_to_the_same(const std::string& out) {
        ChildProcess resumed(shell(program(out) + " --resume"));
        EXPECT_TRUE(resumed.output_ends(300s));
        EXPECT_EQ(resumed.wait(), exit_done) << resumed.output();
        EXPECT_EQ(text_of(*folder_ / out / "results.csv"), text_of(*folder_ / "whole/results.csv"));
        EXPECT_TRUE(fs::exists(*folder_ / out / "report.html"));
    }

    static inline std::unique_ptr<testing::TemporaryFolder> folder_;
};

TEST_F(SlowInterruptedRun, Killed_ResumesToTheSame) {
    ChildProcess run(shell(program("killed")));
    ASSERT_TRUE(is_past_first_site(run)) << run.output();
    std::this_thread::sleep_for(100ms);
    run.send(SIGKILL);
    EXPECT_EQ(run.wait(), -SIGKILL);
    expect_resumes_to_the_same("killed");
}

TEST_F(SlowInterruptedRun, StandsStillForTwoSeconds_SaysWhyAndResumesToTheSame) {
    ChildProcess run(shell(program("stopped")));
    ASSERT_TRUE(is_past_first_site(run)) << run.output();
    run.send(SIGSTOP);
    std::this_thread::sleep_for(2s);
    run.send(SIGCONT);
    EXPECT_TRUE(run.output_ends(120s));
    EXPECT_EQ(run.wait(), exit_fault) << run.output();
    EXPECT_NE(run.output().find("the program stood still for more than 20 ms"), std::string::npos)
        << run.output();
    expect_resumes_to_the_same("stopped");
}

TEST_F(SlowInterruptedRun, FileTooLarge_SaysWhyAndResumesToTheSame) {
    ChildProcess run(shell("trap '' XFSZ; ulimit -f 300; " + program("limited")));
    EXPECT_TRUE(run.output_ends(120s));
    EXPECT_EQ(run.wait(), exit_fault) << run.output();
    EXPECT_NE(run.output().find("File too large"), std::string::npos) << run.output();
    expect_resumes_to_the_same("limited");
}

TEST_F(SlowInterruptedRun, StoppedOnTheLivePage_ResumesToTheSame) {
    ChildProcess run(
        shell("export TMPDIR='" + folder_->path().string() + "'; " + program("live") + " --live 0"));
    ASSERT_TRUE(is_past_first_site(run)) << run.output();
    const fs::path board = *folder_ / "board";
    fs::create_hard_link(*folder_ / ("fidservo-" + std::to_string(run.pid())) / "stage-outputs", board);
    const std::string mark = "live: http://127.0.0.1:";
    const auto at = run.output().find(mark);
    ASSERT_NE(at, std::string::npos) << run.output();
    httplib::Client browser("127.0.0.1", std::stoi(run.output().substr(at + mark.size())));
    const auto answer = browser.Post("/stop");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
    EXPECT_TRUE(run.output_ends(120s));
    EXPECT_EQ(run.wait(), exit_fault) << run.output();
    EXPECT_NE(run.output().find("stopped by the user"), std::string::npos) << run.output();
    const control::StageCommand outputs = control::SimulatedBoard::outputs(board);
    EXPECT_EQ(outputs.macro_V, 0.0);
    EXPECT_EQ(outputs.micro_V, 0.0);
    expect_resumes_to_the_same("live");
}

/// A file system of 4 MB, in a mount namespace of the test's own.
TEST_F(SlowInterruptedRun, DiskFull_SaysWhyAndResumesToTheSame) {
    const std::string disk = (*folder_ / "disk").string(), run = program("disk/run").substr(5);
    fs::create_directories(disk);
    const std::string script = "mount -t tmpfs -o size=4m none '" + disk + "' || exit 77; " + run +
                               "; echo first=$?; mount -o remount,size=200m '" + disk + "'; " + run +
                               " --resume; echo second=$?; cp '" + disk + "/run/results.csv' '" +
                               (*folder_ / "disk.csv").string() + "'";
    ChildProcess namespaced({"/usr/bin/unshare", "-rm", "/bin/sh", "-c", script});
    EXPECT_TRUE(namespaced.output_ends(300s));
    if (namespaced.wait() != 0) GTEST_SKIP() << "no mount namespaces here: " << namespaced.output();
    EXPECT_NE(namespaced.output().find("No space left on device"), std::string::npos) << namespaced.output();
    EXPECT_NE(namespaced.output().find("first=3"), std::string::npos) << namespaced.output();
    EXPECT_NE(namespaced.output().find("second=0"), std::string::npos) << namespaced.output();
    EXPECT_EQ(text_of(*folder_ / "disk.csv"), text_of(*folder_ / "whole/results.csv"));
}

}  // namespace
}  // namespace fidservo

// fidservo diagnose, as it is called.
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::fidservo::testing::ProgramRun;
using ::fidservo::testing::run_program;
using ::fidservo::testing::TemporaryFolder;
using ::testing::HasSubstr;

TEST(DiagnoseCommand, EffectsBeforeRecordings_DoNotSwallowThem) {
    const TemporaryFolder folder;
    for (const char* option : {"--effects", "--without"}) {
        const ProgramRun run =
            run_program({"diagnose", option, "hall_gain,hall_offset", "no-such-folder"}, folder.path());
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_THAT(run.err, HasSubstr("no-such-folder")) << option;
    }
}

TEST(DiagnoseCommand, Report_IsWrittenOnce) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program({"simulate", "rest", "--out", "rest"}, folder.path()).exit_code, 0);
    const std::vector<std::string> arguments{"diagnose", "--effects", "hall_gain",
                                             "rest",     "--report",  "report.html"};
    const ProgramRun run = run_program(arguments, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("report: report.html"));
    EXPECT_THAT(testing::text_of(folder / "report.html"), HasSubstr("No gap was found"));
    const ProgramRun again = run_program(arguments, folder.path());
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.err, HasSubstr("--report: report.html: exists already"));
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings that are not as they should be, given to every identification: a clear line, the right exit
// code, no crash.
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr const char* titles =
    "#timestamp [ns],macro_setpoint [mm],macro_command [V],encoder [count],micro_setpoint [mm],micro_command "
    "[V],hall [adc]\n";

std::string rows(int count) {
    std::string text = titles;
    for (int k = 0; k < count; ++k) text += std::to_string(k) + "000000,,0.0,2000,,0.0,1024\n";
    return text;
}

struct Case {
    const char* name;
    std::string stage;
    const char* message;  ///< on stderr; empty: the answer is "not determined", on stdout
};

struct Command {
    const char *command, *part;
};

class BadRecording : public ::testing::TestWithParam<Command> {};

TEST_P(BadRecording, EveryKind_IsALineAndAnExitCode) {
    const std::array cases{
        Case{"empty", "", "is empty"},
        Case{"titles-only", titles, "holds no rows"},
        Case{"cut-off", rows(200) + "200000000,,0.0,20", "the last line does not end"},
        Case{"field-missing", rows(3) + "3000000,,0.0,2000,,0.0\n", "has 6 fields"},
        Case{"nan", rows(3) + "3000000,,nan,2000,,0.0,1024\n", "must be finite"},
        Case{"backwards", rows(3) + "1000000,,0.0,2000,,0.0,1024\n", "timestamp"},
        Case{"column-missing", "#timestamp [ns],macro_setpoint [mm]\n0,1.0\n1000000,1.0\n", ""},
        Case{"too-short", rows(2), ""},
        Case{"at-rest", rows(3000), ""},
    };
    for (const Case& bad : cases) {
        SCOPED_TRACE(bad.name);
        const TemporaryFolder folder;
        folder.write(
            "bad/recording.yaml",
            "format: fidservo-recording/1\nname: bad\nrig: reference-rig\ntick_s: 0.001\nexperiment: rest\n");
        folder.write("bad/stage0/data.csv", bad.stage);
        const auto [command, part] = GetParam();
        const auto run =
            testing::run_program({command, part, "bad", "--write-rig", "new.yaml"}, folder.path());
        const std::string& said = run.err;
        EXPECT_TRUE(run.exit_code == 1 || run.exit_code == 2) << run.exit_code << said;
        if (run.exit_code == 1) {
            EXPECT_THAT(run.out, HasSubstr("not determined: "));
        } else {
            EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
            EXPECT_THAT(said, HasSubstr(bad.message));
        }
        EXPECT_TRUE(*bad.message == '\0' || run.exit_code == 2) << run.out;
        EXPECT_FALSE(std::filesystem::exists(folder / "new.yaml"));
    }
}

INSTANTIATE_TEST_SUITE_P(EveryIdentification, BadRecording,
                         ::testing::Values(Command{"identify", "macro"}, Command{"identify", "hysteresis"},
                                           Command{"identify", "heater"}, Command{"calibrate", "hall"}),
                         [](const auto& instance) { return std::string(instance.param.part); });

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of instruments given to the program itself.
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;

/// A hysteresis loop below a header of the kind that data loggers write.
std::string logged_loop(bool decimal_comma) {
    std::string text =
        "\xEF\xBB\xBFTimestamp;2020-03-16 "
        "17:04:51;\r\nInterval;0.01;\r\nChannel;Drive;Deflection\r\nUnit;V;um\r\n";
    if (decimal_comma) text.replace(text.find("0.01"), 4, "0,01");
    for (int k = 0; k < 400; ++k) {
        const double phase = 2.0 * M_PI * k / 100.0, size = k < 200 ? 5.0 : 3.0;
        std::string row = fmt::format("{:.2f};{:.4f};{:.4f}\r\n", 0.01 * k, size * std::sin(phase),
                                      size * std::sin(phase - 0.2));
        for (char& letter : row)
            if (decimal_comma && letter == '.') letter = ',';
        text += row;
    }
    return text;
}

TEST(IdentifyTable, LoggersFile_IsReadTheSameWithEitherDecimalSign) {
    const TemporaryFolder folder;
    std::string stroke;
    for (const bool comma : {false, true}) {
        folder.write("log.csv", logged_loop(comma));
        const auto run = run_program({"identify", "hysteresis", "--table", "log.csv", "--columns",
                                      "input=Drive,output=3", "--rate-hz", "100"},
                                     folder.path());
        EXPECT_LT(run.exit_code, 2) << run.err;
        EXPECT_THAT(run.out, HasSubstr("the rows begin at line 5; titles are those of lines 3 and 4"));
        const auto at = run.out.find("stroke");
        ASSERT_NE(at, std::string::npos) << run.out;
        const std::string line = run.out.substr(at, run.out.find('\n', at) - at);
        EXPECT_THAT(line, HasSubstr("um"));
        EXPECT_TRUE(!comma || line == stroke) << line << " and " << stroke;
        stroke = line;
    }
}

TEST(IdentifyTable, WhatTheTableDoesNotTell_IsAnOption) {
    const TemporaryFolder folder;
    folder.write("t.csv", "1;1,250\n2;2,500\n3;3,750\n");
    const auto run = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"identify",  "hysteresis",       "--table",   "t.csv",
                                           "--columns", "input=1,output=2", "--rate-hz", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments, folder.path());
    };
    const auto asked = run({});
    EXPECT_EQ(asked.exit_code, 2);
    EXPECT_THAT(asked.err, HasSubstr("t.csv:1: column 2: '1,250': could be 1250 or 1.25"));
    EXPECT_EQ(run({"--decimal", "comma"}).exit_code, 1);  // three samples do not identify anything
    EXPECT_EQ(run({"--decimal", "comma", "--header-lines", "1", "--separator", "semicolon"}).exit_code, 1);
    EXPECT_THAT(run({"--decimal", "dot"}).err, HasSubstr("--decimal"));
    EXPECT_THAT(run({"--header-lines", "3"}).err, HasSubstr("--header-lines: 3: there is no line below"));
}

TEST(IdentifyTable, OptionsOfATable_AreRefusedWithRecordings) {
    const TemporaryFolder folder;
    const auto run = run_program({"identify", "macro", "somewhere", "--decimal", "comma"}, folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(
        run.err,
        HasSubstr("--columns, --rate-hz, --header-lines, --decimal, --separator: are for --table only"));
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/text_table.h"

#include "src/identify/input.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;

constexpr std::array<std::string_view, 3> roles{"input", "output", "time"};

TextTable table_of(const std::string& text, std::string_view columns) {
    const TemporaryFolder folder;
    return read_text_table(folder.write("table.txt", text), parse_columns(columns, roles, 2));
}

TEST(TextTable, EverySeparator_IsSeen) {
    for (const char* text :
         {"1,2\n3,4\n", "1;2\n3;4\n", "1\t2\n3\t4\n", "  1   2\n3 4  \n", "+1,2\r\n3,4\r\n"}) {
        SCOPED_TRACE(text);
        const TextTable table = table_of(text, "input=1,output=2");
        EXPECT_THAT(table.columns[0].values, ElementsAre(1.0, 3.0));
        EXPECT_THAT(table.columns[1].values, ElementsAre(2.0, 4.0));
    }
}

TEST(TextTable, Titles_NameColumnsAndUnits) {
    const std::string text = "time,Control input [V],position [um]\n0,1,2000\n1,2,3000\n";
    const TextTable table = table_of(text, "input=Control input,output=position [um],time=time");
    EXPECT_THAT(values_in(table, "input", "V"), ElementsAre(1.0, 2.0));
    EXPECT_THAT(values_in(table, "output", "mm"), ElementsAre(2.0, 3.0));
    EXPECT_THAT(values_in(table_of(text, "input=2[mV],output=3[nm]"), "input", "V"),
                ElementsAre(0.001, 0.002));
}

TEST(TextTable, Mistakes_AreOneLineWithPlaceAndReason) {
    struct Mistake {
        std::string text, columns, message;
    };
    const std::array mistakes{
        Mistake{"", "input=1,output=2", "is empty"},
        Mistake{"\n\n", "input=1,output=2", "there is no row"},
        Mistake{"a,b\n", "input=1,output=2",
                "there is no row of two or more fields with a number among them"},
        Mistake{"1,2\n3\n", "input=1,output=2", "table.txt:2: has 1 fields; the rows above have 2"},
        Mistake{
            "3\n1,2\n", "input=1,output=2",
            "table.txt:1: has 1 field; the rows below have 2; if the rows begin below it: --header-lines 1"},
        Mistake{"1,2\n3,nan\n", "input=1,output=2", "table.txt:2: column 2: 'nan': must be finite"},
        Mistake{"1,2\n3,inf\n", "input=1,output=2", "table.txt:2: column 2: 'inf': must be finite"},
        Mistake{"1,2\n3,\n", "input=1,output=2", "table.txt:2: column 2: '': must be a number"},
        Mistake{"1,2\n3,x\n", "input=1,output=2", "table.txt:2: column 2: 'x': must be a number"},
        Mistake{"1,2\n", "input=1,output=3", "output=3: no such column; allowed: 1 to 2"},
        Mistake{"a,b\n1,2\n", "input=c,output=2", "input=c: no such column; allowed: 1 to 2, a, b"},
        Mistake{"a,b,a\n1,2,3\n", "input=a,output=2", "input=a: is the title of columns 1 and 3"},
        Mistake{"2,b\n1,2\n3,4\n", "input=2,output=b",
                "input=2: is the number of one column and the title of column 1"},
        Mistake{
            "a,b\n1,2\nb,a\n3,4\n", "input=1,output=2",
            "table.txt:3: is no row of numbers, but stands between line 2, which is one, and the rows below; "
            "if the rows begin below it: --header-lines 3"},
        Mistake{"a,b\nERR,2\n3,4\n", "input=1,output=2",
                "table.txt:2: stands between titles and rows, with text in a column of numbers; if the rows "
                "begin "
                "below it: --header-lines 2"},
    };
    for (const Mistake& mistake : mistakes) {
        SCOPED_TRACE(mistake.message);
        const std::string message = message_of([&] { table_of(mistake.text, mistake.columns); });
        EXPECT_THAT(message, HasSubstr(mistake.message));
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(TextTable, WrongChoices_SayWhatIsAllowed) {
    struct Mistake {
        const char *columns, *message;
    };
    for (const Mistake& mistake :
         {Mistake{"", "input is missing"}, Mistake{"input=1", "output is missing"},
          Mistake{"input", "'input' is not ROLE=COLUMN"}, Mistake{"force=1,output=2", "'force' is no role"},
          Mistake{"input=1,input=2", "input is given twice"},
          Mistake{"input=,output=2", "input has no column"}})
        EXPECT_THAT(message_of([&] { parse_columns(mistake.columns, roles, 2); }),
                    ::testing::AllOf(HasSubstr(mistake.message), HasSubstr("roles input, output, time")));
}

TEST(TextTable, UnitOfAnotherQuantity_IsRefused) {
    const TextTable table = table_of("1,2\n", "input=1[mm],output=2[furlong]");
    EXPECT_THAT(message_of([&] { values_in(table, "input", "V"); }),
                HasSubstr("input: unit 'mm': allowed: V, mV"));
    EXPECT_THAT(message_of([&] { values_in(table, "output", "mm"); }),
                HasSubstr("output: unit 'furlong': allowed: mm, um"));
}

TEST(TextTable, UnitsInTitles_AreThoseThatPeopleWrite) {
    struct Example {
        const char *title, *role_unit;
        double value_of_one;
    };
    for (const Example& example :
         {Example{"Position (mm)", "mm", 1.0}, Example{"Position/mm", "mm", 1.0},
          Example{"s / \xC2\xB5m", "mm", 1e-3}, Example{"x [\xC2\xB5m]", "mm", 1e-3},
          Example{"x [\xB5m]", "mm", 1e-3}, Example{"x_um", "mm", 1e-3}, Example{"Zeit (ms)", "s", 1e-3},
          Example{"Time (sec)", "s", 1.0}, Example{"U/V", "V", 1.0},
          Example{"Droop pulses (by 1 pls.)", "V", 1.0}, Example{"U", "V", 1.0},
          Example{"T [\xC2\xB0"
                  "C]",
                  "degC", 1.0}}) {
        SCOPED_TRACE(example.title);
        const TextTable table = table_of(fmt::format("t;{}\n0;1\n1;2\n", example.title), "input=1,output=2");
        EXPECT_NEAR(values_in(table, "output", example.role_unit)[0], example.value_of_one, 1e-15);
    }
}

TEST(TextTable, UnitThatIsAnothersOrOnlyPerhapsOne_IsAskedFor) {
    const auto message = [](const char* title, const char* unit) {
        const TextTable table = table_of(fmt::format("t;{}\n0;1\n1;2\n", title), "input=1,output=2");
        return message_of([&] { values_in(table, "output", unit); });
    };
    EXPECT_THAT(message("Force (N)", "V"), HasSubstr("output: unit 'N': allowed: V, mV"));
    EXPECT_THAT(
        message("x_m", "mm"),
        HasSubstr(
            "table.txt:1: output: 'x_m' may name its unit, m, or not: say it in --columns, as output=2[m] "
            "or [mm]"));
    EXPECT_THAT(message_of([] { table_of("t;x [mm]\ns;um\n0;1\n1;2\n", "input=1,output=2"); }),
                HasSubstr("column 2: unit 'mm', but 'um' in line 2"));
}

TEST(TextTable, TitlesWithBlanks_StandAboveWideGaps) {
    const TextTable table =
        table_of("# Time (ms)   Motor current  Position (um)\n0.5  1.5  2000\n1.0  2.5  3000\n",
                 "input=Motor current,output=3,time=Time");
    EXPECT_THAT(values_in(table, "output", "mm"), ElementsAre(2.0, 3.0));
    EXPECT_THAT(values_in(table, "time", "s"), ElementsAre(0.0005, 0.001));
}

TEST(TextTable, UnitsThatBelongToNoColumn_AreAskedFor) {
    EXPECT_THAT(
        message_of([] {
            values_in(table_of("# t [s] x [um]\n0.5 1.5\n1.0 2.5\n", "input=1[s],output=2"), "output", "mm");
        }),
        HasSubstr(
            "table.txt:1: output: '# t [s] x [um]' may name its unit, um, or not: say it in --columns, as "
            "output=2[um] or [mm]"));
    EXPECT_THAT(table_of("# t [s] x [um]\n0.5 1.5\n1.0 2.5\n", "input=1[s],output=2[um]").columns[1].values,
                ElementsAre(1.5, 2.5));
}

TEST(TextTable, LineOfUnitsBelowTitles_Counts) {
    const TextTable table =
        table_of("Time,Channel A\n(ms),(mV)\n\n0.5,100\n1.0,200\n", "input=Channel A,output=Time");
    EXPECT_THAT(values_in(table, "input", "V"), ElementsAre(0.1, 0.2));
    EXPECT_THAT(values_in(table, "output", "s"), ElementsAre(0.0005, 0.001));
    // A line of titles alone: s, V may be names.
    EXPECT_EQ(table_of("m;s\n1.5;2\n3;4\n", "input=1,output=2").columns[0].unit, "");
}

TEST(TextTable, InstrumentsHeader_IsPassedOverAndSaid) {
    const std::string text =
        "\xEF\xBB\xBFTimestamp,2020-03-16 17:04:51,Timestamp,2020-03-16 "
        "17:04:51\r\nInterval,0.0005,Interval,0.0005\r\n"
        "Channel name,\"Force\",Channel name,\"Input 1\"\r\nUnit,\"V\",Unit,\"mV\"\r\n"
        "0,-0.129,0,-3.21\r\n0.0005,-0.130,0.0005,-3.22\r\n";
    const TextTable table = table_of(text, "input=Force,output=4,time=1");
    EXPECT_THAT(values_in(table, "input", "V"), ElementsAre(-0.129, -0.130));
    EXPECT_THAT(values_in(table, "output", "V"), ElementsAre(-0.00321, -0.00322));
    EXPECT_THAT(values_in(table, "time", "s"), ElementsAre(0.0, 0.0005));
    EXPECT_THAT(table.notes, ElementsAre("the rows begin at line 5; titles are those of lines 3 and 4"));
}

TEST(TextTable, SeveralLinesOfTitles_AreAllLookedIn) {
    const std::string text =
        "Axis1\r\nNumber of sampling data,1024\r\nSampling time interval(ms),0.667\r\nTime,Analog 1,Analog "
        "2\r\n"
        "ms,Servo motor speed,Torque\r\n0.000,0.0,-1.0\r\n0.667,0.5,-0.8\r\n";
    const TextTable table = table_of(text, "input=Torque,output=Analog 1,time=Time");
    EXPECT_THAT(values_in(table, "time", "s"), ElementsAre(0.0, ::testing::DoubleNear(0.000667, 1e-15)));
    EXPECT_THAT(table.columns[0].values, ElementsAre(-1.0, -0.8));
    EXPECT_THAT(table.notes, ElementsAre("the rows begin at line 6; titles are those of lines 4 and 5"));
}

TEST(TextTable, ClockTimes_BecomeSeconds) {
    const TextTable table = table_of("When;u;x\n2020-03-16 23:59:59.500;1;2\n2020-03-17 00:00:00.250;1;2\n",
                                     "input=2,output=3,time=When");
    EXPECT_THAT(values_in(table, "time", "s"), ElementsAre(0.0, 0.75));
    EXPECT_THAT(message_of([] {
                    table_of("When;u;x\n03/04/2020 23:59:59;1;2\n03/05/2020 00:00:00;1;2\n",
                             "input=2,output=3,time=When");
                }),
                HasSubstr("table.txt:3: column 1: '03/05/2020 00:00:00': day and month could be exchanged"));
}

TEST(TextTable, LastLineWithoutEnd_IsReadAndSaid) {
    const TextTable table = table_of("1,2\n3,4", "input=1,output=2");
    EXPECT_THAT(table.columns[1].values, ElementsAre(2.0, 4.0));
    EXPECT_THAT(table.notes, ElementsAre(HasSubstr("the last line has no end")));
}

TEST(TableTimes, RateOrColumn_GiveSeconds) {
    IdentifyInput input{{}, {}, table_of("1,2,5\n1,2,7\n", "input=1,output=2"), 200.0};
    EXPECT_THAT(table_times_s(input), ElementsAre(0.0, 0.005));
    input.table = table_of("1,2,5\n1,2,7\n", "input=1,output=2,time=3[ms]");
    EXPECT_THAT(table_times_s(input), ElementsAre(0.005, 0.007));
}

TEST(TableTimes, Backwards_IsRefused) {
    const IdentifyInput input{{}, {}, table_of("1,2,5\n1,2,5\n", "input=1,output=2,time=3"), 0.0};
    EXPECT_THAT(message_of([&] { table_times_s(input); }),
                HasSubstr("row 2: time: 5: must be after the row before, 5"));
}

TEST(TableAsMacroRecording, UnequalSpacing_IsRefused) {
    const IdentifyInput input{
        {}, {}, table_of("1,2,0\n1,2,1\n1,2,2.2\n1,2,3\n", "input=1,output=2,time=3[ms]"), 0.0};
    EXPECT_THAT(message_of([&] { table_as_macro_recording(input); }),
                HasSubstr("row 3: time: 0.0022: rows must be equally spaced"));
}

}  // namespace
}  // namespace fidservo

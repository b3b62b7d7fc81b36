// SPDX-License-Identifier: GPL-3.0-or-later
// Units that stand somewhere above a table's rows, in the forms that instruments and people write.
#include "src/identify/identify.h"
#include "src/identify/text_table.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;

/// Two rows, a millisecond apart, below a header.
TextTable table_below(const std::string& header, char separator = ';') {
    constexpr std::array<std::string_view, 3> roles{"input", "output", "time"};
    std::string text = header + "\n0.5;2000.5;80000.5\n1.5;3000.5;90000.5\n";
    for (char& letter : text)
        if (letter == ';') letter = separator;
    const testing::TemporaryFolder folder;
    return read_text_table(folder.write("table.txt", text),
                           parse_columns("input=2,output=3,time=1", roles, 2));
}

IdentifyInput input_of(TextTable table, double rate_hz = 0.0) {
    IdentifyInput input{{}, {}, std::move(table), rate_hz};
    input.rig.tick_s = 0.001;
    return input;
}

TEST(UnitsAbove, WhereverTheyStand_AreTheColumns) {
    for (const char* header :
         {"time [ms];u [mV];x [um]\n# recorded by me", "time;u;x\n# ms;mV;um",
          "time [ms];u [mV];x [um]\nBEGIN DATA", "# time [ms];u [mV];x [um]\nstart",
          "time;u;x\n# of Monday\nms;mV;um", "ms;mV;um\ntime;u;x", "time;u;x\nms;mV;um\nraw;raw;raw",
          "x-axis;1;2\nmillisecond;mV;um", "X;CH1;CH2\nmsec;millivolt;microns"}) {
        SCOPED_TRACE(header);
        const TextTable table = table_below(header);
        EXPECT_NEAR(values_in(table, "time", "s")[0], 0.0005, 1e-12);
        EXPECT_NEAR(values_in(table, "input", "V")[0], 2.0005, 1e-12);
        EXPECT_NEAR(values_in(table, "output", "mm")[0], 80.0005, 1e-12);
    }
}

TEST(UnitsAbove, FactorsThere_AreNotPassedOver) {
    for (const char* header : {"scale;0.001;0.001\ntime [s];u [V];x [mm]", "Factor;1e-3;25.4\ntime;u;x"})
        EXPECT_THAT(message_of([&] { table_below(header); }), HasSubstr("gives the columns factors"))
            << header;
    EXPECT_NO_THROW(table_below("rate;1000;1000\ntime [s];u [V];x [mm]"));
}

TEST(UnitsAbove, InAnyFormOfTitle_AreRead) {
    for (const char* form :
         {"{} in {}", "{}, {}", "{} {{{}}}", "{} <{}>", "[{1}] {0}", "{}.{}", "{} {}", "{} [{}] raw"}) {
        const auto title = [&](const char* name, const char* unit) {
            return fmt::format(fmt::runtime(form), name, unit);
        };
        const std::string header = title("time", "ms") + ";" + title("u", "mV") + ";" + title("x", "um");
        SCOPED_TRACE(header);
        const TextTable table = table_below(header);
        EXPECT_NEAR(values_in(table, "time", "s")[0], 0.0005, 1e-12);
        EXPECT_NEAR(values_in(table, "output", "mm")[0], 80.0005, 1e-12);
    }
}

TEST(UnitsAbove, OfAnotherQuantityBelowTitlesThatAreNumbers_AreRefused) {
    const TextTable table = table_below("x-axis,1,2\nsecond,Volt,Volt", ',');
    EXPECT_THAT(message_of([&] { values_in(table, "output", "mm"); }),
                HasSubstr("output: unit 'V': allowed: mm"));
}

TEST(UnitsAbove, InALineThatHasNoFieldForEachColumn_AreAskedAbout) {
    for (const char* line :
         {"Units: ms, mV, um", "Units ms mV um", "Horizontal;ms\nVertical;um", "# all positions (um)"}) {
        SCOPED_TRACE(line);
        const TextTable table = table_below(std::string(line) + "\ntime;u;x");
        EXPECT_THAT(message_of([&] { values_in(table, "output", "mm"); }),
                    AllOf(HasSubstr("table.txt:"), HasSubstr("may name its unit, um, or not"),
                          HasSubstr("output=3[um] or [mm]")));
    }
    // An instrument's key and value are no unit of a column that stands below.
    EXPECT_EQ(values_in(table_below("Model;MSO;\nUnits;s;\nLength;12600;\n\ntime;u;x"), "input", "V")[0],
              2000.5);
    // What it names is of another quantity, or the usual one.
    EXPECT_EQ(values_in(table_below("Interval;0.5;ms;mm\ntime;u;x"), "output", "mm")[0], 80000.5);
}

TEST(UnitsAbove, TitlesThatAreUnitsAlone_AreAskedAbout) {
    EXPECT_THAT(message_of([] { values_in(table_below("ms;mV;um"), "input", "V"); }),
                HasSubstr("'mV' may name its unit, mV, or not"));
}

TEST(TimeWithoutUnit, IsTakenForSecondsOnlyWhereATickCanBeThatLong) {
    const auto message = [](const char* header) {
        const IdentifyInput input = input_of(table_below(header));
        return message_of([&] { table_times_s(input); });
    };
    EXPECT_THAT(
        message("time;u;x"),
        AllOf(
            HasSubstr("time: its unit is not stated, and rows 1 apart are hardly seconds: a tick of the rig"),
            HasSubstr("0.001 s; say it in --columns, as time=1[UNIT] with one of s, ms, us, ns"),
            HasSubstr("--rate-hz")));
    EXPECT_THAT(message("Sequence;u;x"), HasSubstr("its unit is not stated"));
    EXPECT_NEAR(table_times_s(input_of(table_below("time [s];u;x")))[1], 1.5, 1e-12);
    IdentifyInput slow = input_of(table_below("time;u;x"));
    slow.rig.tick_s = 0.1;
    EXPECT_NEAR(table_times_s(slow)[1], 1.5, 1e-12);
}

/// Rows of a carriage that is driven to and fro.
IdentifyInput driven_carriage(double rate_hz) {
    TextTable table{"table.txt", {{"input", "V", {}}, {"output", "mm", {}}}};
    double speed_mm_per_s = 0.0, place_mm = 80.0;
    for (int k = 0; k < 400; ++k) {
        const double command_V = k / 50 % 2 == 0 ? 4.0 : -4.0;
        table.columns[0].values.push_back(command_V);
        table.columns[1].values.push_back(0.05 * std::round(place_mm / 0.05));
        speed_mm_per_s += 0.02 * (150.0 * command_V / 4.0 - speed_mm_per_s);
        place_mm += 0.001 * speed_mm_per_s;
    }
    IdentifyInput input = input_of(std::move(table), rate_hz);
    input.rig.macro.encoder_resolution_mm = 0.05;
    input.rig.macro.low_mm = 0.0;
    input.rig.macro.high_mm = 250.0;
    input.rig.macro.command_limit_V = 10.0;
    input.rig.macro.dead_zone = {.threshold_V = 1.0, .offset_V = 0.5, .slope = 0.5};
    return input;
}

TEST(IdentifyMacro, RowsAtAnyRate_AreIdentifiedOrRefused) {
    for (const double rate_hz : {1.0, 2.0, 20.0, 1000.0, 1e6, 1e9}) {
        SCOPED_TRACE(rate_hz);
        const Identified identified = identify_macro(driven_carriage(rate_hz));
        EXPECT_FALSE(identified.values.empty() && identified.undetermined.empty());
    }
    EXPECT_THAT(
        message_of([] { identify_macro(driven_carriage(0.1)); }),
        HasSubstr(
            "rows are 10 s apart: the carriage's motion between them is not seen; allowed: 1 s at most"));
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// What a map may say, and what a log and a map have to agree on.
#include "src/import/assemble.h"
#include "src/import/import_map.h"
#include "tests/import/made_files.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::message_of;
using ::testing::HasSubstr;

constexpr const char* head = "format: fidservo-map/1\nrecording: { name: a, rig: b, experiment: c }\n";

Assembled assembled(const std::string& map, std::vector<Log> logs) {
    return assemble(logs, parse_import_map(head + map, "map.yaml"));
}

/// t in s every 10 ms from 0, x = 3 t in m.
Log small_log() {
    Log log{.file = "log.csv"};
    LoggedSignal t{.name = "t", .unit = "s"}, x{.name = "x", .unit = "m"}, u{.name = "u"};
    for (int k = 0; k < 101; ++k) {
        t.values.push_back(0.01 * k);
        x.values.push_back(0.03 * k);
        u.values.push_back(k % 10);
    }
    log.signals = {t, x, u};
    return log;
}

TEST(ImportMap, MistakesInIt_AreOneLineEach) {
    const auto refused = [](const std::string& map) {
        return message_of([&] { assembled(map, {small_log()}); });
    };
    EXPECT_THAT(refused("columns: { positoin: x }\n"),
                HasSubstr("map.yaml:3: columns.positoin: x: is no column; allowed: macro_setpoint"));
    EXPECT_THAT(refused("columns: { position: z }\ntime: t\n"), HasSubstr("z: there is no such signal"));
    EXPECT_THAT(refused("columns: { position: 'x [mm]' }\ntime: t\n"),
                HasSubstr("x: unit 'mm', but log.csv states 'm'"));
    EXPECT_THAT(refused("columns: { position: u }\ntime: t\n"),
                HasSubstr("log.csv states no unit; say it, as u [mm]"));
    EXPECT_THAT(refused("columns: { position: 'u [V]' }\ntime: t\n"),
                HasSubstr("unit 'V': allowed: mm, um, nm, cm, m, or another one and factor"));
    EXPECT_THAT(refused("columns: { position: x }\n"), HasSubstr("log.csv does not tell its times"));
    EXPECT_THAT(refused("columns: { position: x }\ntime: u [s]\n"),
                HasSubstr("its times do not rise: 9000000000 ns at sample 10, then 0 ns"));
    EXPECT_THAT(refused("columns: { position: x }\ntime: x\n"), HasSubstr("unit 'm' is none of time"));
    EXPECT_THAT(refused("columns: { position: x, encoder: u }\ntime: t\n"),
                HasSubstr("one of them is allowed"));
    EXPECT_THAT(refused("columns: { macro_command: 'u [V]' }\ntime: t\n"), HasSubstr("nothing was measured"));
    EXPECT_THAT(refused("columns: { position: { signal: x, clock: cam } }\ntime: t\n"),
                HasSubstr("clock: cam: is not one of clocks"));
    EXPECT_THAT(refused("columns: { position: { signal: x, factor: 0 } }\ntime: t\n"),
                HasSubstr("must not be 0"));
    EXPECT_THAT(refused("time: t\n"), HasSubstr("asks for nothing"));
    EXPECT_THAT(refused("columns: { position: x }\nclocks: { a: { signal: t, offset_s: 1e10 } }\n"),
                HasSubstr("offset_s"));
    EXPECT_THAT(refused("columns: { position: x }\ntime: { rate_hz: 0.5 }\n"),
                HasSubstr("at most 1 s is allowed"));
}

TEST(ImportMap, TitleThatIsThereTwice_HasToSayWhich) {
    Log log = small_log();
    log.signals[1].name = "x#2";
    log.signals[2].name = "x#3";
    EXPECT_THAT(message_of([&] { assembled("columns: { position: 'x [mm]' }\ntime: t\n", {log}); }),
                HasSubstr("x: 2 columns have this title; say which: x#2, x#3"));
}

TEST(ImportMap, SignalOfTwoFiles_HasToSayWhich) {
    Log other = small_log();
    other.file = "more/other.csv";
    EXPECT_THAT(message_of([&] {
                    assembled("columns: { position: x }\ntime: 'log:t'\n", {small_log(), other});
                }),
                HasSubstr("x: is in log.csv and in other.csv; say which, as log.csv:x"));
    const Assembled made =
        assembled("columns: { position: 'other.csv:x' }\ntime: 'log:t'\n", {small_log(), other});
    EXPECT_EQ(made.recording.rows.size(), 101u);
}

TEST(ImportMap, UnitsAndFactors_GiveTheRecordingsUnit) {
    const Assembled made = assembled(
        "time: t\ncolumns:\n  position: x\n  macro_command: { signal: u, unit: A, factor: 2.5, offset: -1 "
        "}\n",
        {small_log()});
    ASSERT_EQ(made.recording.rows.size(), 101u);
    EXPECT_DOUBLE_EQ(made.recording.tick_s, 0.01);
    EXPECT_DOUBLE_EQ(made.recording.rows[7].position_mm, 1e3 * (0.03 * 7));
    EXPECT_DOUBLE_EQ(made.recording.rows[7].macro_command_V, 2.5 * 7 - 1.0);
    EXPECT_EQ(made.recording.rows[7].time_ns, 70'000'000);
}

TEST(Resampling, ToAnotherTick_IsLinearForReadingsAndHeldForCommands) {
    const Assembled made =
        assemble({small_log()},
                 parse_import_map(
                     "format: fidservo-map/1\nrecording: { name: a, rig: b, experiment: c, tick_s: 0.004 }\n"
                     "time: t\ncolumns: { position: x, macro_command: 'u [V]' }\n",
                     "map.yaml"));
    ASSERT_EQ(made.recording.rows.size(), 251u);
    for (const StageRow& row : made.recording.rows) {
        const double t = seconds(row.time_ns);
        EXPECT_NEAR(row.position_mm, 3000.0 * t, 1e-6);
        EXPECT_EQ(row.macro_command_V, std::fmod(std::floor(t / 0.01 + 1e-6), 10.0)) << t;
    }
    EXPECT_THAT(made.notes.front(),
                HasSubstr("macro_command: u of log.csv, 101 samples at 100 Hz, resampled to 250 Hz: held"));
    EXPECT_THAT(made.notes.back(), HasSubstr("on lines between samples"));
}

TEST(Resampling, RowsInAGap_AreLeftOutAndCounted) {
    Log log = small_log();
    for (LoggedSignal& signal : log.signals)
        signal.values.erase(signal.values.begin() + 40, signal.values.begin() + 50);
    const Assembled made = assemble(
        {log},
        parse_import_map(
            "format: fidservo-map/1\nrecording: { name: a, rig: b, experiment: c, tick_s: 0.004 }\ntime: t\n"
            "columns: { position: x }\n",
            "map.yaml"));
    for (const StageRow& row : made.recording.rows)
        EXPECT_FALSE(row.time_ns > 390'000'000 && row.time_ns < 500'000'000) << row.time_ns;
    EXPECT_EQ(made.recording.rows.size(), 251u - 27u);
    EXPECT_THAT(made.notes.back(), HasSubstr("27 of 251 rows left out"));
}

TEST(Resampling, SignalsOfTwoClocks_ShareTheTimeThatBothHave) {
    Log log = small_log();
    LoggedSignal s{.name = "s", .unit = "ms"}, y{.name = "y", .unit = "um"};
    for (int k = 0; k < 60; ++k) {
        s.values.push_back(500.0 + 20.0 * k);
        y.values.push_back(k);
    }
    log.signals.push_back(s);
    log.signals.push_back(y);
    const std::string map =
        "clocks: { a: t, b: { signal: s, offset_s: -0.1 } }\ncolumns:\n  macro_command: { signal: u, unit: "
        "V, clock: a }\n"
        "  position: { signal: y, clock: b }\n";
    const Assembled made = assembled(map, {log});
    ASSERT_FALSE(made.recording.rows.empty());
    EXPECT_EQ(made.recording.rows.front().time_ns, 400'000'000);
    EXPECT_EQ(made.recording.rows.back().time_ns, 1'000'000'000);
    EXPECT_NEAR(made.recording.rows[1].position_mm, 0.5e-3, 1e-12);
    const std::string apart =
        "clocks: { a: t, b: { signal: s, offset_s: 9 } }\ncolumns:\n  macro_command: { signal: u, unit: V, "
        "clock: a }\n"
        "  position: { signal: y, clock: b }\n";
    EXPECT_THAT(message_of([&] { assembled(apart, {log}); }), HasSubstr("the signals share no time"));
}

TEST(ImportMap, ClockThatIsFitted_IsSaidWithItsStd) {
    Log log{.file = "log.csv"};
    LoggedSignal t{.name = "t", .unit = "s"}, x{.name = "x", .unit = "mm"}, u{.name = "u", .unit = "V"},
        s{.name = "s", .unit = "s"}, y{.name = "y", .unit = "um"};
    const auto motion = [](double at) {
        return std::sin(2.1 * at) + std::sin(5.3 * at) + 2.0 * std::sin(0.77 * at);
    };
    for (int k = 0; k < 20'000; ++k) {
        t.values.push_back(1e9 + 0.001 * k);
        x.values.push_back(motion(0.001 * k));
        u.values.push_back(k);
    }
    for (int k = 0; k < 600; ++k) {
        s.values.push_back(0.03 * k);
        y.values.push_back(1e3 * motion(0.03 * k * (1.0 + 50e-6) + 0.25));
    }
    log.signals = {t, x, u, s, y};
    const Assembled made = assembled(
        "clocks:\n  daq: t\n  camera: { signal: s, fit: { signal: y, to: x } }\ncolumns:\n  macro_command: "
        "u\n"
        "  position: { signal: y, clock: camera }\n",
        {log});
    EXPECT_THAT(made.notes.front(), HasSubstr("clock camera: fitted by y to x: offset 1000000000.25"));
    EXPECT_THAT(made.notes.front(), HasSubstr("(std 0.000"));
    double worst = 0.0;
    for (const StageRow& row : made.recording.rows)
        worst = std::max(
            worst, std::abs(row.position_mm - motion(seconds(row.time_ns - 1'000'000'000'000'000'000))));
    EXPECT_LT(worst, 5e-3) << "the line between samples 30 ms apart is off by 1/8 of the curvature";
}

}  // namespace
}  // namespace fidservo::imports

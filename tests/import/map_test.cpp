// SPDX-License-Identifier: GPL-3.0-or-later
// What a map may say, and what a log and a map have to agree on.
#include "src/import/assemble.h"
#include "src/import/import_map.h"
#include "src/import/resample.h"
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

const std::string columns_of_small_log = "time: t\ncolumns: { position: x, macro_command: 'u [V]' }\n";

TEST(Resampling, ReadingsWithoutANumber_AreLeftOutAndCounted) {
    Log log = small_log();
    for (const std::size_t k : {10u, 50u, 51u}) log.signals[1].values[k] = std::nan("");
    const Assembled made = assembled(columns_of_small_log, {log});
    EXPECT_EQ(made.recording.rows.size(), 98u);
    for (const StageRow& row : made.recording.rows)
        EXPECT_EQ(row.macro_command_V, std::fmod(std::round(seconds(row.time_ns) / 0.01), 10.0));
    EXPECT_THAT(made.notes[2], HasSubstr("98 samples at 100 Hz (3 more have no number), as they are"));
    EXPECT_THAT(made.notes[3], HasSubstr("3 of 101 rows left out"));
}

TEST(Resampling, ReadingOfASlowerRate_IsDrawnBetweenItsSamples) {
    Log log = small_log();
    for (std::size_t k = 0; k < 101; ++k)
        if (k % 10 != 0) log.signals[1].values[k] = std::nan("");
    const Assembled made = assembled(columns_of_small_log, {log});
    ASSERT_EQ(made.recording.rows.size(), 101u);
    EXPECT_NEAR(made.recording.rows[7].position_mm, 1e3 * 0.03 * 7, 1e-6);
    EXPECT_THAT(made.notes[2],
                HasSubstr("11 samples at 10 Hz (90 more have no number), resampled to 100 Hz"));
}

TEST(Resampling, CommandThatIsLoggedWhereItChanges_IsInForceUntilTheEnd) {
    Log log = small_log();
    log.signals.push_back({.name = "at", .unit = "s", .values = {0.0, 0.3}});
    log.signals.push_back({.name = "v", .unit = "V", .values = {1.5, -2.0}, .times = "at"});
    log.signals[1].times = "t";
    const Assembled made = assembled("columns: { position: x, macro_command: v }\n", {log});
    EXPECT_DOUBLE_EQ(made.recording.tick_s, 0.01);
    ASSERT_EQ(made.recording.rows.size(), 101u);
    EXPECT_EQ(made.recording.rows[29].macro_command_V, 1.5);
    EXPECT_EQ(made.recording.rows[100].macro_command_V, -2.0);
}

TEST(Resampling, TimesThatAreNotSteady_AreResampled) {
    Log log = small_log();
    for (std::size_t k = 1; k < 101; ++k)
        log.signals[0].values[k] = log.signals[0].values[k - 1] + (k % 3 == 0 ? 0.017 : 0.01);
    const Assembled made = assembled(columns_of_small_log, {log});
    ASSERT_EQ(made.recording.rows.size(), 124u);
    for (std::size_t k = 1; k < made.recording.rows.size(); ++k)
        EXPECT_EQ(made.recording.rows[k].time_ns - made.recording.rows[k - 1].time_ns, 10'000'000);
}

TEST(Resampling, WhatAnotherSignalDoesNotCover_IsSaid) {
    Log log = small_log();
    LoggedSignal s{.name = "s", .unit = "s"}, v{.name = "v", .unit = "V", .times = "s"};
    for (int k = 0; k < 51; ++k) {
        s.values.push_back(0.01 * k);
        v.values.push_back(1.0);
    }
    log.signals[1].times = "t";
    log.signals.push_back(s);
    log.signals.push_back(v);
    const Assembled made = assembled("columns: { position: x, macro_command: v }\n", {log});
    EXPECT_EQ(made.recording.rows.size(), 51u);
    EXPECT_THAT(made.notes.back(),
                HasSubstr("0.49 s of it left out, in which another signal has no samples"));
}

TEST(NearbyTick, OfARateOrOfThreeDigits_IsTheNearerOne) {
    EXPECT_DOUBLE_EQ(nearby_tick_s(976'562), 1.0 / 1024.0);
    EXPECT_DOUBLE_EQ(nearby_tick_s(3'333'333), 1.0 / 300.0);
    EXPECT_DOUBLE_EQ(nearby_tick_s(1'000'400), 0.001);
    EXPECT_DOUBLE_EQ(nearby_tick_s(30'000'000), 0.03);
    EXPECT_DOUBLE_EQ(nearby_tick_s(3'330'000), 0.00333);
    EXPECT_DOUBLE_EQ(nearby_tick_s(37'453'000), 0.037453);
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

TEST(ImportMap, FilesOfTheSameName_AreToldApartByTheirFolders) {
    Log one = small_log(), other = small_log();
    one.file = "monday/log.csv";
    other.file = "tuesday/log.csv";
    EXPECT_THAT(message_of([&] {
                    assembled("columns: { position: x }\ntime: t\n", {one, other});
                }),
                HasSubstr("x: is in monday/log.csv and in tuesday/log.csv; say which, as monday/log.csv:x"));
    const Assembled made =
        assembled("columns: { position: 'tuesday/log.csv:x' }\ntime: 'tuesday/log.csv:t'\n", {one, other});
    EXPECT_EQ(made.recording.rows.size(), 101u);
}

TEST(ImportMap, RateOfASignalThatHasTimes_IsRefused) {
    Log log = small_log();
    log.signals[1].times = "t";
    EXPECT_THAT(message_of([&] { assembled("columns: { position: x }\ntime: { rate_hz: 1000 }\n", {log}); }),
                HasSubstr("rate_hz: 1000: x of log.csv has times of its own, t"));
}

/// Whatever else the map takes from the clock.
TEST(ImportMap, RateOfAClock_CountsFromItsEarliestTime) {
    Log log = small_log();
    LoggedSignal late{.name = "late", .unit = "s"}, y{.name = "y", .unit = "mm", .times = "late"};
    for (int k = 0; k < 50; ++k) {
        late.values.push_back(0.5 + 0.01 * k);
        y.values.push_back(k);
    }
    log.signals[1].times = log.signals[2].times = "t";
    log.signals.push_back(late);
    log.signals.push_back(y);
    const auto last_of = [&](const std::string& columns) {
        return assembled("clocks: { all: { rate_ppm: 10000 } }\ncolumns: { " + columns + " }\n", {log})
            .recording.rows.back()
            .time_ns;
    };
    EXPECT_EQ(last_of("position: y"), 990'000'000 + 4'900'000);
    EXPECT_EQ(last_of("position: y, macro_command: 'u [V]'"), 990'000'000 + 9'900'000);
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

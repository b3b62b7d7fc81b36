// SPDX-License-Identifier: GPL-3.0-or-later
// A recording, given to other programs' formats by their own libraries, comes back number for number, and its
// diagnosis byte for byte.
#include "core/input_error.h"
#include "src/files/recording/reader.h"
#include "tests/import/made_files.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::run_program;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;
using ::testing::HasSubstr;

constexpr const char* experiment = R"(name: ramps
carriage_mm: 20
macro:
  - { ramp_V: [0, 4.5], duration_s: 1.0 }
  - { sine_mm: 5, offset_mm: 60, frequency_hz: 1, duration_s: 1.5 }
micro:
  - { constant_mm: 2.0, duration_s: 1.0 }
)";

/// A recording of the reference rig without its camera, in the folder `original`.
Recording make_original(const TemporaryFolder& folder, const std::string& what) {
    const auto run =
        run_program({"simulate", what, "--effect", "coulomb_friction", "--out", "original"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::filesystem::remove_all(folder / "original/cam0");
    return read_recording(folder / "original");
}

Recording make_short_original(const TemporaryFolder& folder) {
    folder.write("ramps.yaml", experiment);
    return make_original(folder, "ramps.yaml");
}

/// A map for files in which a column's signal is PREFIX and its name.
std::string map_of(const Recording& original, const std::string& time, const std::string& prefix) {
    std::string map = fmt::format(
        "format: fidservo-map/1\nrecording: {{ name: {0}, rig: {1}, tick_s: {2}, experiment: {3}, "
        "controllers: {{ macro: nonlinear_pd, "
        "micro: pi_antiwindup }}, encoder_zero: {{ count: 0, std_count: 0 }} }}\n{4}columns:\n",
        original.name, original.rig, original.tick_s, original.experiment, time);
    for (const StageColumn& column : stage_columns) {
        if (!(original.columns.*column.present)) continue;
        const std::string name(column.title.substr(0, column.title.find(" [")));
        map += fmt::format("  {0}: {1}{0} {2}\n", name, prefix, column.title.substr(name.size() + 1));
    }
    return map;
}

void import_as(const TemporaryFolder& folder, const std::string& file, const std::string& map,
               const std::string& out) {
    folder.write("map.yaml", map);
    const auto run = run_program({"import", file, "--map", "map.yaml", "--out", out}, folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("as they are")) << file;
    EXPECT_EQ(text_of(folder / out / "stage0/data.csv"), text_of(folder / "original/stage0/data.csv"))
        << file;
}

/// Imports the recording from each format as `import_as` does; returns the folders' names.
std::vector<std::string> import_from_every_format(const TemporaryFolder& folder, const Recording& original) {
    const std::vector<testing::MadeSignal> signals = testing::signals_of(original);
    const std::vector<double> time_s = testing::seconds_of(original);
    testing::make_simulink_mat(folder / "five.mat", testing::MatFormat::five, time_s, signals);
    testing::make_simulink_mat(folder / "seven.mat", testing::MatFormat::seven_three, time_s, signals);
    std::vector<testing::MadeSignal> sets{{"/log/t", time_s, "s"}};
    std::vector<testing::BagTopic> topics;
    for (const testing::MadeSignal& signal : signals) {
        sets.push_back({"/log/" + signal.name, signal.values});
        topics.push_back({"/" + signal.name, "sensor_msgs/msg/JointState", {}});
        for (std::size_t k = 0; k < time_s.size(); ++k) {
            const std::int64_t stamp = 1'700'000'000'000'000'000 + original.rows[k].time_ns;
            topics.back().messages.emplace_back(stamp + 70'000,
                                                testing::joint_state(stamp, {"x"}, {signal.values[k]}));
        }
    }
    testing::make_hdf5(folder / "log.h5", sets);
    testing::make_bag(folder / "bag.db3", topics);
    import_as(folder, "five.mat", map_of(original, "", "out."), "from-five");
    import_as(folder, "seven.mat", map_of(original, "", "out."), "from-seven");
    import_as(folder, "log.h5", map_of(original, "time: /log/t\n", "/log/"), "from-hdf5");
    std::string of_bag = map_of(original, "clocks: { host: { offset_s: -1700000000 } }\n", "/");
    for (const StageColumn& column : stage_columns) {
        const std::string name(column.title.substr(0, column.title.find(" [")));
        if (const auto at = of_bag.find(": /" + name + " ["); at != std::string::npos)
            of_bag.insert(at + name.size() + 3, "/position[x]");
    }
    import_as(folder, "bag.db3", of_bag, "from-bag");
    return {"from-five", "from-seven", "from-hdf5", "from-bag"};
}

TEST(ImportedRecording, OfEveryFormat_IsTheOriginalByteForByte) {
    const TemporaryFolder folder;
    const Recording original = make_short_original(folder);
    ASSERT_EQ(original.rows.size(), 2500u);
    for (const std::string& name : import_from_every_format(folder, original)) {
        const Recording imported = read_recording(folder / name);
        EXPECT_EQ(imported.macro_setpoint_step_mm, original.macro_setpoint_step_mm) << name;
        EXPECT_EQ(imported.tick_s, original.tick_s);
        EXPECT_EQ(imported.controllers->macro, original.controllers->macro);
    }
}

TEST(SlowImportedRecording, OfEveryFormat_IsDiagnosedAsTheOriginal) {
    const TemporaryFolder folder;
    const Recording original = make_original(folder, "macro-pulses");
    std::vector<std::string> folders = import_from_every_format(folder, original);
    folders.insert(folders.begin(), "original");
    std::string expected;
    for (const std::string& name : folders) {
        const auto run = run_program(
            {"diagnose", name, "--effects", "coulomb_friction", "--json", name + ".json"}, folder.path());
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const std::string diagnosis = text_of(folder / (name + ".json"));
        EXPECT_THAT(diagnosis, HasSubstr("coulomb_friction"));
        if (expected.empty()) expected = diagnosis;
        EXPECT_EQ(diagnosis, expected) << name;
    }
}

TEST(ExportedRecording, ComesBackFromEveryFormat) {
    const TemporaryFolder folder;
    folder.write("ramps.yaml", experiment);
    ASSERT_EQ(run_program({"simulate", "ramps.yaml", "--out", "original"}, folder.path()).exit_code, 0);
    for (const std::string format : {"mat", "hdf5", "csv"}) {
        const std::string exported = "bob's: run." + format;
        const auto out =
            run_program({"export", "original", "--to", format, "--out", exported}, folder.path());
        ASSERT_EQ(out.exit_code, 0) << out.err;
        std::vector<std::string> command{"import", exported, "--out", "back-" + format};
        if (format == "csv")
            command.insert(command.begin() + 2,
                           {"bob's: run-detections.csv", "--map", "bob's: run.map.yaml"});
        const auto back = run_program(command, folder.path());
        ASSERT_EQ(back.exit_code, 0) << format << ": " << back.err;
        for (const char* file : {"stage0/data.csv", "cam0/detections.csv"})
            EXPECT_EQ(text_of(folder / ("back-" + format) / file), text_of(folder / "original" / file))
                << format << ", " << file;
        const Recording made = read_recording(folder / ("back-" + format)),
                        first = read_recording(folder / "original");
        EXPECT_EQ(made.encoder_zero.has_value(), first.encoder_zero.has_value());
        EXPECT_EQ(made.is_seen, first.is_seen);
        EXPECT_EQ(made.name, first.name);
    }
    const auto again =
        run_program({"export", "original", "--to", "mat", "--out", "bob's: run.mat"}, folder.path());
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.err, HasSubstr("exists already"));
}

/// Recordings of real drives, read as tables of numbers by a map of ten lines.
TEST(ImportedRecording, OfRealDrivesFromCsv_IsTheOriginalByteForByte) {
    const std::filesystem::path data(FIDSERVO_DATA_DIR);
    const TemporaryFolder folder;
    for (const char* name : {"emps/emps-identification", "emps/emps-pulses",
                             "electric-cylinder/lina/lina-square", "electric-cylinder/lina/lina-sweep",
                             "electric-cylinder/lina/lina-sweep-pp", "electric-cylinder/lind/lind-square",
                             "electric-cylinder/lind/lind-square-pp", "electric-cylinder/lind/lind-sweep"}) {
        if (!std::filesystem::exists(data / name)) {
            ASSERT_EQ(std::getenv("FIDSERVO_REQUIRE_DATA"), nullptr) << "the shared data are absent";
            GTEST_SKIP() << "the shared data are absent";
        }
        const Recording original = read_recording(data / name);
        const std::string map =
            fmt::format(R"(format: fidservo-map/1
recording:
  {{ name: {}, rig: {}, tick_s: {}, experiment: {} }}
time: timestamp
columns:
  macro_setpoint: macro_setpoint
  macro_command: macro_command
  position: position
)",
                        original.name, original.rig, original.tick_s, original.experiment);
        EXPECT_LE(std::ranges::count(map, '\n'), 10);
        folder.write("map.yaml", map);
        const std::string out = original.name;
        const auto run = run_program(
            {"import", (data / name / "stage0/data.csv").string(), "--map", "map.yaml", "--out", out},
            folder.path());
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(text_of(folder / out / "stage0/data.csv"), text_of(data / name / "stage0/data.csv"))
            << name;
    }
}

}  // namespace
}  // namespace fidservo::imports

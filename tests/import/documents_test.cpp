// SPDX-License-Identifier: GPL-3.0-or-later
// The pages for users of other programs: their commands and maps, run on files as those programs write them.
#include "src/files/recording/reader.h"
#include "tests/import/made_files.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::run_program;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;
using ::testing::HasSubstr;

struct Page {
    std::vector<std::vector<std::string>> commands;  ///< words after "$ fidservo"
    std::string map;
};

/// What stands on a page four blanks in.
Page read_page(const std::string& name) {
    std::istringstream text(text_of(std::filesystem::path(FIDSERVO_SOURCE_DIR) / "docs" / name));
    constexpr std::string_view prompt = "    $ fidservo ", map_begins = "    format: fidservo-map/1";
    Page page;
    bool is_in_map = false;
    for (std::string line; std::getline(text, line);) {
        is_in_map = (is_in_map && line.starts_with("    ")) || line == map_begins;
        if (is_in_map) page.map += line.substr(4) + "\n";
        if (!line.starts_with(prompt)) continue;
        std::istringstream words(line.substr(prompt.size()));
        page.commands.emplace_back();
        for (std::string word; words >> word;) page.commands.back().push_back(word);
    }
    return page;
}

/// A carriage that was driven for 2.5 s: command in V, encoder in counts of 0.05 mm.
Recording make_run(const TemporaryFolder& folder) {
    folder.write("ramps.yaml",
                 "name: ramps\ncarriage_mm: 60\nmacro:\n  - { ramp_V: [0, 4.5], duration_s: 1.0 }\n"
                 "  - { constant_V: 0, duration_s: 0.5 }\n  - { ramp_V: [0, -4.5], duration_s: 1.0 }\n");
    EXPECT_EQ(run_program({"simulate", "ramps.yaml", "--effect", "coulomb_friction", "--out", "driven"},
                          folder.path())
                  .exit_code,
              0);
    return read_recording(folder / "driven");
}

struct Motion {
    std::vector<double> time_s, command_V, position_mm;
};

Motion motion_of(const Recording& run) {
    constexpr double resolution_mm = 0.05;
    Motion motion;
    for (const StageRow& row : run.rows) {
        motion.time_s.push_back(seconds(row.time_ns));
        motion.command_V.push_back(row.macro_command_V);
        motion.position_mm.push_back(resolution_mm * row.encoder_count);
    }
    return motion;
}

std::vector<double> in_m(std::vector<double> values_mm) {
    for (double& value : values_mm) value *= 1e-3;
    return values_mm;
}

/// Runs a page from its file to its report.
void follow(const TemporaryFolder& folder, const std::string& name) {
    const Page page = read_page(name);
    ASSERT_GE(page.commands.size(), 4u) << name;
    ASSERT_FALSE(page.map.empty()) << name;
    folder.write("map.yaml", page.map);
    for (const std::vector<std::string>& command : page.commands) {
        const auto run = run_program(command, folder.path());
        EXPECT_EQ(run.exit_code, 0) << name << ": " << fmt::format("{}", fmt::join(command, " ")) << "\n"
                                    << run.err;
    }
    EXPECT_THAT(text_of(folder / "gap.html"), HasSubstr("</html>")) << name;
    EXPECT_GE(read_recording(folder / "run-1").rows.size(), 2490u);
}

TEST(SlowPages, FromSimulink_LeadToADiagnosis) {
    const TemporaryFolder folder;
    const Motion motion = motion_of(make_run(folder));
    testing::make_simulink_mat(folder / "log.mat", testing::MatFormat::five, motion.time_s,
                               {{"u", motion.command_V}, {"x", in_m(motion.position_mm)}});
    follow(folder, "from-simulink.md");
}

TEST(SlowPages, FromLabView_LeadToADiagnosis) {
    const TemporaryFolder folder;
    const Recording run = make_run(folder);
    std::string text =
        "LabVIEW "
        "Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_"
        "Headings\tNo\n"
        "X_Columns\tOne\nTime_Pref\tRelative\n***End_of_Header***"
        "\t\n\t\nChannels\t2\t\t\nSamples\t2500\t2500\t\n"
        "Y_Unit_Label\tVolts\t\t\nX_Dimension\tTime\tTime\t\nX0\t0,0000000000000000E+0\t0,0000000000000000E+"
        "0\t\n"
        "Delta_X\t0,001000\t0,001000\t\n***End_of_Header***\t\t\t\nX_Value\tDrive\tEncoder\tComment\n";
    for (const StageRow& row : run.rows) {
        std::string line = fmt::format("{:.6f}\t{:.6f}\t{:.6f}\n", seconds(row.time_ns), row.macro_command_V,
                                       row.encoder_count);
        std::ranges::replace(line, '.', ',');
        text += line;
    }
    folder.write("log.lvm", text);
    follow(folder, "from-labview.md");
}

TEST(SlowPages, FromRos2_LeadToADiagnosis) {
    const TemporaryFolder folder;
    const Motion motion = motion_of(make_run(folder));
    testing::BagTopic joints{"/joint_states", "sensor_msgs/msg/JointState", {}},
        motor{"/motor/command", "std_msgs/msg/Float64", {}};
    for (std::size_t k = 0; k < motion.time_s.size(); ++k) {
        const std::int64_t stamp = 1'700'000'000'000'000'000 + nanoseconds(motion.time_s[k]);
        joints.messages.emplace_back(
            stamp + 300'000, testing::joint_state(stamp, {"carriage"}, {1e-3 * motion.position_mm[k]}));
        motor.messages.emplace_back(stamp + 150'000, testing::float64(motion.command_V[k]));
    }
    std::filesystem::create_directory(folder / "bag");
    testing::make_bag(folder / "bag/bag_0.db3", {joints, motor});
    follow(folder, "from-ros2.md");
}

TEST(SlowPages, FromPython_LeadToADiagnosis) {
    const TemporaryFolder folder;
    const Motion motion = motion_of(make_run(folder));
    testing::make_hdf5(folder / "log.h5", {{"/axis/t", motion.time_s, "s"},
                                           {"/axis/u", motion.command_V, "V"},
                                           {"/axis/x", motion.position_mm, "mm"}});
    follow(folder, "from-python.md");
}

}  // namespace
}  // namespace fidservo::imports

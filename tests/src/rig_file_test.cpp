// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/rig_file.h"

#include "core/rig.h"
#include "src/files/rig/fod_file.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

const std::filesystem::path assets = FIDSERVO_ASSETS_DIR;

/// The reference rig with one piece of its text replaced, loaded from a folder of its own: the message
/// without file and line, which must be the piece's.
std::string message_with(const std::string& piece, const std::string& replacement) {
    std::string text = text_of(assets / "rig.yaml");
    const auto place = text.find(piece);
    EXPECT_NE(place, std::string::npos) << piece;
    text.replace(place, piece.size(), replacement);
    const TemporaryFolder folder;
    std::filesystem::copy_file(assets / "preisach_fod.csv", folder / "preisach_fod.csv");
    const auto file = folder.write("rig.yaml", text);
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    const std::string where = file.string() + ":" + std::to_string(line) + ": ";
    const std::string message = message_of([&] { load_rig(file); });
    EXPECT_TRUE(message.starts_with(where)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr(std::min(message.size(), where.size()));
}

TEST(RigFile, ReferenceRig_IsReadWholly) {
    const Rig rig = load_rig(assets / "rig.yaml");
    EXPECT_EQ(rig.name, "reference-rig");
    EXPECT_DOUBLE_EQ(rig.macro.high_mm, 200.0);
    EXPECT_DOUBLE_EQ(rig.macro.dead_zone.offset_V, 0.364);
    ASSERT_TRUE(rig.macro.pd);
    EXPECT_DOUBLE_EQ(rig.macro.pd->e1_V_per_count, -0.0112178);
    ASSERT_TRUE(rig.micro && rig.micro->pi && rig.micro->fod);
    EXPECT_DOUBLE_EQ(rig.micro->heater.heating_tau_s, 0.55);
    EXPECT_EQ(rig.micro->hall.adc_bits, 12);
    EXPECT_NEAR(rig.micro->fod->stroke_mm(), 4.0, 0.1);
    ASSERT_TRUE(rig.camera);
    EXPECT_DOUBLE_EQ(mm_per_px(rig.camera->geometry), 0.004);
    ASSERT_TRUE(rig.fiducials);
    EXPECT_EQ(rig.fiducials->columns, 101);
}

TEST(RigFile, RigWithoutMicroAndCamera_LeavesThemEmpty) {
    const auto file = std::filesystem::path(FIDSERVO_DATA_DIR) / "emps" / "rig.yaml";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared data at " << file;
    const Rig rig = load_rig(file);
    EXPECT_FALSE(rig.micro || rig.camera || rig.fiducials || rig.macro.pd || rig.macro.pid);
    EXPECT_DOUBLE_EQ(rig.macro.encoder_resolution_mm, 0.00005);
}

TEST(RigFile, ReferenceRigFile_Exists) {
    EXPECT_EQ(load_rig(reference_rig_file()).name, "reference-rig");
}

TEST(RigFile, WrongKey_IsNamedWithTheRightOne) {
    EXPECT_EQ(message_with("focal_px: 5000", "focal_mm: 20"),
              "camera.focal_mm: 20: unknown key; did you mean focal_px, in px?");
}

TEST(RigFile, WrongType_IsNamed) {
    EXPECT_EQ(message_with("width_px: 1280", "width_px: wide"),
              "camera.width_px: wide: must be a whole number from 16 to 20000");
}

TEST(RigFile, WrongUnit_IsNamed) {
    EXPECT_EQ(message_with("distance_mm: 20", "distance_mm: 2 cm"),
              "camera.distance_mm: 2 cm: must be a number in mm above 0; the unit stands in the key alone");
}

TEST(RigFile, ValuesThatCannotBe_AreRefused) {
    EXPECT_NE(message_with("velocity_pole: 0.95833", "velocity_pole: 1.0").find("below 1"),
              std::string::npos);
    EXPECT_NE(message_with("travel_mm: [0, 200]", "travel_mm: [200, 0]").find("low below high"),
              std::string::npos);
    EXPECT_NE(message_with("limit_V: 1.9", "limit_V: 1.2").find("above onset_V"), std::string::npos);
    EXPECT_NE(message_with("exposure_s: 0.002", "exposure_s: 0.2").find("longer than a frame"),
              std::string::npos);
    EXPECT_NE(message_with("count: [101, 1]", "count: [101, 9]").find("587"), std::string::npos);
    EXPECT_NE(message_with("family: tag36h11", "family: tag25h7")
                  .find("family: tag25h7: must be one of tag36h11, "),
              std::string::npos);
    EXPECT_NE(message_with("family: tag36h11", "family: tag25h9").find("from 1 to 35"), std::string::npos);
    EXPECT_NE(message_with("family: tag36h11", "border_cells: 2, family: tagStandard41h12")
                  .find("border_cells: 2: must be 1: tagStandard41h12 has no plain border"),
              std::string::npos);
    EXPECT_NE(message_with("preisach_fod: preisach_fod.csv", "preisach_fod: other.csv").find("no such file"),
              std::string::npos);
}

TEST(RigFile, CovarianceOfTheCamera_IsALowerTriangle) {
    std::string zeros = "[1e-10";
    for (int i = 1; i < 28; ++i) zeros += i == 1 ? ", 2e-5" : i == 2 ? ", 1e-10" : ", 0";
    EXPECT_NE(message_with("blur_px: 0.8", "geometry_covariance: " + zeros + "]\n  blur_px: 0.8")
                  .find("must be the lower triangle of a covariance"),
              std::string::npos);
}

TEST(RigFile, NumeratorThatContradictsTheGain_IsRefused) {
    EXPECT_NE(message_with("0.16572\n", "0.17\n").find("contradicts"), std::string::npos);
}

TEST(FodFile, MistakesInTheTable_AreNamedWithTheirLine) {
    const TemporaryFolder folder;
    const std::string header = "peak_temp_degC,temp_degC,contraction_mm\n";
    const auto message = [&](const std::string& text) {
        const auto file = folder.write("fod.csv", text);
        return message_of([&] { load_fod(file); }).substr(file.string().size());
    };
    EXPECT_EQ(message("peak,temp,mm\n"), ":1: the header must be peak_temp_degC,temp_degC,contraction_mm");
    EXPECT_EQ(message(header + "10,10,0\n20,10,x\n"), ":3: column 3: 'x': must be a number");
    EXPECT_EQ(message(header + "10,10,nan\n"), ":2: column 3: 'nan': must be finite");
    EXPECT_EQ(message(header + "10,10,0\n20,10,1\n20,10,1\n20,20,2\n"), ":4: 20,10: is given twice");
    EXPECT_EQ(message(header + "10,10,0\n20,20,2\n"),
              ": peak_temp_degC 20, temp_degC 10: the row is missing");
    EXPECT_EQ(message(header + "10,20,0\n"), ":2: temp_degC: 20: must not be above peak_temp_degC, 10");
    EXPECT_EQ(message(header + "10,10,0\n20,10,1\n20,20,2"),
              ":4: the last line does not end: the file was cut off");
}

}  // namespace
}  // namespace fidservo

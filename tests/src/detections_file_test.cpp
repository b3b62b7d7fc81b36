// SPDX-License-Identifier: GPL-3.0-or-later
// What a file of detections says of how well corners are known.
#include "src/files/recording/reader.h"
#include "src/files/recording/writer.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

const std::string titles =
    "#timestamp [ns],tag_id,p0_x [px],p0_y [px],p1_x [px],p1_y [px],p2_x [px],p2_y [px],p3_x [px],p3_y [px]";
const std::string covariance_titles =
    ",p0_xx [px^2],p0_xy [px^2],p0_yy [px^2],p1_xx [px^2],p1_xy [px^2],p1_yy [px^2],p2_xx [px^2],p2_xy "
    "[px^2],p2_yy [px^2],p3_xx [px^2],p3_xy [px^2],p3_yy [px^2]";
const std::string corners = ",1,2,3,4,5,6,7,8";

/// The detections of a file.
std::vector<TagDetection> read(const std::string& text) {
    const TemporaryFolder folder;
    return read_detections(folder.write("detections.csv", text));
}

/// The reader's message without the file's path.
std::string message(const std::string& text) {
    const TemporaryFolder folder;
    const auto file = folder.write("detections.csv", text);
    return message_of([&] { (void)read_detections(file); }).substr(file.string().size());
}

Recording with_one_of_each_kind() {
    Recording recording;
    recording.name = recording.rig = recording.experiment = "a";
    recording.tick_s = 0.001;
    recording.columns.encoder = true;
    recording.rows.push_back({.time_ns = 0, .encoder_count = 1.0});
    for (const std::optional<bool> is_refined :
         {std::optional(true), std::optional(false), std::optional<bool>()}) {
        TagDetection detection;
        detection.tag_id = 7;
        detection.corners_px.fill({500.0, 400.25});
        detection.is_refined = is_refined;
        if (is_refined) {
            detection.covariances_px2.emplace();
            double variance_px2 = 2.5e-5;
            for (Eigen::Matrix2d& corner_px2 : *detection.covariances_px2) {
                corner_px2 << variance_px2, -1.25e-6, -1.25e-6, 3.125e-5;
                variance_px2 *= 2.0;
            }
        }
        recording.detections.push_back(detection);
    }
    return recording;
}

TEST(DetectionsFile, RefinementAndCovariances_AreReadBack) {
    const TemporaryFolder folder;
    const Recording written = with_one_of_each_kind();
    write_recording(folder / "a", written, std::nullopt);
    const Recording read = read_recording(folder / "a");
    ASSERT_EQ(read.detections.size(), written.detections.size());
    for (std::size_t k = 0; k < read.detections.size(); ++k) {
        EXPECT_EQ(read.detections[k].is_refined, written.detections[k].is_refined);
        EXPECT_EQ(read.detections[k].covariances_px2, written.detections[k].covariances_px2);
    }
    write_recording(folder / "b", read, std::nullopt);
    EXPECT_EQ(text_of(folder / "b/cam0/detections.csv"), text_of(folder / "a/cam0/detections.csv"));
}

TEST(DetectionsFile, NothingKnownOfItsCorners_HasNoColumnsForIt) {
    const TemporaryFolder folder;
    Recording recording = with_one_of_each_kind();
    recording.detections = {recording.detections.back()};
    write_recording(folder / "a", recording, std::nullopt);
    EXPECT_TRUE(text_of(folder / "a/cam0/detections.csv").starts_with(titles + "\n"));
    const TagDetection read = read_recording(folder / "a").detections.at(0);
    EXPECT_FALSE(read.is_refined || read.covariances_px2);
}

TEST(DetectionsFile, FlagAloneAndColumnsInAnyOrder_AreRead) {
    const auto flagged = read("refined," + titles.substr(1) + "\n1,0,3" + corners + "\n0,0,4" + corners +
                              "\n,0,5" + corners + "\n");
    ASSERT_EQ(flagged.size(), 3U);
    EXPECT_EQ(flagged[0].is_refined, true);
    EXPECT_EQ(flagged[1].is_refined, false);
    EXPECT_FALSE(flagged[2].is_refined);
    EXPECT_FALSE(flagged[0].covariances_px2);
    EXPECT_EQ(flagged[1].corners_px[3].y(), 8.0);
    const auto measured = read(titles + covariance_titles + "\n0,3" + corners + ",4,2,1,4,0,1,4,0,1,4,0,9\n");
    ASSERT_TRUE(measured.at(0).covariances_px2);
    EXPECT_EQ((*measured[0].covariances_px2)[0], (Eigen::Matrix2d() << 4, 2, 2, 1).finished());
    EXPECT_EQ((*measured[0].covariances_px2)[3](1, 1), 9.0);
}

TEST(DetectionsFile, Mistakes_AreNamedWithTheirLine) {
    EXPECT_EQ(message(titles + ",refined\n0,3" + corners + ",yes\n"), ":2: refined: yes: allowed: 0, 1");
    EXPECT_EQ(message(titles + ",p0_xx [px^2]\n0,3" + corners + ",1\n"),
              ":1: column 'p0_xy [px^2]' is missing: give the covariances of all corners, or none");
    EXPECT_EQ(
        message(titles + covariance_titles + "\n0,3" + corners + ",1,2,1,1,0,1,1,0,1,1,0,1\n"),
        ":2: covariance of corner 0: 1, 2, 1: is none; allowed: xx and yy not negative, xy^2 at most xx yy");
    EXPECT_NE(
        message(titles + covariance_titles + "\n0,3" + corners + ",1,0,1,1,0,1,1,,1,1,0,1\n").find(":2: "),
        std::string::npos);
    EXPECT_EQ(message(titles + ",p0_xx [mm^2]\n"),
              ":1: column 'p0_xx [mm^2]': unknown unit; it must be 'p0_xx [px^2]'");
}

}  // namespace
}  // namespace fidservo

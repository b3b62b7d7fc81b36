// SPDX-License-Identifier: GPL-3.0-or-later
// Which frames of a recording are measured, and what is said of those that cannot be.
#include "src/diagnose/frame_looks.h"

#include "src/files/recording/reader.h"
#include "src/simulation/filmed_recording.h"
#include "tests/reference_rig.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ChosenFrames, ManyFrames_AreThoseInMotionAndSomeOfTheRest) {
    Recording recording;
    for (int k = 0; k < 400; ++k) {
        recording.frames.push_back({20'000'000LL * k, std::to_string(k)});
        if (k % 10 == 9) continue;  // no tag
        TagDetection tag;
        tag.time_ns = recording.frames.back().time_ns;
        tag.tag_id = 1;
        const double u_px = k < 300 ? 100.0 : 100.0 + 5.0 * (k - 300);
        for (std::size_t c = 0; c < 4; ++c)
            tag.corners_px[c] = Eigen::Vector2d(u_px, 100.0) + 50.0 * tag_corners[c];
        recording.detections.push_back(tag);
    }
    const std::vector<FrameName> chosen = chosen_frames(recording, 100);
    EXPECT_EQ(chosen.size(), 100);
    EXPECT_TRUE(std::ranges::is_sorted(chosen, {}, &FrameName::time_ns));
    const auto in_motion = std::ranges::count_if(
        chosen, [](const FrameName& frame) { return frame.time_ns >= 300 * 20'000'000LL; });
    EXPECT_GE(in_motion, 55);
    EXPECT_LE(in_motion, 70);
    EXPECT_EQ(chosen_frames(recording, 1000).size(), 360);
}

/// 0.3 s of the rig at rest, with frames.
std::filesystem::path filmed(const testing::TemporaryFolder& here) {
    const Rig& rig = reference_rig();
    Experiment experiment = make_experiment("rest", rig, 1, "rest-1");
    experiment.duration_s = 0.3;
    write_filmed_recording(here / "rest-1", rig, {}, experiment, "rest-1", 1);
    return here / "rest-1";
}

std::vector<std::string> notes_of(const std::filesystem::path& folder, Recording& recording) {
    recording = read_recording(folder);
    return measure_frames({&recording, 1}, {&folder, 1});
}

TEST(MeasureFrames, Recording_HasTheLooksOfItsDetections) {
    const testing::TemporaryFolder here;
    Recording recording;
    EXPECT_THAT(notes_of(filmed(here), recording), IsEmpty());
    ASSERT_EQ(recording.appearances.size(), recording.detections.size());
    ASSERT_FALSE(recording.appearances.empty());
    for (std::size_t k = 0; k < recording.detections.size(); ++k) {
        EXPECT_EQ(recording.appearances[k].time_ns, recording.detections[k].time_ns);
        EXPECT_EQ(recording.appearances[k].tag_id, recording.detections[k].tag_id);
    }
}

TEST(MeasureFrames, WhatIsMissing_IsSaid) {
    const testing::TemporaryFolder here;
    const std::filesystem::path folder = filmed(here);
    const std::filesystem::path frames = folder / "cam0" / "data";
    std::filesystem::remove(std::filesystem::directory_iterator(frames)->path());
    Recording recording;
    EXPECT_THAT(notes_of(folder, recording), ElementsAre(HasSubstr("1 of the frames")));
    EXPECT_FALSE(recording.appearances.empty());
    std::filesystem::remove(folder / "cam0" / "detections.csv");
    EXPECT_THAT(notes_of(folder, recording), ElementsAre(HasSubstr("fidservo replay")));
    EXPECT_TRUE(recording.appearances.empty());
}

TEST(MeasureFrames, FileThatIsNoImage_IsSaidAndTheOthersMeasured) {
    const testing::TemporaryFolder here;
    const std::filesystem::path folder = filmed(here);
    std::ofstream(std::filesystem::directory_iterator(folder / "cam0" / "data")->path()) << "no image";
    Recording recording;
    EXPECT_THAT(notes_of(folder, recording), ElementsAre(HasSubstr("cannot be read")));
    EXPECT_FALSE(recording.appearances.empty());
}

}  // namespace
}  // namespace fidservo::diagnose

// Videos, by the module that is loaded when one is opened.
#include "vision/images/media.h"

#include "core/failure.h"
#include "core/result.h"
#include "tests/src/temporary_folder.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

namespace fidservo::vision {
namespace {

using ::testing::HasSubstr;

TEST(Media, Video_EveryFrameComesWithItsPlace) {
    const fidservo::testing::TemporaryFolder folder;
    constexpr int frames = 5;
    {
        cv::VideoWriter writer((folder / "film.avi").string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                               25.0, {64, 48}, false);
        ASSERT_TRUE(writer.isOpened());
        for (int k = 0; k < frames; ++k) writer.write(cv::Mat(48, 64, CV_8UC1, cv::Scalar::all(40 * k)));
    }
    const auto video = open_video(folder / "film.avi");
    ASSERT_TRUE(video) << video.error().text;
    EXPECT_EQ((*video)->rate_hz(), 25.0);
    EXPECT_EQ((*video)->stated_frames(), frames);
    std::vector<Video::Picture> kept;
    while (auto picture = (*video)->next()) kept.push_back(*picture);
    ASSERT_EQ(kept.size(), frames);
    for (int k = 0; k < frames; ++k) {
        const cv::Mat& grey = kept[static_cast<std::size_t>(k)].grey;
        EXPECT_EQ(grey.type(), CV_8UC1);
        EXPECT_NEAR(grey.at<unsigned char>(20, 20), 40 * k, 4) << "the next frame must not overwrite it";
    }
}

TEST(Media, NoVideo_IsRefusedByName) {
    const fidservo::testing::TemporaryFolder folder;
    std::ofstream(folder / "film.mp4") << "this is no film";
    const auto video = open_video(folder / "film.mp4");
    ASSERT_FALSE(video);
    EXPECT_EQ(video.error().reason, Reason::device);
    EXPECT_THAT(video.error().text, HasSubstr("film.mp4: cannot be read as a video"));
}

}  // namespace
}  // namespace fidservo::vision

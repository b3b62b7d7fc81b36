#include "vision/image_sequence.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace fidservo::vision {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class ImageSequenceTest : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            fs::temp_directory_path() /
            (std::string("fidservo_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write_image(const fs::path& name, int grey, int type = CV_8UC1) const {
        fs::create_directories((folder_ / name).parent_path());
        ASSERT_TRUE(cv::imwrite((folder_ / name).string(), cv::Mat(24, 32, type, cv::Scalar::all(grey))));
    }
    void write_text(const fs::path& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    static std::string message_of(const fs::path& input) {
        try {
            const ImageSequence sequence(input);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }

    fs::path folder_;
};

/// Grey level of the next frame; -1 at the end.
int next_grey(ImageSequence& sequence) {
    const auto frame = sequence.next();
    if (!frame) throw std::runtime_error(frame.error().text);
    return *frame ? (*frame)->image.at<unsigned char>(5, 5) : -1;
}

TEST_F(ImageSequenceTest, PlainFolder_ComesInNaturalOrderAtTheGivenRate) {
    write_image("frame10.png", 100);
    write_image("frame9.png", 90);
    write_image("frame2.png", 20);
    write_text("notes.txt", "not an image");
    ImageSequence sequence(folder_, 50.0);
    EXPECT_EQ(sequence.size(), 3U);
    EXPECT_EQ(next_grey(sequence), 20);
    const auto second = sequence.next();
    ASSERT_TRUE(second && *second);
    EXPECT_EQ((*second)->time_ns, 20 * ns_per_ms);
    EXPECT_EQ((*second)->sequence, 1U);
    EXPECT_EQ((*second)->source, "frame9.png");
    EXPECT_EQ(next_grey(sequence), 100);
    EXPECT_EQ(next_grey(sequence), -1);
    EXPECT_EQ(next_grey(sequence), -1);
}

TEST_F(ImageSequenceTest, RecordingFolder_HasItsTimesAndItsOrder) {
    write_image("cam0/data/b.png", 1);
    write_image("cam0/data/a.png", 2);
    write_text("cam0/data.csv", "#timestamp [ns],filename\r\n3300000,b.png\r\n23300000, a.png\r\n\n");
    for (const fs::path& input : {folder_, folder_ / "cam0"}) {
        ImageSequence sequence(input);
        const auto first = sequence.poll(0);
        ASSERT_TRUE(first && *first);
        EXPECT_EQ((*first)->time_ns, 3300000);
        EXPECT_EQ((*first)->image.at<unsigned char>(0, 0), 1);
        EXPECT_EQ(next_grey(sequence), 2);
        EXPECT_EQ(next_grey(sequence), -1);
    }
}

TEST_F(ImageSequenceTest, ColourAndSixteenBit_BecomeGrey) {
    write_image("1.png", 77, CV_8UC3);
    write_image("2.png", 77 * 257, CV_16UC1);
    ImageSequence sequence(folder_);
    for (int k = 0; k < 2; ++k) {
        const auto frame = sequence.next();
        ASSERT_TRUE(frame && *frame);
        EXPECT_EQ((*frame)->image.type(), CV_8UC1);
        EXPECT_NEAR((*frame)->image.at<unsigned char>(0, 0), 77, 1);
    }
}

TEST_F(ImageSequenceTest, SingleImage_IsASequenceOfOne) {
    write_image("only.pgm", 5);
    ImageSequence sequence(folder_ / "only.pgm");
    EXPECT_EQ(next_grey(sequence), 5);
    EXPECT_EQ(next_grey(sequence), -1);
}

TEST_F(ImageSequenceTest, UnreadableImage_IsNamedAndPassedOver) {
    write_image("1.png", 1);
    write_text("2.png", "this is no picture");
    write_image("3.png", 3);
    ImageSequence sequence(folder_);
    EXPECT_EQ(next_grey(sequence), 1);
    const auto broken = sequence.next();
    ASSERT_FALSE(broken);
    EXPECT_EQ(broken.error().reason, Reason::device);
    EXPECT_THAT(broken.error().text, AllOf(HasSubstr("2.png"), HasSubstr("cannot be read")));
    EXPECT_EQ(next_grey(sequence), 3);
}

TEST_F(ImageSequenceTest, EmptyFolderAndMissingFile_AreInputErrors) {
    EXPECT_THAT(message_of(folder_), AllOf(HasSubstr(folder_.string()), HasSubstr("holds no image")));
    EXPECT_THAT(message_of(folder_ / "none.png"), AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
}

TEST_F(ImageSequenceTest, BrokenIndex_IsNamedWithItsLine) {
    write_text("data.csv", "#timestamp [ns],filename\n12,a.png\nsoon,b.png\n");
    EXPECT_THAT(message_of(folder_), AllOf(HasSubstr("data.csv:3"), HasSubstr("soon")));
    write_text("data.csv", "#timestamp [ns],filename\n");
    EXPECT_THAT(message_of(folder_), HasSubstr("names no image"));
    write_text("data.csv", "12\n");
    EXPECT_THAT(message_of(folder_), HasSubstr("data.csv:1"));
}

TEST_F(ImageSequenceTest, Video_ComesFrameByFrameWithItsRate) {
    const std::string file = (folder_ / "film.avi").string();
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0, {64, 48}, false);
    ASSERT_TRUE(writer.isOpened());
    for (int k = 0; k < 5; ++k) writer.write(cv::Mat(48, 64, CV_8UC1, cv::Scalar::all(40 * k)));
    writer.release();
    ImageSequence sequence(file);
    for (int k = 0; k < 5; ++k) {
        const auto frame = sequence.next();
        ASSERT_TRUE(frame && *frame) << k;
        EXPECT_EQ((*frame)->image.type(), CV_8UC1);
        EXPECT_NEAR((*frame)->image.at<unsigned char>(20, 20), 40 * k, 4);
        EXPECT_EQ((*frame)->time_ns, k * 40 * ns_per_ms);
        EXPECT_EQ((*frame)->source, "film.avi#" + std::to_string(k));
    }
    EXPECT_FALSE(sequence.next()->has_value());
}

TEST_F(ImageSequenceTest, BrokenVideo_IsAnInputError) {
    write_text("film.mp4", "this is no film");
    EXPECT_THAT(message_of(folder_ / "film.mp4"), AllOf(HasSubstr("film.mp4"), HasSubstr("cannot be read")));
}

TEST(NaturalOrder, Digits_CompareAsNumbers) {
    EXPECT_TRUE(natural_less("a2", "a10"));
    EXPECT_FALSE(natural_less("a10", "a2"));
    EXPECT_TRUE(natural_less("a", "a1"));
    EXPECT_FALSE(natural_less("a1", "a1"));
    EXPECT_TRUE(natural_less("1403636579763555584.png", "1403636579813555456.png"));
    EXPECT_TRUE(natural_less("a007b1", "a7b2"));
    EXPECT_NE(natural_less("a07", "a7"), natural_less("a7", "a07"));
}

}  // namespace
}  // namespace fidservo::vision

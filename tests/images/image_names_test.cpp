// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_names.h"

#include "src/images/image_frames.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::TemporaryFolder;

TEST(NaturalOrder, Digits_CompareAsNumbers) {
    EXPECT_TRUE(natural_less("a2", "a10"));
    EXPECT_FALSE(natural_less("a10", "a2"));
    EXPECT_TRUE(natural_less("a", "a1"));
    EXPECT_FALSE(natural_less("a1", "a1"));
    EXPECT_TRUE(natural_less("1403636579763555584.png", "1403636579813555456.png"));
    EXPECT_TRUE(natural_less("a007b1", "a7b2"));
    EXPECT_NE(natural_less("a07", "a7"), natural_less("a7", "a07"));
}

TEST(TimeInName, NumbersOfEachUnit_AreNanoseconds) {
    EXPECT_EQ(time_in_name("1403636579763555584", NameTimes::ns), 1403636579763555584);
    EXPECT_EQ(time_in_name("1305031102.175304", NameTimes::s), 1305031102175304000);
    EXPECT_EQ(time_in_name("12", NameTimes::ms), 12'000'000);
    EXPECT_EQ(time_in_name("0012.5", NameTimes::us), 12'500);
    for (const char* no_time : {"", "a1", "1.", ".5", "1.2.3", "-4", "99999999999999999999", "1e3"})
        EXPECT_FALSE(time_in_name(no_time, NameTimes::s)) << no_time;
    EXPECT_FALSE(time_in_name("9300000000000000000", NameTimes::ns)) << "beyond what is counted";
}

TEST(NamesUnit, ConventionsOfDataSets_AreKnownAndNoOthers) {
    EXPECT_EQ(names_unit({"1403636579763555584", "1403636579813555456"}), NameTimes::ns);
    EXPECT_EQ(names_unit({"1305031102.175304", "1305031102.2"}), NameTimes::s);
    EXPECT_EQ(names_unit({"1403636579763555584", "calib"}), NameTimes::none);
    EXPECT_EQ(names_unit({"0000000000000000001"}), NameTimes::none) << "a number with zeros before it";
    EXPECT_EQ(names_unit({"000001", "000002"}), NameTimes::none);
    EXPECT_TRUE(could_be_times({"1403636579763", "1403636579813"}));
    EXPECT_TRUE(could_be_times({"1403636579763555"}));
    EXPECT_FALSE(could_be_times({"000001", "000002"}));
}

/// Names of one numbering, as programs write them.
Outcome judged_order(std::mt19937_64& random) {
    const TemporaryFolder folder;
    constexpr const char* prefixes[] = {"", "frame", "img_", "IMG-2024-", "cam0 ", "a7b", "x."};
    constexpr const char* suffixes[] = {"", "_left", " (1)", ".0"};
    const std::string prefix = prefixes[random() % std::size(prefixes)];
    const std::string suffix = suffixes[random() % std::size(suffixes)];
    const int digits = 1 + static_cast<int>(random() % 5);
    const unsigned most = random() % 2 == 0 ? 30 : 20000;
    std::set<unsigned> numbers;
    while (numbers.size() < 12) numbers.insert(static_cast<unsigned>(random() % most));
    std::vector<unsigned> written(numbers.begin(), numbers.end());
    std::shuffle(written.begin(), written.end(), random);
    const std::vector<unsigned char> png = vision::encode_png(cv::Mat(2, 2, CV_8UC1, cv::Scalar(1)), 1);
    for (const unsigned number : written)
        folder.write(fmt::format("{}{:0{}}{}.png", prefix, number, digits, suffix), {png.begin(), png.end()});
    ImageFrames frames({folder.path()});
    for (const unsigned number : numbers) {
        const auto frame = frames.next();
        const std::string expected = fmt::format("{}{:0{}}{}.png", prefix, number, digits, suffix);
        if (!frame || frame->file.filename() != expected)
            return Outcome::wrong(
                fmt::format("{} where {} should be", frame ? frame->name : "nothing", expected));
    }
    return Outcome::right();
}

TEST(NameVariations, NumbersInNames_GiveTheOrder) {
    expect_right_or_refused("order of names in a folder", 200, judged_order);
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of images and times as other programs write them.
#include "src/files/recording/frame_index.h"

#include "core/input_error.h"
#include "src/files/recording/reader.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;

constexpr TimeNs first_ns = 1403636579763555584, step_ns = 50'000'000;

/// A camera's folder with three images in data/.
class FrameIndex : public ::testing::Test {
  protected:
    FrameIndex() {
        for (int k = 0; k < 3; ++k) folder_.write("cam0/data/" + name(k), "an image");
    }
    static std::string name(int k) { return fmt::format("{}.png", first_ns + k * step_ns); }

    std::vector<FrameName> read(const std::string& text) const {
        return read_frame_names(folder_.write("cam0/data.csv", text));
    }
    std::string refusal(const std::string& text) const {
        return message_of([&] { read(text); });
    }
    /// Rows of all three images.
    static std::string rows(const std::string& separator = ",", const std::string& end = "\n") {
        std::string text;
        for (int k = 0; k < 3; ++k)
            text += fmt::format("{}{}{}{}", first_ns + k * step_ns, separator, name(k), end);
        return text;
    }
    void expect_all(const std::vector<FrameName>& frames) const {
        ASSERT_EQ(frames.size(), 3U);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(frames[static_cast<std::size_t>(k)].time_ns, first_ns + k * step_ns);
            EXPECT_EQ(frames[static_cast<std::size_t>(k)].filename, name(k));
        }
    }

    TemporaryFolder folder_;
};

TEST_F(FrameIndex, EuRoCsFileAfterEditorsAndSpreadsheets_IsReadTheSame) {
    const std::string title = "#timestamp [ns],filename\n";
    for (const std::string& text :
         {title + rows(), "\xEF\xBB\xBF" + title + rows(), rows(),
          "#timestamp [ns],filename\r\n" + rows(",", "\r\n"), title + rows().substr(0, rows().size() - 1),
          "timestamp,filename\n" + rows(), "\n# images\n\n" + title + rows(),
          "timestamp [ns];filename\n" + rows(";"), "# timestamp filename\n" + rows(" "), rows("\t"),
          rows(" , "), rows(",\"", "\"\n"), rows(",", ",\n"), "time_ns,image\n" + rows()}) {
        SCOPED_TRACE(text);
        expect_all(read(text));
    }
}

TEST_F(FrameIndex, PathsInNames_AreFound) {
    expect_all(read(rows(",data/")));
    expect_all(read(rows(",cam0/data/")));  // by the last part
    expect_all(read(rows(",/elsewhere/mav0/cam0/data/")));
    expect_all(read(rows(",C:\\recordings\\cam0\\data\\")));
    EXPECT_EQ(read(fmt::format("{},/elsewhere/x.png\n", first_ns))[0].filename, "/elsewhere/x.png");
}

TEST_F(FrameIndex, TumsList_IsInSecondsExactly) {
    folder_.write("rgb/1305031102.175304.png", "");
    folder_.write("rgb/1305031102.211214.png", "");
    const auto frames =
        read_frame_names(folder_.write("rgb.txt",
                                       "# color images\n# file: 'rgbd_dataset.bag'\n# timestamp "
                                       "filename\n1305031102.175304 rgb/1305031102.175304.png\n"
                                       "1305031102.211214 rgb/1305031102.211214.png\n"));
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].time_ns, 1305031102175304000);
    EXPECT_EQ(frames[1].time_ns, 1305031102211214000);
    EXPECT_EQ(std::filesystem::path(frames[0].filename), folder_ / "rgb/1305031102.175304.png");
}

TEST_F(FrameIndex, UnitInTheTitle_IsTaken) {
    const auto time_of = [&](const std::string& title, const std::string& time) {
        return read(fmt::format("{},filename\n{},x.png\n", title, time))[0].time_ns;
    };
    EXPECT_EQ(time_of("timestamp [us]", "1403636579763555"), 1403636579763555000);
    EXPECT_EQ(time_of("timestamp (ms)", "20.5"), 20'500'000);
    EXPECT_EQ(time_of("t [s]", "0.0333333333333"), 33'333'333);
    EXPECT_EQ(time_of("#timestamp [ns]", "20"), 20);
    EXPECT_EQ(time_of("timestamp [\xC2\xB5s]", "7"), 7000);
}

TEST_F(FrameIndex, TimesWithoutAKnownUnit_AreAskedFor) {
    for (const char* time :
         {"1403636579763555", "1403636579763", "1403636579", "0", "20", "0.033", "140363657.9"})
        EXPECT_THAT(
            refusal(fmt::format("{},x.png\n", time)),
            HasSubstr("data.csv:1: column 1: '" + std::string(time) + "': the time's unit is not known"));
    EXPECT_THAT(refusal("timestamp [ns],filename\n1.40363657976e+18,x.png\n"),
                HasSubstr("must be written in digits"));
    EXPECT_THAT(refusal("timestamp [s],filename\n1403636579763555584,x.png\n"),
                HasSubstr("no time in ns of 64 bits"));
    EXPECT_THAT(refusal("timestamp [ns],filename\n1403636579.763556,x.png\n"),
                HasSubstr("a time in ns is a whole number"));
}

TEST_F(FrameIndex, NumbersOfFrames_AreNoTimes) {
    EXPECT_THAT(refusal("#timestamp [ns],filename\n0,a.png\n1,b.png\n2,c.png\n"),
                HasSubstr("data.csv:2: times rise by 1 ns from image to image, as numbers of frames do"));
}

TEST_F(FrameIndex, RowsThatContradict_AreNamed) {
    EXPECT_THAT(
        refusal(fmt::format("{0},a.png\n{0},b.png\n", first_ns)),
        HasSubstr("data.csv:2: timestamp: 1403636579763555584 ns: must be after that of the row before"));
    EXPECT_THAT(refusal(fmt::format("{},a.png\n{},a.png\n", first_ns, first_ns + 1)),
                HasSubstr("is named in line 1 already"));
    EXPECT_THAT(
        refusal(fmt::format("{},a.png\n{},b.png\n{},14036", first_ns, first_ns + 1, first_ns + 2)),
        HasSubstr("data.csv:3: column 2: '14036': the last line does not end, and there is no such file"));
    EXPECT_THAT(refusal(fmt::format("{},a.png\n{}", first_ns, first_ns + 1)),
                HasSubstr("data.csv:2: has 1 fields"));
    EXPECT_THAT(refusal(fmt::format("{0},{0}\n", first_ns)), HasSubstr("which column holds the"));
    EXPECT_THAT(refusal("a.png,b.png\n"), HasSubstr("there is no row"));
}

TEST_F(FrameIndex, RecordingsOwn_StayStrictButForMarkAndLineEnds) {
    folder_.write("recording.yaml", "");
    const std::string title = "#timestamp [ns],filename\n";
    expect_all(read("\xEF\xBB\xBF" + title + rows()));
    expect_all(read("#timestamp [ns],filename\r\n" + rows(",", "\r\n")));
    EXPECT_THAT(refusal(title + rows().substr(0, rows().size() - 1)),
                HasSubstr("the last line does not end"));
    EXPECT_THAT(refusal(rows()), HasSubstr("unknown"));
}

// --- Random indices

struct DrawnIndex {
    std::string text;
    std::vector<TimeNs> times_ns;
    bool must_be_refused = false;
};

constexpr int most_rows = 12;

DrawnIndex draw_index(std::mt19937_64& random) {
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
    const auto chance = [&](double share) { return std::bernoulli_distribution(share)(random); };
    DrawnIndex drawn;
    const int rows = pick(2, most_rows);
    struct UnitOfTime {
        const char* title;
        TimeNs size_ns;
        int decimals;
    };
    constexpr std::array units{UnitOfTime{"timestamp [ns]", 1, 0},
                               UnitOfTime{"timestamp [us]", 1000, 3},
                               UnitOfTime{"timestamp (ms)", 1'000'000, 6},
                               UnitOfTime{"time [s]", 1'000'000'000, 9},
                               UnitOfTime{"timestamp", 1, 0},
                               UnitOfTime{"timestamp", 1000, 3}};
    const UnitOfTime& unit = units[static_cast<std::size_t>(pick(0, units.size() - 1))];
    const bool since_1970 = chance(0.6), has_title = chance(0.8);
    const TimeNs begin_ns = since_1970 ? first_ns + pick(0, 1'000'000) : pick(0, 1'000'000);
    const std::array<std::string, 5> separators{",", ";", "\t", " ", ", "};
    const std::string& separator = separators[static_cast<std::size_t>(pick(0, 4))];
    const std::array<std::string, 4> prefixes{"", "data/", "cam0/data/", "/elsewhere/cam0/data/"};
    const std::string prefix = prefixes[static_cast<std::size_t>(pick(0, 3))];
    const std::string end = chance(0.3) ? "\r\n" : chance(0.2) ? "\r" : "\n";
    const bool quotes = chance(0.2), swapped = chance(0.2), decimals = unit.decimals > 0 && chance(0.5);
    std::vector<std::string> lines;
    if (chance(0.2)) lines.emplace_back("# images of a camera");
    if (has_title)
        lines.push_back((chance(0.5) ? "#" : "") +
                        (separator == " "
                             ? std::string(unit.title).substr(0, std::string(unit.title).find(' '))
                             : unit.title) +
                        separator + "filename");
    if (has_title && swapped)
        lines.back() = "filename" + separator + (separator == " " ? "timestamp" : unit.title);
    const int damaged = chance(0.3) ? pick(0, rows - 1) : -1;
    const int damage = damaged == 0 ? 3 : pick(0, 3);
    drawn.must_be_refused = damaged >= 0;
    for (int k = 0; k < rows; ++k) {
        TimeNs time_ns = begin_ns + k * step_ns + pick(0, 1000);
        if (!decimals) time_ns -= time_ns % unit.size_ns;
        drawn.times_ns.push_back(time_ns);
        if (k == damaged && damage == 0) time_ns = drawn.times_ns[static_cast<std::size_t>(k - 1)];
        std::string time = fmt::format("{}", time_ns / unit.size_ns);
        if (decimals) time += fmt::format(".{:0{}}", time_ns % unit.size_ns, unit.decimals);
        std::string name = prefix + fmt::format("{:03}.png", k);
        if (k == damaged && damage == 1) name = prefix + fmt::format("{:03}.png", k - 1);
        if (quotes) name = '"' + name + '"';
        std::string line = swapped ? name + separator + time : time + separator + name;
        if (k == damaged && damage == 2) line = time;
        if (k == damaged && damage == 3) line = "lost" + separator + name;
        lines.push_back(line);
        if (chance(0.05)) lines.emplace_back("");
    }
    drawn.text = (chance(0.2) ? "\xEF\xBB\xBF" : "") + fmt::format("{}", fmt::join(lines, end)) +
                 (chance(0.8) ? end : "");
    return drawn;
}

TEST(FrameIndexVariations, OtherPeoplesLists_AreReadRightOrRefused) {
    const TemporaryFolder folder;
    for (int k = 0; k < most_rows; ++k) folder.write(fmt::format("cam0/data/{:03}.png", k), "");
    expect_right_or_refused("lists of images and times", 200, [&](std::mt19937_64& random) {
        const DrawnIndex drawn = draw_index(random);
        try {
            const auto frames = read_frame_names(folder.write("cam0/data.csv", drawn.text));
            if (drawn.must_be_refused) return Outcome::wrong("damage was passed over:\n" + drawn.text);
            if (frames.size() != drawn.times_ns.size())
                return Outcome::wrong("rows are missing:\n" + drawn.text);
            for (std::size_t k = 0; k < frames.size(); ++k)
                if (frames[k].time_ns != drawn.times_ns[k] ||
                    frames[k].filename != fmt::format("{:03}.png", k))
                    return Outcome::wrong(fmt::format("row {}: {}, {}:\n{}", k, frames[k].time_ns,
                                                      frames[k].filename, drawn.text));
            return Outcome::right();
        } catch (const InputError& error) {
            return Outcome::refused(error.what());
        }
    });
}

}  // namespace
}  // namespace fidservo

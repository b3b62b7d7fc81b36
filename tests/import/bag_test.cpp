// SPDX-License-Identifier: GPL-3.0-or-later
// Bags of ROS 2 as recorders leave them: several publishers, simulation time, split, compressed, damaged.
#include "src/import/bag_files.h"
#include "src/import/read_log.h"
#include "tests/import/made_files.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <filesystem>
#include <iterator>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zstd.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::message_of;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::int64_t ms = 1'000'000, wall_ns = 1'700'000'000'000'000'000;

testing::BagTopic states_of(const std::vector<std::int64_t>& stamps) {
    testing::BagTopic topic{"/js", "sensor_msgs/msg/JointState", {}};
    for (std::size_t k = 0; k < stamps.size(); ++k)
        topic.messages.emplace_back(wall_ns + static_cast<std::int64_t>(k) * ms,
                                    testing::joint_state(stamps[k], {"a"}, {static_cast<double>(k)}));
    return topic;
}

/// A bag's file with a number at 1 ms each, from `first` on.
void make_numbers(const std::filesystem::path& file, int first, int count) {
    testing::BagTopic topic{"/u", "std_msgs/msg/Float64", {}};
    for (int k = first; k < first + count; ++k)
        topic.messages.emplace_back(wall_ns + k * ms, testing::float64(k));
    testing::make_bag(file, {topic});
}

std::string zstd_of(const std::string& bytes) {
    std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
    compressed.resize(ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), 1));
    return compressed;
}

TEST(BagLog, JointsOfTwoPublishers_HaveTheSamplesAndTimesOfTheirOwnMessages) {
    const TemporaryFolder folder;
    testing::BagTopic topic{"/js", "sensor_msgs/msg/JointState", {}};
    for (int k = 0; k < 4; ++k) {
        topic.messages.emplace_back(k * 10 + 3, testing::joint_state(k * 10 + 1, {"a"}, {1.0 * k}));
        topic.messages.emplace_back(k * 10 + 9, testing::joint_state(k * 10 + 5, {"b", "c"}, {5.0, 6.0}));
    }
    testing::make_bag(folder / "b.db3", {topic});
    const Log log = read_log(folder / "b.db3", testing::no_table_options);
    const LoggedSignal *a = log.find("/js/position[a]"), *b = log.find("/js/position[b]");
    ASSERT_NE(a, nullptr);
    ASSERT_NE(b, nullptr);
    EXPECT_THAT(a->values, ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(b->values, ElementsAre(5, 5, 5, 5));
    ASSERT_NE(log.find(a->times), nullptr);
    ASSERT_NE(log.find(b->times), nullptr);
    EXPECT_THAT(log.find(a->times)->whole, ElementsAre(1, 11, 21, 31));
    EXPECT_THAT(log.find(b->times)->whole, ElementsAre(5, 15, 25, 35));
    EXPECT_EQ(log.find("/js/position[c]")->times, b->times);
}

TEST(BagLog, StampsThatBeginAtZero_AreTimesOfASimulation) {
    const TemporaryFolder folder;
    testing::make_bag(folder / "b.db3", {states_of({0, ms, 2 * ms, 3 * ms})});
    const Log log = read_log(folder / "b.db3", testing::no_table_options);
    ASSERT_NE(log.find("/js/stamp"), nullptr);
    EXPECT_THAT(log.find("/js/stamp")->whole, ElementsAre(0, ms, 2 * ms, 3 * ms));
    EXPECT_EQ(log.find("/js/position[a]")->times, "/js/stamp");
    ASSERT_NE(log.find("/js/received"), nullptr) << "a clock for topics without stamps";
    EXPECT_EQ(log.find("/js/received")->whole.back(), wall_ns + 3 * ms);
    EXPECT_THAT(log.notes, IsEmpty());
}

TEST(BagLog, MessagesBeforeTheSimulationsClock_AreLeftOutButTheLast) {
    const TemporaryFolder folder;
    testing::make_bag(folder / "b.db3", {states_of({0, 0, 0, ms, 2 * ms})});
    const Log log = read_log(folder / "b.db3", testing::no_table_options);
    EXPECT_THAT(log.find("/js/position[a]")->values, ElementsAre(2, 3, 4));
    EXPECT_THAT(log.notes, ElementsAre("/js: 2 of 5 messages have no stamp: they are left out"));
}

TEST(BagLog, MessageWithoutStampAmongOthers_IsLeftOutAndCounted) {
    const TemporaryFolder folder;
    testing::make_bag(folder / "b.db3", {states_of({0, wall_ns, wall_ns + ms, 0, wall_ns + 3 * ms})});
    const Log log = read_log(folder / "b.db3", testing::no_table_options);
    EXPECT_THAT(log.find("/js/stamp")->whole, ElementsAre(wall_ns, wall_ns + ms, wall_ns + 3 * ms));
    EXPECT_THAT(log.notes, ElementsAre("/js: 2 of 5 messages have no stamp: they are left out"));
    testing::make_bag(folder / "none.db3", {states_of({0, 0})});
    EXPECT_THAT(read_log(folder / "none.db3", testing::no_table_options).notes,
                ElementsAre(HasSubstr("/js: its messages have no stamps: times are those at which")));
}

TEST(SplitBag, Folder_IsOneLogInTheOrderOfItsMetadata) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "bag");
    make_numbers(folder / "bag/first.db3", 0, 2);
    make_numbers(folder / "bag/again.db3", 2, 2);
    make_numbers(folder / "bag/stray.db3", 9, 1);
    folder.write("bag/metadata.yaml",
                 "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                 "  relative_file_paths: [bag/first.db3, again.db3]\n");
    const Log log = read_log(folder / "bag/", testing::no_table_options);
    EXPECT_THAT(log.find("/u")->values, ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(log.notes, Contains("2 files of one bag are one log: first.db3, again.db3"));
    EXPECT_THAT(log.notes, Contains(HasSubstr("stray.db3: passed over")));
    std::filesystem::remove(folder / "bag/again.db3");
    EXPECT_THAT(message_of([&] { read_log(folder / "bag", testing::no_table_options); }),
                HasSubstr("again.db3: this file of the bag is not there"));
}

TEST(SplitBag, WithoutMetadata_IsInTheOrderOfItsNumbers) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "bag");
    for (int k = 9; k <= 10; ++k) make_numbers(folder / fmt::format("bag/run_{}.db3", k), 2 * k, 2);
    EXPECT_THAT(bag_of_folder(folder / "bag").files,
                ElementsAre(folder / "bag/run_9.db3", folder / "bag/run_10.db3"));
    EXPECT_THAT(read_log(folder / "bag", testing::no_table_options).find("/u")->values,
                ElementsAre(18, 19, 20, 21));
    const std::vector<Log> logs =
        read_logs({folder / "bag/run_10.db3", folder / "bag/run_9.db3"}, testing::no_table_options);
    ASSERT_EQ(logs.size(), 1u);
    EXPECT_THAT(logs[0].find("/u")->values, ElementsAre(18, 19, 20, 21));
    EXPECT_THAT(read_log(folder / "bag/run_9.db3", testing::no_table_options).notes,
                Contains(HasSubstr("is one of 2 files of a bag")));
    make_numbers(folder / "bag/other_0.db3", 0, 1);
    EXPECT_THAT(message_of([&] { read_log(folder / "bag", testing::no_table_options); }),
                HasSubstr("holds files of several bags: other_0.db3, run_10.db3, run_9.db3"));
}

TEST(SplitBag, DamageIsToldByTheFilesName) {
    const TemporaryFolder folder;
    make_numbers(folder / "run_0.db3", 0, 2);
    folder.write("run_1.db3", text_of(folder / "run_0.db3").substr(0, 4000));
    EXPECT_THAT(message_of([&] {
                    read_logs({folder / "run_0.db3", folder / "run_1.db3"}, testing::no_table_options);
                }),
                HasSubstr("run_1.db3: breaks off"));
    EXPECT_THAT(message_of([&] {
                    read_logs({folder / "run_0.db3", folder / "run_2.db3"}, testing::no_table_options);
                }),
                HasSubstr("run_2.db3: is not there"));
}

TEST(CompressedBag, MessagesAndFilesOfZstd_AreRead) {
    const TemporaryFolder folder;
    testing::BagTopic topic{"/u", "std_msgs/msg/Float64", {}};
    for (int k = 0; k < 3; ++k) topic.messages.emplace_back(wall_ns + k * ms, zstd_of(testing::float64(k)));
    testing::make_bag(folder / "messages.db3", {topic});
    EXPECT_THAT(read_log(folder / "messages.db3", testing::no_table_options).find("/u")->values,
                ElementsAre(0, 1, 2));
    std::filesystem::create_directory(folder / "bag");
    const std::string file = zstd_of(text_of(folder / "messages.db3"));
    folder.write("bag/m_0.db3.zstd", file);
    folder.write("bag/metadata.yaml",
                 "rosbag2_bagfile_information: { relative_file_paths: [m_0.db3.zstd] }\n");
    EXPECT_THAT(read_log(folder / "bag", testing::no_table_options).find("/u")->values, ElementsAre(0, 1, 2));
    EXPECT_THAT(read_log(folder / "bag/m_0.db3.zstd", testing::no_table_options).find("/u")->values,
                ElementsAre(0, 1, 2));
    folder.write("cut.db3.zstd", file.substr(0, file.size() / 2));
    EXPECT_THAT(message_of([&] { read_log(folder / "cut.db3.zstd", testing::no_table_options); }),
                HasSubstr("cut.db3.zstd: its zstd data break off"));
}

TEST(CompressedBag, DamagedMessage_IsToldByItsNumber) {
    const TemporaryFolder folder;
    const std::string whole = zstd_of(testing::float64(1.0));
    testing::make_bag(folder / "b.db3",
                      {{"/u", "std_msgs/msg/Float64", {{1, whole}, {2, whole.substr(0, 12)}}}});
    EXPECT_THAT(message_of([&] { read_log(folder / "b.db3", testing::no_table_options); }),
                HasSubstr("b.db3: /u: message 2: its zstd data break off"));
}

TEST(McapBag, FolderAndFile_AreRefusedWithTheCommandThatConvertsThem) {
    const TemporaryFolder folder;
    folder.write("bag/x_0.mcap", "\x89MCAP0\r\n");
    for (const char* given : {"bag", "bag/x_0.mcap"})
        EXPECT_THAT(message_of([&] { read_log(folder / given, testing::no_table_options); }),
                    HasSubstr("ros2 bag convert -i BAG -o to.yaml"));
    folder.write("bag/metadata.yaml", "rosbag2_bagfile_information: { relative_file_paths: [x_0.mcap] }\n");
    EXPECT_THAT(message_of([&] { read_log(folder / "bag", testing::no_table_options); }),
                HasSubstr("bag in the format MCAP"));
}

TEST(HostileBag, MessagesThatAreAViewWithoutEnd_AreRefused) {
    const TemporaryFolder folder;
    testing::make_bag(folder / "b.db3", {{"/u", "std_msgs/msg/Float64", {{1, testing::float64(1.0)}}}});
    sqlite3* bag = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "b.db3").c_str(), &bag), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(bag,
                           "DROP TABLE messages; CREATE VIEW Messages AS WITH RECURSIVE r(n) AS (SELECT 1 "
                           "UNION ALL SELECT n + 1 FROM r) SELECT n AS id, 1 AS topic_id, n AS timestamp, "
                           "x'00' AS data FROM r",
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(bag);
    EXPECT_THAT(message_of([&] { read_log(folder / "b.db3", testing::no_table_options); }),
                HasSubstr("is no bag of ROS 2: Messages is not a plain table"));
}

/// A connection to a bag's file that writes into a log of changes beside it and leaves them there.
class WriterWithLog {
  public:
    explicit WriterWithLog(const std::filesystem::path& file) {
        EXPECT_EQ(sqlite3_open(file.c_str(), &bag_), SQLITE_OK);
        run("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0");
    }
    ~WriterWithLog() { sqlite3_close(bag_); }
    WriterWithLog(const WriterWithLog&) = delete;
    WriterWithLog& operator=(const WriterWithLog&) = delete;

    void run(const char* sql) {
        EXPECT_EQ(sqlite3_exec(bag_, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(bag_);
    }

  private:
    sqlite3* bag_ = nullptr;
};

TEST(BagLog, TopicOfTwoTypes_IsTwoTopics) {
    const TemporaryFolder folder;
    testing::make_bag(
        folder / "b.db3",
        {{"/u", "std_msgs/msg/Float64", {{1, testing::float64(1.5)}}},
         {"/u", "std_msgs/msg/Int32", {{2, testing::CdrBytes().number(std::int32_t{7}).bytes()}}}});
    const Log log = read_log(folder / "b.db3", testing::no_table_options);
    ASSERT_NE(log.find("/u(std_msgs/msg/Float64)"), nullptr);
    ASSERT_NE(log.find("/u(std_msgs/msg/Int32)"), nullptr);
    EXPECT_THAT(log.find("/u(std_msgs/msg/Int32)")->values, ElementsAre(7.0));
    EXPECT_EQ(log.find("/u"), nullptr) << "it could be either";
}

TEST(BagWithLogOfChanges, WithoutTheLog_IsReadAsFarAsItGoes) {
    const TemporaryFolder folder;
    make_numbers(folder / "live.db3", 0, 3);
    WriterWithLog writer(folder / "live.db3");
    writer.run(
        "INSERT INTO messages(topic_id, timestamp, data) SELECT topic_id, timestamp + 9, data FROM "
        "messages WHERE id = 3");
    for (const char* name : {"a #1%?/bag.db3", "both/bag.db3"})
        folder.write(name, text_of(folder / "live.db3"));
    folder.write("both/bag.db3-wal", text_of(folder / "live.db3-wal"));
    const Log log = read_log(folder / "a #1%?/bag.db3", testing::no_table_options);
    EXPECT_THAT(log.find("/u")->values, ElementsAre(0, 1, 2));
    EXPECT_THAT(log.notes, Contains(HasSubstr("bag.db3 was written with a log of changes, bag.db3-wal, which "
                                              "is not beside it")));
    using Folder = std::filesystem::directory_iterator;
    EXPECT_EQ(std::distance(Folder(folder / "a #1%?"), Folder()), 1) << "reading makes no further files";
    const Log all = read_log(folder / "both/bag.db3", testing::no_table_options);
    EXPECT_THAT(all.find("/u")->values, ElementsAre(0, 1, 2, 2));
    EXPECT_THAT(all.notes, Not(Contains(HasSubstr("log of changes"))));
}

TEST(BagWithLogOfChanges, WithoutTheLogThatHasAllOfIt_IsRefused) {
    const TemporaryFolder folder;
    WriterWithLog writer(folder / "live.db3");
    writer.run("CREATE TABLE topics(id, name, type, serialization_format)");
    const auto file = folder.write("bag.db3", text_of(folder / "live.db3"));
    EXPECT_THAT(message_of([&] { read_log(file, testing::no_table_options); }),
                HasSubstr("no such table: topics; bag.db3-wal, its log of changes, is not beside it"));
}

TEST(HostileBag, TimeOfReceptionThatIsNoInteger_IsRefused) {
    const TemporaryFolder folder;
    make_numbers(folder / "b.db3", 0, 3);
    sqlite3* bag = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "b.db3").c_str(), &bag), SQLITE_OK);
    ASSERT_EQ(
        sqlite3_exec(bag, "UPDATE messages SET timestamp = 1.5 WHERE id = 2", nullptr, nullptr, nullptr),
        SQLITE_OK);
    sqlite3_close(bag);
    EXPECT_THAT(message_of([&] { read_log(folder / "b.db3", testing::no_table_options); }),
                HasSubstr("b.db3: /u: message 1: its time of reception, '1.5', is no integer"));
}

/// A page of a table's tree all of whose children are the next page.
std::string page_of_one_child(std::size_t page_bytes, std::uint32_t child) {
    constexpr std::size_t header = 12, cell = 5;
    const std::size_t cells = (page_bytes - header) / (cell + 2);
    const auto big_endian = [](std::uint32_t value, int bytes) {
        std::string text;
        for (int k = bytes - 1; k >= 0; --k) text += static_cast<char>(value >> (8 * k));
        return text;
    };
    const std::size_t content = page_bytes - cells * cell;
    std::string page = "\x05" + big_endian(0, 2) + big_endian(static_cast<std::uint32_t>(cells), 2) +
                       big_endian(static_cast<std::uint32_t>(content), 2) + big_endian(0, 1) +
                       big_endian(child, 4);
    for (std::size_t k = 0; k < cells; ++k)
        page += big_endian(static_cast<std::uint32_t>(content + k * cell), 2);
    page.resize(content);
    for (std::size_t k = 0; k < cells; ++k) page += big_endian(child, 4) + "\x01";
    return page;
}

TEST(HostileBag, TreeWhosePagesAreReferredToOverAndOver_IsRefused) {
    const TemporaryFolder folder;
    constexpr std::size_t page_bytes = 4096;
    testing::make_bag(folder / "b.db3", {{"/u", "std_msgs/msg/Float64", {{1, testing::float64(1.0)}}}});
    sqlite3* bag = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "b.db3").c_str(), &bag), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(bag, "DROP INDEX timestamp_idx; VACUUM", nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(bag);
    std::string bytes = text_of(folder / "b.db3");
    // Pages are the schema, topics, messages; the last leads through four more to its own leaf.
    ASSERT_EQ(bytes.size(), 3 * page_bytes);
    const std::string leaf = bytes.substr(2 * page_bytes);
    bytes.resize(2 * page_bytes);
    for (std::uint32_t page = 3; page < 7; ++page) bytes += page_of_one_child(page_bytes, page + 1);
    bytes += leaf;
    bytes[31] = 7;  // the header's number of pages
    const auto file = folder.write("b.db3", bytes);
    EXPECT_THAT(message_of([&] { read_log(file, testing::no_table_options); }),
                HasSubstr("b.db3: is damaged"));
}

}  // namespace
}  // namespace fidservo::imports

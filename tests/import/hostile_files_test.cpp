// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are cut off, empty, not what their names say, or made to hurt: one line each, and no more.
#include "core/input_error.h"
#include "core/sanitizer.h"
#include "src/import/guarded.h"
#include "src/import/import_module.h"
#include "src/import/read_log.h"
#include "src/process/interrupt.h"
#include "tests/import/made_files.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::message_of;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;
using ::testing::HasSubstr;
using ::testing::Not;

/// A whole file of each format.
std::vector<std::string> make_whole_files(const TemporaryFolder& folder) {
    std::vector<double> t, x;
    for (int k = 0; k < 500; ++k) {
        t.push_back(0.01 * k);
        x.push_back(k * k % 97);
    }
    testing::make_plain_mat(folder / "five.mat", testing::MatFormat::five, {{"t", t}, {"x", x}});
    testing::make_simulink_mat(folder / "seven.mat", testing::MatFormat::seven_three, t, {{"x", x}});
    testing::make_hdf5(folder / "log.h5", {{"/t", t}, {"/x", x}});
    testing::BagTopic topic{"/x", "sensor_msgs/msg/JointState", {}};
    for (int k = 0; k < 200; ++k)
        topic.messages.emplace_back(k + 1,
                                    testing::joint_state(k + 1, {"a"}, {x[static_cast<std::size_t>(k)]}));
    testing::make_bag(folder / "bag.db3", {topic});
    return {"five.mat", "seven.mat", "log.h5", "bag.db3"};
}

/// What the reader says; empty if it reads the file.
std::string answer_of(const std::filesystem::path& file) {
    try {
        read_log(file, testing::no_table_options);
        return {};
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file.filename().string()));
        EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
        return error.what();
    }
}

TEST(HostileFiles, CutOffAnywhere_AreRefusedInOneLine) {
    const TemporaryFolder folder;
    for (const std::string& name : make_whole_files(folder)) {
        const std::string bytes = text_of(folder / name);
        EXPECT_EQ(answer_of(folder / name), "") << name;
        for (const std::size_t left : {bytes.size() - 1, bytes.size() * 3 / 4, bytes.size() / 2,
                                       std::size_t{600}, std::size_t{130}, std::size_t{1}}) {
            const auto cut = folder.write("cut/" + name, bytes.substr(0, left));
            EXPECT_NE(answer_of(cut), "") << name << " of " << bytes.size() << " bytes cut to " << left;
        }
        EXPECT_THAT(answer_of(folder.write("empty/" + name, "")), HasSubstr("is empty"));
    }
}

TEST(HostileFiles, WithWrongBytes_AreReadOrRefused) {
    const TemporaryFolder folder;
    for (const std::string& name : make_whole_files(folder)) {
        const std::string bytes = text_of(folder / name);
        for (unsigned seed = 1; seed <= 25; ++seed) {
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            std::mt19937 generator(seed);
            std::string wrong = bytes;
            for (int k = 0; k < 12; ++k)
                wrong[generator() %
                      std::min<std::size_t>(wrong.size(), seed % 2 == 0 ? 4096 : wrong.size())] =
                    static_cast<char>(generator());
            answer_of(folder.write("wrong/" + name, wrong));
        }
    }
}

TEST(HostileFiles, OfOtherKinds_AreToldByWhatTheyAre) {
    const TemporaryFolder folder;
    EXPECT_THAT(answer_of(folder.write("a.mcap", "\x89MCAP0\r\n")), HasSubstr("is a bag in the format MCAP"));
    EXPECT_THAT(answer_of(folder.write("a.bag", "#ROSBAG V2.0\n")), HasSubstr("a bag of ROS 1"));
    EXPECT_THAT(answer_of(folder.write("a.tdms", "TDSm....")), HasSubstr("a TDMS file"));
    EXPECT_THAT(answer_of(folder.write("a.mat", "hello")), HasSubstr("save it again with -v7"));
    EXPECT_THAT(answer_of(folder.write("a.h5", "hello")), HasSubstr("has no signature of HDF5"));
    EXPECT_THAT(answer_of(folder.write("a.db3", "hello")), HasSubstr("does not begin as a database"));
    EXPECT_THAT(answer_of(folder / "none.csv"), HasSubstr("is not there"));
    EXPECT_THAT(answer_of(folder.write("a.csv", "\n\n")), HasSubstr("a.csv"));
    std::filesystem::create_directory(folder / "nothing");
    EXPECT_THAT(answer_of(folder / "nothing"), HasSubstr("is a folder without a bag"));
    EXPECT_THAT(answer_of("/dev/null"), HasSubstr("is no file and no folder"));
}

TEST(HostileFiles, BagThatIsNoBag_SaysWhy) {
    const TemporaryFolder folder;
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "no.db3").c_str(), &database), SQLITE_OK);
    sqlite3_exec(database, "CREATE TABLE a(b)", nullptr, nullptr, nullptr);
    sqlite3_close(database);
    EXPECT_THAT(answer_of(folder / "no.db3"), HasSubstr("no such table: topics"));
    std::string cut = testing::joint_state(5, {"a"}, {1.0});
    cut.resize(cut.size() - 20);
    testing::make_bag(folder / "cut.db3", {{"/js", "sensor_msgs/msg/JointState", {{1, cut}}}});
    EXPECT_THAT(answer_of(folder / "cut.db3"), HasSubstr("/js: message 1: breaks off"));
    std::string many("\0\1\0\0\0\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\xff\xff\xff\xff", 24);
    testing::make_bag(folder / "many.db3", {{"/js", "sensor_msgs/msg/JointState", {{1, many}}}});
    EXPECT_THAT(answer_of(folder / "many.db3"), HasSubstr("/js: message 1: breaks off"));
    testing::make_bag(folder / "other.db3", {{"/u", "std_msgs/msg/Float64", {{1, "x"}}, "protobuf"}});
    EXPECT_THAT(answer_of(folder / "other.db3"), HasSubstr("serialized as 'protobuf'"));
}

LogOrFault crash(const char*) {
    ::raise(SIGSEGV);
    return Log{};
}

[[maybe_unused]] LogOrFault take_all_memory(const char*) {
    constexpr std::size_t gigabyte = std::size_t{1} << 30U;
    for (std::vector<std::unique_ptr<char[]>> all;;)
        all.push_back(std::make_unique_for_overwrite<char[]>(gigabyte));
}

LogOrFault never_end(const char*) {
    for (std::atomic<int> turns = 0;; ++turns) continue;
}

LogOrFault one_signal(const char* file) {
    Log log;
    log.signals.push_back({.name = file,
                           .unit = "mm",
                           .values = {1.0, 2.0},
                           .whole = {1, 2},
                           .times = "t",
                           .decimals = 3,
                           .fault = {}});
    log.texts["a"] = "b";
    log.notes = {"n"};
    return log;
}

TEST(GuardedReading, WhatHappensInIt_IsOneLine) {
    const Log log = read_guarded("name", one_signal);
    ASSERT_EQ(log.signals.size(), 1u);
    EXPECT_EQ(log.signals[0].name, "name");
    EXPECT_EQ(log.signals[0].decimals, 3);
    EXPECT_EQ(log.signals[0].whole, (std::vector<std::int64_t>{1, 2}));
    EXPECT_EQ(log.texts.at("a"), "b");
    EXPECT_THAT(message_of([] { read_guarded("bad.mat", crash); }),
                HasSubstr("bad.mat: the format's library"));
    EXPECT_THAT(message_of([] { read_guarded("bad.h5", never_end, {.processor_s = 1}); }),
                HasSubstr("bad.h5: reading it took more than 1 s of the processor"));
    if (has_sanitizer) return;
    EXPECT_THAT(message_of([] { read_guarded("bad.mat", take_all_memory); }),
                HasSubstr("takes more memory than the 8 GiB"));
}

/// How a process ends that reads the file after Ctrl-C.
void expect_interrupted(const std::string& file) {
    EXPECT_EXIT(
        {
            request_interrupt();
            const std::string message = message_of([&] { read_log(file, {}); });
            std::fputs(message.c_str(), stderr);
            std::_Exit(2);
        },
        ::testing::ExitedWithCode(2), "^interrupted \\(SIGINT\\): nothing was written$");
}

TEST(InterruptedReading, OfATable_EndsWithOneLine) {
    const TemporaryFolder folder;
    expect_interrupted(folder.write("log.csv", "t [s],x [mm]\n0,1\n1,2\n"));
}

TEST(InterruptedReading, OfABag_EndsWithOneLine) {
    const TemporaryFolder folder;
    testing::BagTopic topic{"/u", "std_msgs/msg/Float64", {}};
    for (int k = 0; k < 10; ++k) topic.messages.emplace_back(k + 1, testing::float64(k));
    testing::make_bag(folder / "bag.db3", {topic});
    expect_interrupted(folder / "bag.db3");
}

TEST(InterruptedReading, OfABag_EndsInTheMiddle) {
    const TemporaryFolder folder;
    testing::BagTopic topic{"/u", "std_msgs/msg/Float64", {}};
    for (int k = 0; k < 1000; ++k) topic.messages.emplace_back(k + 1, testing::float64(k));
    testing::make_bag(folder / "bag.db3", {topic});
    static int asked = 0;
    const auto is_interrupted = [] { return ++asked > 500; };
    const std::filesystem::path file = folder / "bag.db3";
    const LogOrFault log = import_module(file).read_rosbag2({file}, is_interrupted);
    ASSERT_FALSE(log);
    EXPECT_THAT(log.error(), HasSubstr("interrupted"));
    EXPECT_LT(asked, 510) << "nothing more is read after that";
}

}  // namespace
}  // namespace fidservo::imports

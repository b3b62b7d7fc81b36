// SPDX-License-Identifier: GPL-3.0-or-later
// What the readers make of each format's own ways.
#include "src/files/recording/reader.h"
#include "src/import/read_log.h"
#include "tests/import/made_files.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::imports {
namespace {

using fidservo::testing::message_of;
using fidservo::testing::run_program;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TableLog, TitlesUnitsGapsAndBigNumbers_AreKept) {
    const TemporaryFolder folder;
    const Log log = read_log(
        folder.write(
            "t.csv",
            "#timestamp [ns],x [mm],note,u_V\n1700000000000000001,1.50,a,\n1700000000000000002,2.25,b,4\n"),
        testing::no_table_options);
    ASSERT_EQ(log.signals.size(), 3u);
    EXPECT_THAT(log.signals[0].whole, ElementsAre(1700000000000000001, 1700000000000000002));
    EXPECT_EQ(log.signals[0].unit, "ns");
    EXPECT_EQ(log.signals[1].name, "x");
    EXPECT_EQ(log.signals[1].decimals, 2);
    EXPECT_TRUE(std::isnan(log.signals[2].values[0]));
    EXPECT_EQ(log.signals[2].unit, "") << "u_V may be a name";
}

TEST(TableLog, LineOfUnits_GivesUnitsAboveAndBelowTheTitles) {
    const TemporaryFolder folder;
    const std::string rows = "0,1,2\n0.01,2,3\n0.02,4,5\n";
    for (const char* lines :
         {"t,x,n\ns,mm,-\n", "s,mm,-\nt,x,n\n", "# s,mm,\nt,x,n\n", "t,x,n\n[s],[mm],\n"}) {
        SCOPED_TRACE(lines);
        const Log log = read_log(folder.write("log.csv", lines + rows), testing::no_table_options);
        ASSERT_EQ(log.signals.size(), 3U);
        EXPECT_EQ(log.signals[0].name, "t");
        EXPECT_EQ(log.signals[0].unit, "s");
        EXPECT_EQ(log.signals[1].name, "x");
        EXPECT_EQ(log.signals[1].unit, "mm");
        EXPECT_EQ(log.signals[2].name, "n");
        EXPECT_EQ(log.signals[2].unit, "");
    }
}

TEST(TableLog, LabViewsMeasurementFile_IsReadBelowItsHeader) {
    const TemporaryFolder folder;
    std::string text =
        "LabVIEW "
        "Measurement\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_"
        "Headings\tNo\n"
        "X_Columns\tOne\nTime_Pref\tRelative\n***End_of_Header***\t\nChannels\t2\nSamples\t200\t200\n"
        "Y_Unit_Label\tVolts\tmm\nX_Dimension\tTime\tTime\nX0\t0,0\t0,0\nDelta_X\t0,001\t0,001\n***End_of_"
        "Header***\t\n"
        "X_Value\tDrive\tPosition\tComment\n";
    for (int k = 0; k < 200; ++k) text += fmt::format("0,{:03}\t0,{}\t1,{:04}\n", k, 5 + k % 4, k);
    const Log log = read_log(folder.write("log.lvm", text), testing::no_table_options);
    ASSERT_GE(log.signals.size(), 3u);
    EXPECT_EQ(log.signals[2].values.size(), 200u);
    EXPECT_DOUBLE_EQ(log.signals[2].values[30], 1.003);
}

TEST(MatLog, ObjectsOfMatlab_AreRefusedByNameWithTheLineThatSavesThem) {
    const TemporaryFolder folder;
    const auto file = folder.write("tt.mat", testing::opaque_mat("TT", "timetable"));
    const std::string message = message_of([&] { read_log(file, testing::no_table_options); });
    EXPECT_THAT(message,
                HasSubstr("tt.mat: TT: is an object of MATLAB's class timetable, which only MATLAB reads"));
    EXPECT_THAT(message, HasSubstr("timetable2table(TT)"));
    const std::vector<std::pair<std::string, std::string>> lines{
        {"string", "char(v)"},
        {"datetime", "posixtime(v)"},
        {"timeseries", "v.Time"},
        {"Simulink.SimulationData.Dataset", "v{1}.Values"},
        {"MyClass", "struct(v)"}};
    for (const auto& one : lines) {
        const auto object = folder.write("o.mat", testing::opaque_mat("v", one.first));
        EXPECT_THAT(message_of([&] { read_log(object, testing::no_table_options); }), HasSubstr(one.second));
    }
}

TEST(MatLog, ObjectBesideNumbers_IsListedAndTheNumbersAreRead) {
    const TemporaryFolder folder;
    testing::make_plain_mat(folder / "plain.mat", testing::MatFormat::five,
                            {{"t", {0, 1, 2}}, {"x_mm", {4, 5, 6}}});
    const std::string object = testing::opaque_mat("when", "datetime");
    std::ofstream(folder / "plain.mat", std::ios::binary | std::ios::app) << object.substr(128);
    const Log log = read_log(folder / "plain.mat", testing::no_table_options);
    ASSERT_NE(log.find("x_mm"), nullptr);
    EXPECT_THAT(log.find("x_mm")->values, ElementsAre(4, 5, 6));
    EXPECT_EQ(log.find("x_mm")->unit, "mm");
    ASSERT_NE(log.find("when"), nullptr);
    EXPECT_THAT(log.find("when")->fault, HasSubstr("posixtime(when)"));
}

TEST(MatLog, SimulinksStructure_GivesSignalsByLabelWithTheirTimes) {
    const TemporaryFolder folder;
    for (const auto format : {testing::MatFormat::five, testing::MatFormat::seven_three}) {
        testing::make_simulink_mat(folder / "s.mat", format, {0.0, 0.5},
                                   {{"Drive", {1, 2}}, {"Position", {3, 4}}});
        const Log log = read_log(folder / "s.mat", testing::no_table_options);
        ASSERT_NE(log.find("out.Position"), nullptr);
        EXPECT_EQ(log.find("out.Position")->times, "out.time");
        EXPECT_EQ(log.find("out.time")->unit, "s");
        std::filesystem::remove(folder / "s.mat");
    }
}

TEST(Hdf5Log, TablesAndUnits_AreRead) {
    const TemporaryFolder folder;
    testing::make_hdf5(folder / "u.h5", {{"/a/t", {0, 1}, "seconds"}, {"/a/x", {1, 2}, "m"}});
    const Log log = read_log(folder / "u.h5", testing::no_table_options);
    EXPECT_EQ(log.find("/a/x")->unit, "m");
    EXPECT_EQ(log.find("/a/t")->unit, "s");
    testing::make_hdf5_table(folder / "t.h5", "run", {{"t_ns", {0, 5}}, {"x_mm", {1.5, 2.5}}});
    const Log table = read_log(folder / "t.h5", testing::no_table_options);
    ASSERT_NE(table.find("/run.x_mm"), nullptr);
    EXPECT_THAT(table.find("/run.x_mm")->values, ElementsAre(1.5, 2.5));
    EXPECT_EQ(table.find("/run.x_mm")->unit, "mm");
}

TEST(BagLog, TopicsAreSignalsOnTheirStamps) {
    const TemporaryFolder folder;
    testing::make_bag(
        folder / "b.db3",
        {{"/js",
          "sensor_msgs/msg/JointState",
          {{105, testing::joint_state(20, {"a", "b"}, {1, 2})}, {101, testing::joint_state(10, {"b"}, {7})}}},
         {"/u", "std_msgs/msg/Float64", {{1, testing::float64(0.5)}, {2, testing::float64(-0.25)}}},
         {"/other", "nav_msgs/msg/Odometry", {{1, "x"}}}});
    const Log log = read_log(folder / "b.db3", testing::no_table_options);
    ASSERT_NE(log.find("/js/position[b]"), nullptr);
    EXPECT_THAT(log.find("/js/position[b]")->values, ElementsAre(7, 2));
    EXPECT_THAT(log.find("/js/stamp")->whole, ElementsAre(10, 20));
    EXPECT_EQ(log.find("/u")->times, "/u/received");
    EXPECT_THAT(log.notes, ::testing::Contains(
                               HasSubstr("/other: passed over: messages of type nav_msgs/msg/Odometry")));
}

TEST(BagLog, CameraBecomesFramesAndIntrinsics) {
    const TemporaryFolder folder;
    std::string pixels(6 * 4, '\0');
    for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = static_cast<char>(10 * k);
    const cv::Mat grey(4, 6, CV_8UC1, pixels.data());
    std::vector<unsigned char> png;
    ASSERT_TRUE(cv::imencode(".png", grey, png));
    const std::string compressed = testing::CdrBytes()
                                       .header(3'000'000'000)
                                       .text("png")
                                       .octets(std::string(png.begin(), png.end()))
                                       .bytes();
    testing::CdrBytes info;
    info.header(1)
        .number(std::uint32_t{4})
        .number(std::uint32_t{6})
        .text("plumb_bob")
        .doubles({0.1, 0.0, 0.0, 0.0, 0.0});
    for (const double value : {5.0, 0.0, 3.0, 0.0, 5.0, 2.0, 0.0, 0.0, 1.0}) info.number(value);
    for (int k = 0; k < 9 + 12; ++k) info.number(k % 4 == 0 ? 1.0 : 0.0);
    for (int k = 0; k < 6; ++k) info.number(std::uint32_t{0});
    info.number(std::uint8_t{0});
    testing::make_bag(folder / "b.db3", {{"/raw",
                                          "sensor_msgs/msg/Image",
                                          {{9, testing::mono8_image(2'000'000'000, 6, 4, pixels)},
                                           {8, testing::mono8_image(1'000'000'000, 6, 4, pixels)}}},
                                         {"/small", "sensor_msgs/msg/CompressedImage", {{9, compressed}}},
                                         {"/info", "sensor_msgs/msg/CameraInfo", {{9, info.bytes()}}}});
    for (const std::string topic : {"/raw", "/small"}) {
        folder.write(
            "map.yaml",
            fmt::format(
                "format: fidservo-map/1\nrecording: {{ name: a, rig: b, experiment: c, tick_s: 0.001 }}\n"
                "camera: {{ images: {}, info: /info, offset_s: 0.5 }}\n",
                topic));
        const std::string out = "out" + topic.substr(1);
        const auto run = run_program({"import", "b.db3", "--map", "map.yaml", "--out", out}, folder.path());
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Recording recording = read_recording(folder / out);
        ASSERT_EQ(recording.frames.size(), topic == "/raw" ? 2u : 1u);
        EXPECT_EQ(recording.frames[0].time_ns, topic == "/raw" ? 1'500'000'000 : 3'500'000'000);
        const cv::Mat read = cv::imread((folder / out / "cam0/data" / recording.frames[0].filename).string(),
                                        cv::IMREAD_UNCHANGED);
        EXPECT_EQ(cv::norm(read, grey, cv::NORM_INF), 0.0);
        EXPECT_THAT(text_of(folder / out / "camera_info.yaml"), HasSubstr("k: [5, 0, 3, 0, 5, 2, 0, 0, 1]"));
    }
}

TEST(EurocFolder, GivesItsCameraAndItsTables) {
    const TemporaryFolder folder;
    folder.write("mav0/imu0/data.csv",
                 "#timestamp [ns],a [m/s^2]\n1403636579758555392,1.5\n1403636579763555392,2.5\n");
    folder.write("mav0/cam0/data.csv",
                 "#timestamp [ns],filename\n1403636579763555584,1403636579763555584.png\n");
    std::filesystem::create_directories(folder / "mav0/cam0/data");
    cv::imwrite((folder / "mav0/cam0/data/1403636579763555584.png").string(),
                cv::Mat(5, 7, CV_8UC1, cv::Scalar(33)));
    const Log log = read_log(folder.path(), testing::no_table_options);
    ASSERT_EQ(log.cameras.size(), 1u);
    EXPECT_THAT(log.cameras[0].times_ns, ElementsAre(1403636579763555584));
    EXPECT_EQ(log.cameras[0].frame(0)->image.grey.at<unsigned char>(2, 2), 33);
    ASSERT_NE(log.find("imu0/a"), nullptr);
    EXPECT_EQ(log.find("imu0/a")->times, "imu0/timestamp");
}

TEST(ImportWithoutMap, PrintsWhatItFound_AndAMapThatWorks) {
    const TemporaryFolder folder;
    std::string text = "t [s],u [V],pos [um]\n";
    for (int k = 0; k < 50; ++k) text += fmt::format("{:.3f},{},{:.1f}\n", 0.002 * k, k % 3, 2.5 * k);
    folder.write("log.csv", text);
    const auto draft = run_program({"import", "log.csv"}, folder.path());
    ASSERT_EQ(draft.exit_code, 0) << draft.err;
    EXPECT_THAT(draft.out, HasSubstr("0 .. 122.5"));
    folder.write("map.yaml", draft.out);
    const auto run = run_program({"import", "log.csv", "--map", "map.yaml", "--out", "r"}, folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err << draft.out;
    const Recording recording = read_recording(folder / "r");
    EXPECT_EQ(recording.rows.size(), 50u);
    EXPECT_EQ(recording.tick_s, 0.002);
    EXPECT_DOUBLE_EQ(recording.rows[10].position_mm, 0.025);
    const auto again = run_program({"import", "log.csv", "--map", "map.yaml", "--out", "r"}, folder.path());
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.err, HasSubstr("r: exists already"));
}

}  // namespace
}  // namespace fidservo::imports

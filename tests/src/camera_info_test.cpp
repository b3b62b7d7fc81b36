// SPDX-License-Identifier: GPL-3.0-or-later
// The camera of a rig file, and ROS's files of intrinsics.
#include "src/files/rig/camera_info.h"

#include "core/random.h"
#include "core/rig.h"
#include "src/files/rig/rig_edit.h"
#include "src/files/rig/rig_file.h"
#include "src/inspect/identity.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

const std::filesystem::path assets = FIDSERVO_ASSETS_DIR;

/// In the layout that camera_calibration_parsers writes, with the line breaks of older calibrators.
const std::string ros_text = R"(image_width: 1280
image_height: 960
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [5012.25, 0., 641.5,
         0., 5002.5, 470.25,
         0., 0., 1.   ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.2, 3.5e-2, 0.001, -0.000139, 0.]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [5012.25, 0, 641.5, 0, 0, 5002.5, 470.25, 0, 0, 0, 1, 0]
)";

std::string replaced(std::string text, const std::string& piece, const std::string& replacement) {
    const auto place = text.find(piece);
    EXPECT_NE(place, std::string::npos) << piece;
    return text.replace(place, piece.size(), replacement);
}

/// What is wrong with the ROS file when a piece is replaced, without the file's name.
std::string ros_message_with(const std::string& piece, const std::string& replacement) {
    const TemporaryFolder folder;
    const auto file = folder.write("camera.yaml", replaced(ros_text, piece, replacement));
    const std::string message = message_of([&] { load_camera_info(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ":")) << message;
    return message.substr(std::min(message.size(), file.string().size() + 1));
}

TEST(CameraInfo, RosFile_IsReadWholly) {
    const TemporaryFolder folder;
    const CameraInfo info = load_camera_info(folder.write("camera.yaml", ros_text));
    EXPECT_EQ(info.camera_name, "narrow_stereo");
    EXPECT_EQ(info.width_px, 1280);
    EXPECT_EQ(info.height_px, 960);
    EXPECT_EQ(info.focal_px, Eigen::Vector2d(5012.25, 5002.5));
    EXPECT_EQ(info.principal_point_px, Eigen::Vector2d(641.5, 470.25));
    EXPECT_EQ(info.distortion.k1, -0.2);
    EXPECT_EQ(info.distortion.k2, 0.035);
    EXPECT_EQ(info.distortion.p1, 0.001);
    EXPECT_EQ(info.distortion.p2, -0.000139);
    EXPECT_EQ(info.distortion.k3, 0.0);
}

TEST(CameraInfo, WrittenAndRead_IsTheSameToTheLastBit) {
    constexpr std::uint64_t seed = 3;
    NoiseStream random(seed, "camera_info_test");
    for (int k = 0; k < 100; ++k) {
        const CameraInfo info{
            .camera_name = k % 2 == 0 ? "cam0" : "left: \"a\" #1",
            .width_px = 640 + k,
            .height_px = 480 + k,
            .focal_px = {4000 * (1 + random.uniform()), 6000 * (1 + 0.1 * random.uniform())},
            .principal_point_px = {320 * random.uniform(), 240 * random.uniform()},
            .distortion = {.k1 = random.uniform() - 0.5,
                           .k2 = random.uniform() * 1e-7,
                           .p1 = random.uniform() * 1e-3,
                           .p2 = -random.uniform() * 1e-3,
                           .k3 = random.uniform()}};
        const TemporaryFolder folder;
        const CameraInfo again = load_camera_info(folder.write("camera.yaml", camera_info_text(info)));
        EXPECT_EQ(camera_info_text(again), camera_info_text(info));
        EXPECT_EQ(again.camera_name, info.camera_name);
        EXPECT_EQ(again.focal_px, info.focal_px) << "seed " << seed;
        EXPECT_EQ(again.principal_point_px, info.principal_point_px) << "seed " << seed;
        EXPECT_EQ(again.distortion.k1, info.distortion.k1) << "seed " << seed;
        EXPECT_EQ(again.distortion.k2, info.distortion.k2) << "seed " << seed;
        EXPECT_EQ(again.distortion.p2, info.distortion.p2) << "seed " << seed;
    }
}

TEST(CameraInfo, WrittenText_HasTheLayoutOfRos) {
    const TemporaryFolder folder;
    const CameraInfo info = load_camera_info(folder.write("camera.yaml", ros_text));
    EXPECT_EQ(
        camera_info_text(info),
        "image_width: 1280\nimage_height: 960\ncamera_name: narrow_stereo\n"
        "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [5012.25, 0, 641.5, 0, 5002.5, 470.25, 0, 0, 1]\n"
        "distortion_model: plumb_bob\n"
        "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.2, 0.035, 0.001, -0.000139, 0]\n"
        "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
        "projection_matrix:\n  rows: 3\n  cols: 4\n"
        "  data: [5012.25, 0, 641.5, 0, 0, 5002.5, 470.25, 0, 0, 0, 1, 0]\n");
}

TEST(CameraInfo, FileWithoutModelAndWithOtherKeys_IsReadAsRosReadsIt) {
    const TemporaryFolder folder;
    const std::string text =
        replaced(ros_text, "distortion_model: plumb_bob\n", "binning_x: 1\nroi: {x_offset: 0}\n");
    EXPECT_EQ(load_camera_info(folder.write("camera.yaml", text)).distortion.k1, -0.2);
}

TEST(CameraInfo, Mistakes_AreNamedWithWhatIsAllowed) {
    EXPECT_EQ(ros_message_with("plumb_bob", "rational_polynomial"),
              "10: distortion_model: rational_polynomial: this distortion model is not supported; allowed: "
              "plumb_bob, equidistant (or fisheye)");
    EXPECT_EQ(
        ros_message_with("plumb_bob", "equidistant"),
        "14: distortion_coefficients.data: a list: has 5 coefficients; allowed of an equidistant lens: k1, "
        "k2, k3, k4");
    EXPECT_EQ(ros_message_with("cols: 5", "cols: 8"),
              "14: distortion_coefficients.data: a list: must be a list of 8 numbers");
    EXPECT_EQ(ros_message_with("-0.000139, 0.]", "-0.000139]"),
              "14: distortion_coefficients.data: a list: must be a list of 5 numbers");
    EXPECT_EQ(ros_message_with("5012.25, 0., 641.5", "5012.25, 2., 641.5"),
              "7: camera_matrix.data: a list: skew is not supported: the 2nd and 4th number must be 0");
    EXPECT_EQ(ros_message_with("5012.25, 0., 641.5", "0, 0., 641.5"),
              "7: camera_matrix.data: a list: f_x and f_y, the 1st and 5th number, must be above 0");
    EXPECT_EQ(
        ros_message_with("[5012.25, 0., 641.5,\n         0., 5002.5,",
                         "[16.2, 0., 641.5,\n         0., 16.2,"),
        "7: camera_matrix.data: a list: a focal length of 16.2 px would see 177.1 degrees along 1280 px; "
        "allowed: 56 px or more: it is in px, not in mm or m");
    EXPECT_EQ(ros_message_with("0., 0., 1.   ]", "0., 1., 1.   ]"),
              "7: camera_matrix.data: a list: the last row must be 0, 0, 1");
    EXPECT_EQ(ros_message_with("5002.5, 470.25,\n", "502.5, 470.25,\n"),
              "7: camera_matrix.data: a list: f_y / f_x must be of at least 0.5 and at most 2");
    EXPECT_EQ(ros_message_with("image_width: 1280", "image_width: 1280 px"),
              "1: image_width: 1280 px: must be a whole number from 16 to 20000");
    EXPECT_EQ(ros_message_with("distortion_coefficients", "distortion_coefficents"),
              "1: distortion_coefficients: missing: this key must be given");
}

TEST(CameraInfo, EquidistantLens_IsReadByEitherNameAndWrittenByRossName) {
    const TemporaryFolder folder;
    for (const std::string name : {"equidistant", "fisheye"}) {
        const std::string text =
            replaced(replaced(replaced(ros_text, "plumb_bob", name), "cols: 5", "cols: 4"), "-0.000139, 0.]",
                     "-0.000139]");
        const CameraInfo info = load_camera_info(folder.write(name + ".yaml", text));
        EXPECT_EQ(info.distortion.model, LensModel::equidistant);
        EXPECT_EQ(numbers_of(info.distortion), (std::vector<double>{-0.2, 0.035, 0.001, -0.000139}));
        const std::string written = camera_info_text(info);
        EXPECT_NE(
            written.find("distortion_model: equidistant\ndistortion_coefficients:\n  rows: 1\n  cols: 4\n"
                         "  data: [-0.2, 0.035, 0.001, -0.000139]\n"),
            std::string::npos)
            << written;
        const CameraInfo again = load_camera_info(folder.write(name + "_again.yaml", written));
        EXPECT_EQ(again.distortion.model, LensModel::equidistant);
        EXPECT_EQ(numbers_of(again.distortion), numbers_of(info.distortion));
    }
}

/// The reference rig with a piece replaced, in a folder with its other files and the ROS file.
class RigCamera : public ::testing::Test {
  protected:
    std::filesystem::path rig_with(const std::string& piece, const std::string& replacement) const {
        std::filesystem::copy_file(assets / "preisach_fod.csv", folder_ / "preisach_fod.csv",
                                   std::filesystem::copy_options::overwrite_existing);
        folder_.write("cam/ros.yaml", ros_text);
        return folder_.write("rig.yaml", replaced(text_of(assets / "rig.yaml"), piece, replacement));
    }
    std::filesystem::path rig_with_camera_info() const {
        return rig_with(own_intrinsics, "  camera_info: cam/ros.yaml\n");
    }
    std::string message_with(const std::string& key_and_value) const {
        const auto file = rig_with("  distance_mm: 20\n", "  distance_mm: 20\n  " + key_and_value + "\n");
        return message_of([&] { load_rig(file); }).substr(file.string().size() + 1);
    }

    const std::string own_intrinsics =
        "  width_px: 1280\n  height_px: 960\n  focal_px: 5000\n  principal_point_px: [639.5, 479.5]\n";
    TemporaryFolder folder_;
};

TEST_F(RigCamera, NewKeys_AreReadAndNeutralWhereTheyAreNotGiven) {
    const CameraParameters plain = load_rig(assets / "rig.yaml").camera.value();
    EXPECT_TRUE(looks_straight(plain.geometry));
    EXPECT_EQ(plain.gain_spread, 0.0);
    const CameraParameters camera =
        load_rig(rig_with("  distance_mm: 20\n",
                          "  distance_mm: 20\n  focal_ratio: 0.998\n  distortion: [-0.2, 0.03, 1e-3, -2e-3, "
                          "0.5]\n  rotation_rad: 0.0175\n  tilt_rad: [0.05, -0.01]\n  axis_rad: [0.0005, "
                          "-0.0002]\n  gain_spread: 0.01\n"))
            .camera.value();
    EXPECT_EQ(camera.geometry.focal_ratio, 0.998);
    EXPECT_EQ(camera.geometry.distortion.k1, -0.2);
    EXPECT_EQ(camera.geometry.distortion.k2, 0.03);
    EXPECT_EQ(camera.geometry.distortion.p1, 1e-3);
    EXPECT_EQ(camera.geometry.distortion.p2, -2e-3);
    EXPECT_EQ(camera.geometry.distortion.k3, 0.5);
    EXPECT_EQ(camera.geometry.rotation_rad, 0.0175);
    EXPECT_EQ(camera.geometry.tilt_rad, Eigen::Vector2d(0.05, -0.01));
    EXPECT_EQ(camera.geometry.axis_rad, Eigen::Vector2d(0.0005, -0.0002));
    EXPECT_EQ(camera.gain_spread, 0.01);
}

TEST_F(RigCamera, EquidistantLens_IsReadWithItsFourCoefficients) {
    const auto camera_with = [&](const std::string& keys) {
        return load_rig(rig_with("  distance_mm: 20\n", "  distance_mm: 20\n  " + keys + "\n"))
            .camera->geometry;
    };
    const CameraGeometry bare = camera_with("lens: equidistant");
    EXPECT_EQ(bare.distortion.model, LensModel::equidistant);
    EXPECT_FALSE(looks_straight(bare));
    const CameraGeometry camera = camera_with("lens: equidistant\n  distortion: [0.01, 0.02, 0.03, 0.04]");
    EXPECT_EQ(numbers_of(camera.distortion), (std::vector<double>{0.01, 0.02, 0.03, 0.04}));
    EXPECT_EQ(camera_with("lens: plumb_bob").distortion.model, LensModel::plumb_bob);
    EXPECT_EQ(message_with("lens: fish"), "26: camera.lens: fish: must be one of: plumb_bob, equidistant");
    EXPECT_EQ(message_with("lens: equidistant\n  distortion: [0, 0, 0, 0, 0]"),
              "27: camera.distortion: a list: must be a list of 4 numbers");
    EXPECT_EQ(message_with("lens: equidistant\n  distortion: [-60, 0, 0, 0]"),
              "27: camera.distortion: a list: the picture of such a lens ends before the nearest side of the "
              "image: "
              "focal_px and the coefficients leave no direction for what is beyond");
}

TEST_F(RigCamera, EquidistantCameraInfo_IsCopiedWithItsLensWhenAnIntrinsicChanges) {
    const auto rig = rig_with_camera_info();
    folder_.write("cam/ros.yaml",
                  replaced(replaced(replaced(ros_text, "plumb_bob", "fisheye"), "cols: 5", "cols: 4"),
                           "-0.000139, 0.]", "-0.000139]"));
    RigEdit edit(rig);
    edit.set("camera.focal_px", 5000.0);
    edit.save(folder_ / "new.yaml");
    const CameraGeometry camera = load_rig(folder_ / "new.yaml").camera->geometry;
    EXPECT_EQ(camera.focal_px, 5000.0);
    EXPECT_EQ(camera.distortion.model, LensModel::equidistant);
    EXPECT_EQ(camera.distortion.k4, -0.000139);
}

TEST_F(RigCamera, ValuesThatCannotBe_AreRefused) {
    EXPECT_EQ(message_with("focal_ratio: 3"),
              "26: camera.focal_ratio: 3: must be a number of at least 0.5 and at most 2");
    EXPECT_EQ(message_with("distortion: [-0.2, 0.03, 1e-3, -2e-3]"),
              "26: camera.distortion: a list: must be a list of 5 numbers");
    EXPECT_EQ(message_with("distortion: [-30, 0, 0, 0, 0]"),
              "26: camera.distortion: a list: a lens of these coefficients would picture one point at two "
              "places of the image");
    EXPECT_EQ(message_with("tilt_rad: [0.6, 0]"),
              "26: camera.tilt_rad[0]: 0.6: must be a number in rad of at least -0.5 and at most 0.5");
    EXPECT_EQ(message_with("axis_rad: [0, 0.2]"),
              "26: camera.axis_rad[1]: 0.2: must be a number in rad of at least -0.1 and at most 0.1");
    EXPECT_EQ(message_with("gain_spread: -0.1"),
              "26: camera.gain_spread: -0.1: must be a number of at least 0 and at most 1");
}

TEST_F(RigCamera, CameraInfo_GivesTheIntrinsics) {
    const CameraGeometry camera = load_rig(rig_with_camera_info()).camera->geometry;
    EXPECT_EQ(camera.width_px, 1280);
    EXPECT_EQ(camera.focal_px, 5012.25);
    EXPECT_DOUBLE_EQ(camera.focal_px * camera.focal_ratio, 5002.5);
    EXPECT_EQ(camera.principal_point_px, Eigen::Vector2d(641.5, 470.25));
    EXPECT_EQ(camera.distortion.k2, 0.035);
    EXPECT_EQ(camera.distance_mm, 20.0);
}

TEST_F(RigCamera, CameraInfoBesideIntrinsics_IsRefused) {
    const auto file = rig_with("  focal_px: 5000\n", "  focal_px: 5000\n  camera_info: cam/ros.yaml\n");
    EXPECT_EQ(message_of([&] { load_rig(file); }).substr(file.string().size() + 1),
              "21: camera.width_px: 1280: must not be given beside camera_info, which says it");
}

TEST_F(RigCamera, EditedLists_ComeBack) {
    RigEdit edit(rig_with("  distance_mm: 20\n", "  distance_mm: 20\n  tilt_rad: [0.3, 0.2]\n"));
    edit.set("camera.distortion", std::vector<double>{-0.21, 0.03, 1e-4, -2e-4, 0.0});
    edit.set("camera.tilt_rad", std::vector<double>{0.05, -0.01});
    edit.set("camera.rotation_rad", 0.0123456789);
    edit.save(folder_ / "edited.yaml");
    const CameraGeometry camera = load_rig(folder_ / "edited.yaml").camera->geometry;
    EXPECT_EQ(camera.distortion.k1, -0.21);
    EXPECT_EQ(camera.distortion.p2, -2e-4);
    EXPECT_EQ(camera.tilt_rad, Eigen::Vector2d(0.05, -0.01));
    EXPECT_EQ(camera.rotation_rad, 0.0123456789);
}

TEST_F(RigCamera, EditOfARigWithCameraInfo_KeepsTheFileUntilAnIntrinsicIsSet) {
    const auto source = rig_with_camera_info();
    RigEdit place(source);
    place.set("camera.rotation_rad", 0.01);
    place.save(folder_ / "elsewhere" / "edited.yaml");
    EXPECT_NE(text_of(folder_ / "elsewhere" / "edited.yaml").find("camera_info: ../cam/ros.yaml"),
              std::string::npos);
    EXPECT_EQ(load_rig(folder_ / "elsewhere" / "edited.yaml").camera->geometry.focal_px, 5012.25);

    RigEdit intrinsics(source);
    intrinsics.set("camera.focal_px", 5020.0);
    intrinsics.save(folder_ / "intrinsics.yaml");
    const CameraGeometry camera = load_rig(folder_ / "intrinsics.yaml").camera->geometry;
    EXPECT_EQ(camera.focal_px, 5020.0);
    EXPECT_EQ(camera.distortion.k2, 0.035);
    EXPECT_EQ(camera.principal_point_px, Eigen::Vector2d(641.5, 470.25));
}

TEST_F(RigCamera, EveryNumberOfTheCamera_IdentifiesTheRig) {
    const Rig rig = load_rig(assets / "rig.yaml");
    const auto differs = [&](auto change) {
        Rig other = rig;
        change(*other.camera);
        return inspect::calibration_text(other) != inspect::calibration_text(rig);
    };
    EXPECT_FALSE(differs([](CameraParameters&) {}));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.focal_ratio = 1.001; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.distortion.k1 = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.distortion.k2 = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.distortion.p1 = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.distortion.p2 = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.distortion.k3 = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.rotation_rad = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.tilt_rad.y() = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.geometry.axis_rad.x() = 1e-6; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.gain_spread = 0.01; }));
    EXPECT_TRUE(differs([](CameraParameters& c) { c.exposure_s *= 2; }));
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Files of intrinsics and of calibration targets that other programs write.
#include "core/camera/lens.h"
#include "core/input_error.h"
#include "src/calibrate/camera_target.h"
#include "src/files/rig/camera_info.h"
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

CameraInfo info_of(const std::string& text) {
    const TemporaryFolder folder;
    return load_camera_info(folder.write("camera.yaml", text));
}

std::string refusal_of(const std::string& text) {
    return message_of([&] { info_of(text); });
}

/// ROS's file of a camera of 640 x 480 px, with its model and coefficients.
std::string ros_file(const std::string& model, const std::string& coefficients) {
    return "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n  "
           "cols: 3\n"
           "  data: [430.25, 0., 311.5, 0., 430.5, 221., 0., 0., 1.]\n" +
           model + "distortion_coefficients:\n" + coefficients;
}

void expect_lens(const CameraInfo& info, const std::vector<double>& numbers) {
    EXPECT_EQ(info.width_px, 640);
    EXPECT_EQ(info.height_px, 480);
    EXPECT_EQ(info.focal_px, Eigen::Vector2d(430.25, 430.5));
    EXPECT_EQ(info.principal_point_px, Eigen::Vector2d(311.5, 221.0));
    EXPECT_EQ(numbers_of(info.distortion), numbers);
}

TEST(CameraFiles, EmptyModelWithoutCoefficients_IsACameraWithoutDistortion) {
    for (const char* model : {"distortion_model: \"\"\n", "distortion_model:\n", "",
                              "distortion_model: plumb_bob\n", "distortion_model: none\n"})
        for (const char* none : {"  rows: 0\n  cols: 0\n  data: []\n", "  rows: 1\n  cols: 0\n  data: []\n",
                                 "  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n", "  rows: 0\n  cols: 0\n"})
            expect_lens(info_of(ros_file(model, none)), {0, 0, 0, 0, 0});
}

TEST(CameraFiles, FourCoefficients_HaveNoK3) {
    for (const char* form : {"  rows: 1\n  cols: 4\n", "  rows: 4\n  cols: 1\n"})
        expect_lens(info_of(ros_file("distortion_model: plumb_bob\n",
                                     form + std::string("  data: [-0.3, 0.1, 1e-3, 2e-3]\n"))),
                    {-0.3, 0.1, 1e-3, 2e-3, 0});
    expect_lens(info_of(ros_file("distortion_model: plumb_bob\n",
                                 "  rows: 1\n  cols: 8\n  data: [-0.3, 0.1, 1e-3, 2e-3, 0.5, 0, 0, 0]\n")),
                {-0.3, 0.1, 1e-3, 2e-3, 0.5});
}

TEST(CameraFiles, ModelsThatAreNotRead_AreNamed) {
    const std::string four = "  rows: 1\n  cols: 4\n  data: [-0.3, 0.1, 1e-3, 2e-3]\n";
    EXPECT_THAT(
        refusal_of(ros_file("distortion_model: rational_polynomial\n", four)),
        HasSubstr("distortion_model: rational_polynomial: this distortion model is not supported; allowed:"));
    EXPECT_THAT(refusal_of(ros_file("distortion_model: \"\"\n", four)),
                HasSubstr("no distortion model is named, but there are coefficients; allowed: plumb_bob"));
    EXPECT_THAT(refusal_of(ros_file("", "  rows: 1\n  cols: 8\n  data: [-0.3, 0.1, 0, 0, 0, 1, 0, 0]\n")),
                HasSubstr("has 8 coefficients, of which those behind the fifth are not 0"));
    EXPECT_THAT(refusal_of(ros_file("", "  rows: 1\n  cols: 3\n  data: [1, 0, 0]\n")),
                HasSubstr("has 3 coefficients; allowed: none"));
    EXPECT_THAT(refusal_of(ros_file("", "  rows: 2\n  cols: 2\n  data: [1, 0, 0, 0]\n")),
                HasSubstr("one row or one column"));
}

TEST(CameraFiles, EquidistantLens_IsReadAsEachProgramNamesIt) {
    const std::string four = "  rows: 4\n  cols: 1\n  data: [-0.03, 0.01, 1e-3, 2e-3]\n";
    const std::string pinhole =
        "camera_model: pinhole\nintrinsics: [430.25, 430.5, 311.5, 221.0]\nresolution: [640, 480]\n";
    for (const CameraInfo& info :
         {info_of(ros_file("distortion_model: equidistant\n", four)),
          info_of(ros_file("fisheye_model: 1\n", four)),
          info_of(pinhole +
                  "distortion_model: equidistant\ndistortion_coefficients: [-0.03, 0.01, 1e-3, 2e-3]\n")}) {
        EXPECT_EQ(info.distortion.model, LensModel::equidistant);
        EXPECT_EQ(numbers_of(info.distortion), (std::vector<double>{-0.03, 0.01, 1e-3, 2e-3}));
    }
    EXPECT_THAT(refusal_of(ros_file("fisheye_model: 1\n", "  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n")),
                HasSubstr("has 5 coefficients; allowed of an equidistant lens"));
}

TEST(CameraFiles, MatrixOfAnotherImage_IsRefused) {
    const std::string none = "  rows: 0\n  cols: 0\n  data: []\n";
    std::string small = ros_file("", none);
    small.replace(small.find("640"), 3, "310");
    EXPECT_THAT(refusal_of(small),
                HasSubstr("the principal point (311.5, 221) is outside the image of 310 x 480 px"));
    EXPECT_THAT(refusal_of(ros_file("binning_x: 2\n", none)),
                HasSubstr("binning_x: 2: the camera matrix is that of"));
    EXPECT_THAT(refusal_of(ros_file("roi: {x_offset: 0, y_offset: 16}\n", none)),
                HasSubstr("roi.y_offset: 16"));
}

TEST(CameraFiles, OpenCvsStorage_IsRead) {
    expect_lens(
        info_of("%YAML:1.0\n---\ncalibration_time: \"Mon 16 Mar 2020\"\nimage_width: 640\nimage_height: 480\n"
                "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                "   data: [ 4.3025e+02, 0., 3.115e+02, 0., 430.5, 221., 0., 0., 1. ]\n"
                "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                "   data: [ -3.0e-01, 0.1, 1.0e-03, 2.0e-03, 0. ]\navg_reprojection_error: 0.2\n"),
        {-0.3, 0.1, 1e-3, 2e-3, 0});
}

TEST(CameraFiles, KalibrsChain_IsReadIfItHasOneCamera) {
    const std::string camera =
        "  cam_overlaps: []\n  camera_model: pinhole\n  distortion_coeffs: [-0.3, 0.1, 0.001, 0.002]\n"
        "  distortion_model: radtan\n  intrinsics: [430.25, 430.5, 311.5, 221.0]\n  resolution: [640, 480]\n"
        "  rostopic: /cam0/image_raw\n";
    expect_lens(info_of("cam0:\n" + camera), {-0.3, 0.1, 1e-3, 2e-3, 0});
    EXPECT_THAT(refusal_of("cam0:\n" + camera + "cam1:\n" + camera),
                HasSubstr("there are several cameras, cam0, cam1"));
    const auto with = [&](const std::string& piece, const std::string& replacement) {
        std::string text = "cam0:\n" + camera;
        return refusal_of(text.replace(text.find(piece), piece.size(), replacement));
    };
    EXPECT_THAT(with("pinhole", "omni"),
                HasSubstr("cam0.camera_model: omni: this camera model is not supported; allowed: pinhole"));
    EXPECT_THAT(with("radtan", "fov"),
                HasSubstr("cam0.distortion_model: fov: this distortion model is not supported; allowed:"));
    EXPECT_THAT(with("[640, 480]", "[300, 480]"), HasSubstr("outside the image"));
}

TEST(CameraFiles, EuRoCsSensorAndRosMessages_AreRead) {
    expect_lens(
        info_of("sensor_type: camera\ncamera_model: pinhole\nintrinsics: [430.25, 430.5, 311.5, 221.0]\n"
                "distortion_model: radial-tangential\ndistortion_coefficients: [-0.3, 0.1, 0.001, 0.002]\n"
                "resolution: [640, 480]\nrate_hz: 20\n"),
        {-0.3, 0.1, 1e-3, 2e-3, 0});
    expect_lens(
        info_of(
            "header: {seq: 1}\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\n"
            "D: [-0.3, 0.1, 0.001, 0.002, 0]\nK: [430.25, 0, 311.5, 0, 430.5, 221, 0, 0, 1]\nbinning_x: 0\n"),
        {-0.3, 0.1, 1e-3, 2e-3, 0});
    expect_lens(info_of("height: 480\nwidth: 640\ndistortion_model: ''\nd: []\nk: [430.25, 0, 311.5, 0, "
                        "430.5, 221, 0, 0, 1]\n"),
                {0, 0, 0, 0, 0});
}

TEST(CameraFiles, FileOfAnotherKind_IsNamedAsThat) {
    EXPECT_THAT(
        refusal_of("%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n"),
        HasSubstr("camera.yaml: has none of the keys that a file of intrinsics has; allowed: camera_matrix"));
}

TEST(CameraFiles, MarkAndLineEnds_ArePassedOver) {
    std::string text = ros_file("distortion_model: plumb_bob\n", "  rows: 0\n  cols: 0\n  data: []\n");
    expect_lens(info_of("\xEF\xBB\xBF" + text), {0, 0, 0, 0, 0});
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
        text.replace(at, 1, "\r\n");
    expect_lens(info_of(text), {0, 0, 0, 0, 0});
}

// --- Targets

std::string target_refusal(const std::string& text) {
    const TemporaryFolder folder;
    return message_of([&] { load_kalibr_target(folder.write("target.yaml", text)); });
}

TEST(CameraTargetFile, TypeIsLookedAtBeforeTheKeys) {
    EXPECT_THAT(
        target_refusal("target_type: 'checkerboard'\ntargetCols: 6\ntargetRows: 7\nrowSpacingMeters: 0.06\n"
                       "colSpacingMeters: 0.06\n"),
        HasSubstr("target.yaml:1: target_type: checkerboard: allowed: aprilgrid"));
    EXPECT_THAT(target_refusal("targetCols: 6\ntargetRows: 7\nspacingMeters: 0.02\nasymmetricGrid: "
                               "False\ntarget_type: 'circlegrid'\n"),
                HasSubstr("target_type: circlegrid: allowed: aprilgrid"));
    EXPECT_THAT(target_refusal("%YAML:1.0\n---\nboard_width: 9\nboard_height: 6\nsquare_size: 0.02\n"),
                HasSubstr("target.yaml: target_type: missing: a target file of kalibr is needed; allowed: "
                          "target_type: aprilgrid"));
    EXPECT_THAT(target_refusal("target_typ: aprilgrid\ntagCols: 6\n"),
                HasSubstr("target_typ: aprilgrid: unknown key; did you mean target_type?"));
    EXPECT_THAT(target_refusal("target_type: aprilgrid\ntagCol: 6\ntagRows: 6\n"),
                HasSubstr("tagCol: 6: unknown key; did you mean tagCols?"));
    EXPECT_THAT(target_refusal(
                    "target_type: aprilgrid\ntargetCols: 6\ntargetRows: 7\nrowSpacing: 1\ncolSpacing: 1\n"),
                HasSubstr("unknown key; allowed here: target_type, tagCols"));
}

// --- Many at random

struct DrawnCamera {
    std::string text;
    std::vector<double> lens = std::vector<double>(5);
    double focal_px = 0.0;
    bool must_be_refused = false;
};

DrawnCamera draw_camera(std::mt19937_64& random) {
    const auto pick = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const auto chance = [&](double share) { return std::bernoulli_distribution(share)(random); };
    DrawnCamera drawn;
    drawn.focal_px = between(300, 3000);
    const int width = pick(16, 4000), height = pick(16, 4000);
    const bool outside = chance(0.1);
    const double cx = outside ? width + 1.0 : between(0, width - 1), cy = between(0, height - 1);
    constexpr std::array counts{0, 4, 5, 8, 3};
    const int count = counts[static_cast<std::size_t>(pick(0, 4))];
    std::vector<double> numbers;
    for (int k = 0; k < count; ++k) numbers.push_back(k < 5 || chance(0.5) ? between(-0.1, 0.1) : 0.0);
    for (std::size_t k = 0; k < std::min<std::size_t>(5, numbers.size()); ++k) drawn.lens[k] = numbers[k];
    const bool beyond = numbers.size() > 5 && (numbers[5] != 0.0 || numbers[6] != 0.0 || numbers[7] != 0.0);
    const int format = pick(0, 4);
    constexpr std::array<const char*, 5> brown{"plumb_bob", "plumb_bob", "plumb_bob", "radtan",
                                               "radial-tangential"};
    constexpr std::array<const char*, 6> others{
        "rational_polynomial", "thin_prism", "fov", "", "none", "unknown"};
    const bool is_brown = chance(0.7);
    const std::string model =
        is_brown ? brown[static_cast<std::size_t>(format)] : others[static_cast<std::size_t>(pick(0, 5))];
    const bool is_ideal = model.empty() || model == "none";
    drawn.must_be_refused = outside || beyond || count == 3 || (!is_brown && !(is_ideal && count == 0));
    const std::string k =
        fmt::format("[{}, 0, {}, 0, {}, {}, 0., 0, 1.]", drawn.focal_px, cx, drawn.focal_px, cy);
    const std::string d = fmt::format("[{}]", fmt::join(numbers, ", "));
    const bool as_column = chance(0.5);
    if (format <= 1) {
        const char* tag = format == 1 ? " !!opencv-matrix" : "";
        drawn.text = fmt::format(
            "{}image_width: {}\nimage_height: {}\ncamera_matrix:{}\n  rows: 3\n  cols: 3\n  data: {}\n"
            "distortion_model: '{}'\ndistortion_coefficients:{}\n  rows: {}\n  cols: {}\n  data: {}\n",
            format == 1 ? "%YAML:1.0\n---\n" : "", width, height, tag, k, model, tag, as_column ? count : 1,
            as_column ? 1 : count, d);
    } else if (format == 2) {
        drawn.text = fmt::format("height: {}\nwidth: {}\ndistortion_model: '{}'\n{}: {}\n{}: {}\n", height,
                                 width, model, as_column ? "d" : "D", d, as_column ? "k" : "K", k);
    } else {
        const std::string indent = format == 3 ? "  " : "";
        drawn.text = fmt::format(
            "{0}{1}camera_model: pinhole\n{1}intrinsics: [{2}, {2}, {3}, {4}]\n{1}resolution: [{5}, {6}]\n"
            "{1}distortion_model: '{7}'\n{1}{8}: {9}\n",
            format == 3 ? "cam0:\n" : "", indent, drawn.focal_px, cx, cy, width, height, model,
            format == 3 ? "distortion_coeffs" : "distortion_coefficients", d);
    }
    if (format != 1 && chance(0.2)) drawn.text = "\xEF\xBB\xBF" + drawn.text;
    return drawn;
}

TEST(CameraFileVariations, OtherPeoplesFiles_AreReadRightOrRefused) {
    const TemporaryFolder folder;
    expect_right_or_refused("files of intrinsics", 200, [&](std::mt19937_64& random) {
        const DrawnCamera drawn = draw_camera(random);
        try {
            const CameraInfo info = load_camera_info(folder.write("camera.yaml", drawn.text));
            if (drawn.must_be_refused) return Outcome::wrong("was read:\n" + drawn.text);
            const bool is_right =
                numbers_of(info.distortion) == drawn.lens && info.focal_px.x() == drawn.focal_px;
            return is_right ? Outcome::right() : Outcome::wrong(drawn.text);
        } catch (const InputError& error) {
            return Outcome::refused(error.what());
        }
    });
}

TEST(CameraFileVariations, OtherPeoplesTargets_AreReadRightOrRefused) {
    const TemporaryFolder folder;
    expect_right_or_refused("target files", 200, [&](std::mt19937_64& random) {
        const auto pick = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
        constexpr std::array<const char*, 5> types{"aprilgrid", "'aprilgrid'", "checkerboard", "circlegrid",
                                                   "AprilGrid"};
        const int type = pick(0, 4), columns = pick(1, 8), rows = pick(1, 8), first_id = pick(0, 20);
        const double size_m = pick(1, 200) * 1e-3, spacing = pick(1, 9) * 0.1;
        std::vector<std::string> lines{fmt::format("target_type: {}", types[static_cast<std::size_t>(type)]),
                                       fmt::format("{}: {}", type < 2 ? "tagCols" : "targetCols", columns),
                                       fmt::format("{}: {}", type < 2 ? "tagRows" : "targetRows", rows),
                                       fmt::format("tagSize: {:.3f}", size_m),
                                       fmt::format("tagSpacing: {:.1f}", spacing),
                                       fmt::format("codeOffset: {}", first_id)};
        const bool lacks_key = pick(0, 4) == 0;
        if (lacks_key) lines.erase(lines.begin() + pick(0, 4));
        std::shuffle(lines.begin(), lines.end(), random);
        const auto file = folder.write(
            "target.yaml", (pick(0, 3) == 0 ? "\xEF\xBB\xBF" : "") +
                               fmt::format("{}", fmt::join(lines, pick(0, 1) == 0 ? "\n" : "\r\n")));
        try {
            const CameraTarget target = load_kalibr_target(file);
            if (type > 1 || lacks_key) return Outcome::wrong("was read: " + testing::text_of(file));
            const bool is_right = target.tags.size() == static_cast<std::size_t>(columns * rows) &&
                                  target.tags.front().id == first_id &&
                                  std::abs(target.tags.front().side_mm - 1000.0 * size_m) < 1e-9;
            return is_right ? Outcome::right() : Outcome::wrong(testing::text_of(file));
        } catch (const InputError& error) {
            const std::string line = error.what();
            if (type > 1 && line.find("did you mean tag") != std::string::npos) return Outcome::wrong(line);
            return Outcome::refused(line);
        }
    });
}

}  // namespace
}  // namespace fidservo

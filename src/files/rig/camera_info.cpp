// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/camera_info.h"

#include "core/camera/lens.h"
#include "core/input_error.h"
#include "src/files/rig/rig_camera.h"
#include "src/files/text/yaml_reader.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {
namespace {

constexpr int most_rows = 99;

void demand_size(const YamlValue& map, const char* key, int size) {
    const YamlValue value = map.at(key);
    if (value.integer(0, most_rows) != size) value.fail(fmt::format("must be {}", size));
}

/// The numbers of a matrix, row by row.
std::vector<double> matrix_of(const YamlValue& map, int rows, int columns) {
    demand_size(map, "rows", rows);
    demand_size(map, "cols", columns);
    return map.at("data").numbers(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
}

void check_matrix(const YamlValue& root, const char* key, int rows, int columns) {
    if (const auto matrix = root.find(key)) matrix_of(*matrix, rows, columns);
}

/// The numbers of a matrix of one row or one column, or of none.
std::vector<double> row_or_column(const YamlValue& map) {
    const YamlValue rows = map.at("rows"), columns = map.at("cols");
    const int count = rows.integer(0, most_rows) * columns.integer(0, most_rows);
    if (count > 0 && rows.integer(0, most_rows) > 1 && columns.integer(0, most_rows) > 1)
        rows.fail("there must be one row or one column of coefficients");
    const auto data = map.find("data");
    if (count == 0 && (!data || !data->is_list())) return {};
    return map.at("data").numbers(static_cast<std::size_t>(count));
}

std::vector<double> numbers_in(const YamlValue& list) {
    std::vector<double> numbers;
    for (const YamlValue& item : list.items()) numbers.push_back(item.number());
    return numbers;
}

void check_camera_matrix(const YamlValue& data, const std::vector<double>& k) {
    if (!(k[0] > 0.0) || !(k[4] > 0.0)) data.fail("f_x and f_y, the 1st and 5th number, must be above 0");
    if (k[1] != 0.0 || k[3] != 0.0) data.fail("skew is not supported: the 2nd and 4th number must be 0");
    if (k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) data.fail("the last row must be 0, 0, 1");
}

/// Intrinsics of another resolution than the file's image have their principal point elsewhere.
void check_place_in_image(const YamlValue& value, const CameraInfo& info) {
    const Eigen::Vector2d& point = info.principal_point_px;
    if (!(point.x() >= 0.0) || !(point.y() >= 0.0) || !(point.x() < info.width_px) ||
        !(point.y() < info.height_px))
        value.fail(fmt::format("the principal point ({:g}, {:g}) is outside the image of {} x {} px",
                               point.x(), point.y(), info.width_px, info.height_px));
    check_focal_ratio(value, info.focal_px.y() / info.focal_px.x());
    check_focal_length(value, info.focal_px.x(), std::max(info.width_px, info.height_px));
}

/// How a program calls models.
struct ModelNames {
    std::string_view brown;  ///< Brown's model
    bool is_default;         ///< where none is named
};

constexpr ModelNames ros_names{"plumb_bob", true}, kalibr_names{"radtan", false},
    euroc_names{"radial-tangential", false};

/// The model that a file names: nothing of a camera without distortion, whose name is empty or `none`.
/// OpenCV and some drivers call equidistant "fisheye".
std::optional<LensModel> model_of(const std::optional<YamlValue>& model, const ModelNames& names) {
    if (!model) return names.is_default ? std::optional(LensModel::plumb_bob) : std::nullopt;
    const std::string name = model->is_map() || model->is_list() ? "?" : model->text_or_empty();
    if (name.empty() || name == "none") return std::nullopt;
    if (name == "equidistant" || name == "fisheye") return LensModel::equidistant;
    if (name != names.brown)
        model->fail(fmt::format(
            "this distortion model is not supported; allowed: {}, equidistant (or fisheye)", names.brown));
    return LensModel::plumb_bob;
}

/// Brown's coefficients k1, k2, p1, p2 and perhaps k3, in OpenCV's order; more only where they are 0.
LensDistortion brown_of(const std::vector<double>& numbers, const YamlValue& value) {
    constexpr std::size_t read = 5, without_k3 = 4;
    if (!numbers.empty() && numbers.size() < without_k3)
        value.fail(fmt::format("has {} coefficients; allowed: none, k1, k2, p1, p2, or these and k3",
                               numbers.size()));
    for (std::size_t k = read; k < numbers.size(); ++k)
        if (numbers[k] != 0.0)
            value.fail(fmt::format(
                "has {} coefficients, of which those behind the fifth are not 0; allowed: k1, k2, p1, "
                "p2, k3",
                numbers.size()));
    std::vector<double> five(read);
    std::copy_n(numbers.begin(), std::min(read, numbers.size()), five.begin());
    return distortion_of(LensModel::plumb_bob, five);
}

LensDistortion equidistant_of(const std::vector<double>& numbers, const YamlValue& value) {
    if (numbers.size() != coefficients_of(LensModel::equidistant))
        value.fail(fmt::format("has {} coefficients; allowed of an equidistant lens: k1, k2, k3, k4",
                               numbers.size()));
    return distortion_of(LensModel::equidistant, numbers);
}

LensDistortion read_lens_of(const std::optional<YamlValue>& named, const ModelNames& names,
                            const std::vector<double>& numbers, const YamlValue& value) {
    const std::optional<LensModel> model = model_of(named, names);
    if (model == LensModel::equidistant) return equidistant_of(numbers, value);
    const LensDistortion lens = brown_of(numbers, value);
    if (!model && !lens.is_none())
        (named ? *named : value)
            .fail(fmt::format(
                "no distortion model is named, but there are coefficients; allowed: {}, equidistant",
                names.brown));
    return lens;
}

/// A matrix of the whole image is not that of a part, or of pixels put together.
void check_whole_image(const YamlValue& root, const CameraInfo& info) {
    for (const char* key : {"binning_x", "binning_y"})
        if (const auto binning = root.find(key); binning && binning->integer(0, most_image_px) > 1)
            binning->fail("the camera matrix is that of the image without binning; allowed: 0, 1");
    const auto part = root.find("roi");
    if (!part || !part->is_map()) return;
    for (const auto& [key, whole] : {std::pair{"x_offset", 0}, std::pair{"y_offset", 0},
                                     std::pair{"width", info.width_px}, std::pair{"height", info.height_px}})
        if (const auto value = part->find(key))
            if (const int given = value->integer(0, most_image_px); given != 0 && given != whole)
                value->fail("the camera matrix is that of the whole image; allowed: 0");
}

CameraInfo with_matrix(const YamlValue& root, const YamlValue& data, const std::vector<double>& k,
                       const char* width, const char* height) {
    check_camera_matrix(data, k);
    const auto name = root.find("camera_name");
    CameraInfo info{.camera_name = name ? name->text() : "unknown",
                    .width_px = root.at(width).integer(least_image_px, most_image_px),
                    .height_px = root.at(height).integer(least_image_px, most_image_px),
                    .focal_px = {k[0], k[4]},
                    .principal_point_px = {k[2], k[5]},
                    .distortion = {}};
    check_place_in_image(data, info);
    check_whole_image(root, info);
    return info;
}

/// ROS's YAML of camera_calibration, and OpenCV's of its sample programs.
CameraInfo read_ros_file(const YamlValue& root) {
    const YamlValue coefficients = root.at("distortion_coefficients");
    const auto model = root.find("distortion_model");
    (void)model_of(model, ros_names);
    const YamlValue matrix = root.at("camera_matrix");
    CameraInfo info =
        with_matrix(root, matrix.at("data"), matrix_of(matrix, 3, 3), "image_width", "image_height");
    check_matrix(root, "rectification_matrix", 3, 3);
    check_matrix(root, "projection_matrix", 3, 4);
    const std::vector<double> numbers = row_or_column(coefficients);
    const YamlValue data = coefficients.find("data").value_or(coefficients);
    const auto fisheye = root.find("fisheye_model");
    info.distortion = fisheye && fisheye->integer(0, 1) == 1 ? equidistant_of(numbers, data)
                                                             : read_lens_of(model, ros_names, numbers, data);
    return info;
}

/// ROS's message sensor_msgs/CameraInfo as text; ROS 2 writes its keys in small letters.
CameraInfo read_ros_message(const YamlValue& root) {
    const bool is_ros_2 = root.find("k").has_value();
    const auto model = root.find("distortion_model");
    (void)model_of(model, ros_names);
    const YamlValue k = root.at(is_ros_2 ? "k" : "K"), d = root.at(is_ros_2 ? "d" : "D");
    CameraInfo info = with_matrix(root, k, k.numbers(9), "width", "height");
    info.distortion = read_lens_of(model, ros_names, numbers_in(d), d);
    return info;
}

/// kalibr's and EuRoC's: intrinsics f_u, f_v, c_u, c_v.
CameraInfo read_pinhole(const YamlValue& camera, const std::string& name, const ModelNames& names,
                        const char* coefficients) {
    if (const YamlValue model = camera.at("camera_model"); model.text_or_empty() != "pinhole")
        model.fail("this camera model is not supported; allowed: pinhole");
    const auto model = camera.find("distortion_model");
    (void)model_of(model, names);
    const YamlValue intrinsics = camera.at("intrinsics");
    const std::vector<double> numbers = intrinsics.numbers(4);
    if (!(numbers[0] > 0.0) || !(numbers[1] > 0.0))
        intrinsics.fail("f_u and f_v, the 1st and 2nd number, must be above 0");
    const YamlValue resolution = camera.at("resolution");
    resolution.numbers(2);
    CameraInfo info{.camera_name = name,
                    .width_px = resolution.items()[0].integer(least_image_px, most_image_px),
                    .height_px = resolution.items()[1].integer(least_image_px, most_image_px),
                    .focal_px = {numbers[0], numbers[1]},
                    .principal_point_px = {numbers[2], numbers[3]},
                    .distortion = {}};
    check_place_in_image(intrinsics, info);
    const auto list = camera.find(coefficients);
    if (!list && model_of(model, names)) (void)camera.at(coefficients);
    if (list) info.distortion = read_lens_of(model, names, numbers_in(*list), *list);
    return info;
}

/// The cameras of a kalibr camchain: cam0, cam1, ...
std::vector<std::string> cameras_of_chain(const YamlValue& root) {
    std::vector<std::string> cameras;
    for (const std::string& key : root.keys())
        if (key.starts_with("cam") && key.size() > 3 &&
            key.find_first_not_of("0123456789", 3) == std::string::npos)
            cameras.push_back(key);
    return cameras;
}

std::string matrix_text(const char* name, int rows, int columns, const std::vector<double>& data) {
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", name, rows, columns,
                       fmt::join(data, ", "));
}

}  // namespace

CameraInfo camera_info_of(const CameraGeometry& camera, const std::string& camera_name) {
    return {.camera_name = camera_name,
            .width_px = camera.width_px,
            .height_px = camera.height_px,
            .focal_px = {camera.focal_px, camera.focal_px * camera.focal_ratio},
            .principal_point_px = camera.principal_point_px,
            .distortion = camera.distortion};
}

CameraGeometry with_intrinsics(CameraGeometry camera, const CameraInfo& info) {
    camera.width_px = info.width_px;
    camera.height_px = info.height_px;
    camera.focal_px = info.focal_px.x();
    camera.focal_ratio = info.focal_px.y() / info.focal_px.x();
    camera.principal_point_px = info.principal_point_px;
    camera.distortion = info.distortion;
    return camera;
}

CameraInfo load_camera_info(const std::filesystem::path& file) {
    const YamlValue root = YamlValue::load(file);
    const std::vector<std::string> chain = cameras_of_chain(root);
    if (chain.size() > 1)
        root.at(chain[1]).fail(fmt::format("there are several cameras, {}; leave the one that is meant",
                                           fmt::join(chain, ", ")));
    if (chain.size() == 1)
        return read_pinhole(root.at(chain[0]), chain[0], kalibr_names, "distortion_coeffs");
    if (root.find("intrinsics")) return read_pinhole(root, "unknown", euroc_names, "distortion_coefficients");
    const bool is_message = !root.find("camera_matrix") && (root.find("K") || root.find("k"));
    if (!is_message && !root.find("camera_matrix"))
        throw InputError(fmt::format(
            "{}: has none of the keys that a file of intrinsics has; allowed: camera_matrix (ROS, OpenCV), "
            "K (ROS's message), cam0 (kalibr), intrinsics (EuRoC)",
            file.string()));
    return is_message ? read_ros_message(root) : read_ros_file(root);
}

std::string camera_info_text(const CameraInfo& info) {
    const double fx = info.focal_px.x(), fy = info.focal_px.y();
    const double cx = info.principal_point_px.x(), cy = info.principal_point_px.y();
    const std::vector<double> lens = numbers_of(info.distortion);
    YAML::Emitter name;  // quoted where it must be
    name << info.camera_name;
    return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", info.width_px, info.height_px,
                       name.c_str()) +
           matrix_text("camera_matrix", 3, 3, {fx, 0, cx, 0, fy, cy, 0, 0, 1}) +
           fmt::format("distortion_model: {}\n", name_of(info.distortion.model)) +
           matrix_text("distortion_coefficients", 1, static_cast<int>(lens.size()), lens) +
           matrix_text("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
           matrix_text("projection_matrix", 3, 4, {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0});
}

}  // namespace fidservo

#include "src/config/camera_info.h"

#include "src/config/rig_camera.h"
#include "src/config/yaml_reader.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {
namespace {

/// The numbers of a matrix, row by row.
std::vector<double> matrix_of(const YamlValue& map, std::size_t rows, std::size_t columns) {
    const auto demand = [&](const char* key, std::size_t size) {
        const YamlValue value = map.at(key);
        if (value.integer(1, 99) != static_cast<int>(size)) value.fail(fmt::format("must be {}", size));
    };
    demand("rows", rows);
    demand("cols", columns);
    return map.at("data").numbers(rows * columns);
}

void check_matrix(const YamlValue& root, const char* key, std::size_t rows, std::size_t columns) {
    if (const auto matrix = root.find(key)) matrix_of(*matrix, rows, columns);
}

void check_camera_matrix(const YamlValue& data) {
    const std::vector<double> k = data.numbers(9);
    if (!(k[0] > 0.0) || !(k[4] > 0.0)) data.fail("f_x and f_y, the 1st and 5th number, must be above 0");
    if (k[1] != 0.0 || k[3] != 0.0) data.fail("skew is not supported: the 2nd and 4th number must be 0");
    if (k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) data.fail("the last row must be 0, 0, 1");
}

/// Without a name it is ROS's default, plumb_bob; OpenCV and some drivers call equidistant "fisheye".
LensModel read_model(const YamlValue& root) {
    const auto name = root.find("distortion_model");
    if (!name) return LensModel::plumb_bob;
    const std::string text = name->is_scalar() ? name->text() : "";
    if (text == "equidistant" || text == "fisheye") return LensModel::equidistant;
    if (text != "plumb_bob")
        name->fail("this distortion model is not supported; allowed: plumb_bob, equidistant (or fisheye)");
    return LensModel::plumb_bob;
}

LensDistortion read_distortion(LensModel model, const YamlValue& map) {
    return distortion_of(model, matrix_of(map, 1, coefficients_of(model)));
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
    const LensModel model = read_model(root);
    const YamlValue matrix = root.at("camera_matrix");
    const std::vector<double> k = matrix_of(matrix, 3, 3);
    check_camera_matrix(matrix.at("data"));
    check_matrix(root, "rectification_matrix", 3, 3);
    check_matrix(root, "projection_matrix", 3, 4);
    const auto name = root.find("camera_name");
    const CameraInfo info{.camera_name = name ? name->text() : "unknown",
                          .width_px = root.at("image_width").integer(least_image_px, most_image_px),
                          .height_px = root.at("image_height").integer(least_image_px, most_image_px),
                          .focal_px = {k[0], k[4]},
                          .principal_point_px = {k[2], k[5]},
                          .distortion = read_distortion(model, root.at("distortion_coefficients"))};
    check_focal_ratio(matrix.at("data"), k[4] / k[0]);
    return info;
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

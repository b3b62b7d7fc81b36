// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/row_format.h"

#include "core/camera/camera_parameters.h"
#include "src/files/recording/layout.h"
#include "src/files/text/plain_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include <fmt/compile.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
    return fmt::format("{}", value);
}

/// Half of the last decimal's step: what is smaller is written as zero, which has no sign.
constexpr std::array zero_below{0.5, 0.5e-1, 0.5e-2, 0.5e-3, 0.5e-4, 0.5e-5, 0.5e-6, 0.5e-7};

void append_number(std::string& text, double value, int decimals) {
    text += ',';
    if (std::isnan(value)) return;
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:.{}f}"),
                   std::abs(value) < zero_below[static_cast<std::size_t>(decimals)] ? 0.0 : value, decimals);
}

/// A term of a covariance.
void append_term(std::string& text, double value) {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE(",{:.4g}"), value);
}

/// What is read of one number that was written after a comma; one that is not in force stays so.
double read_back(std::string_view text, double unread) {
    text.remove_prefix(1);
    (void)parse_all(text, unread);
    return unread;
}

double rounded_to(double value, int decimals) {
    std::string text;
    append_number(text, value, decimals);
    return read_back(text, value);
}

double rounded_term(double value) {
    std::string text;
    append_term(text, value);
    return read_back(text, value);
}

}  // namespace

std::string stage_header(const StageColumns& columns) {
    std::string text = fmt::format("#{}", time_title);
    for (const StageColumn& column : stage_columns)
        if (columns.*column.present) text += fmt::format(",{}", column.title);
    return text + '\n';
}

std::string detections_header(CornerColumns columns) {
    return fmt::format("#{},tag_id,{}\n", time_title, corners_header(columns));
}

std::string corners_header(CornerColumns columns) {
    std::string titles = fmt::format("{}", fmt::join(corner_titles, ","));
    if (columns == CornerColumns::places_and_covariances)
        titles += fmt::format(",{},{}", refined_title, fmt::join(covariance_titles, ","));
    return titles;
}

std::string frames_header() {
    return fmt::format("#{},filename\n", time_title);
}

void append_row(std::string& text, const StageRow& row, const StageColumns& columns) {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), row.time_ns);
    for (const StageColumn& column : stage_columns)
        if (columns.*column.present) append_number(text, row.*column.value, column.decimals);
    text += '\n';
}

void append_corners(std::string& text, const TagDetection& detection, CornerColumns columns) {
    for (const Eigen::Vector2d& corner : detection.corners_px)
        for (const double coordinate : {corner.x(), corner.y()})
            append_number(text, coordinate, corner_decimals);
    if (columns == CornerColumns::places) return;
    text += detection.is_refined ? (*detection.is_refined ? ",1" : ",0") : ",";
    if (detection.covariances_px2)
        for (const Eigen::Matrix2d& corner : *detection.covariances_px2)
            for (const double term : {corner(0, 0), corner(0, 1), corner(1, 1)}) append_term(text, term);
    else
        text.append(covariance_titles.size(), ',');
}

void append_detection(std::string& text, const TagDetection& detection, CornerColumns columns) {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{}"), detection.time_ns, detection.tag_id);
    append_corners(text, detection, columns);
    text += '\n';
}

void append_frame(std::string& text, const FrameName& frame) {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{}\n"), frame.time_ns, frame.filename);
}

void round_as_written(Recording& recording) {
    for (const StageColumn& column : stage_columns)
        for (StageRow& row : recording.rows)
            row.*column.value = rounded_to(row.*column.value, column.decimals);
    for (TagDetection& tag : recording.detections) {
        for (Eigen::Vector2d& corner : tag.corners_px)
            for (double& coordinate : corner) coordinate = rounded_to(coordinate, corner_decimals);
        if (!tag.covariances_px2) continue;
        for (Eigen::Matrix2d& corner : *tag.covariances_px2) {
            const double xy = rounded_term(corner(0, 1));
            corner << rounded_term(corner(0, 0)), xy, xy, rounded_term(corner(1, 1));
        }
    }
}

std::string sensor_yaml(const CameraParameters& camera) {
    const CameraGeometry& geometry = camera.geometry;
    std::vector<double> lens = numbers_of(geometry.distortion);
    const bool is_plumb_bob = geometry.distortion.model == LensModel::plumb_bob;
    if (is_plumb_bob && lens.back() == 0.0) lens.pop_back();  // EuRoC has four; a fifth is k3
    std::vector<std::string> coefficients;
    std::ranges::transform(lens, std::back_inserter(coefficients), shortest);
    return fmt::format(
        "sensor_type: camera\nrate_hz: {}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
        "intrinsics: [{}, {}, {}, {}]  # fu, fv, cu, cv in px; pixel centres at integers\n"
        "distortion_model: {}\ndistortion_coefficients: [{}]\n",
        shortest(camera.frame_rate_hz), geometry.width_px, geometry.height_px, shortest(geometry.focal_px),
        shortest(geometry.focal_px * geometry.focal_ratio), shortest(geometry.principal_point_px.x()),
        shortest(geometry.principal_point_px.y()), is_plumb_bob ? "radial-tangential" : "equidistant",
        fmt::join(coefficients, ", "));
}

}  // namespace fidservo

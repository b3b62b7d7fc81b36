// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/camera_target.h"

#include "core/fiducial_parameters.h"
#include "core/input_error.h"
#include "src/files/rig/plate_file.h"
#include "src/files/text/key_names.h"
#include "src/files/text/yaml_reader.h"

#include <charconv>

#include <fmt/format.h>

namespace fidservo {

namespace {

const int code_book = usual_tag_family().size();
constexpr int most_a_side = 100;

/// A file of another kind is named as that before its keys are looked at.
void demand_april_grid(const YamlValue& root) {
    constexpr std::string_view key = "target_type";
    const auto type = root.find(key);
    if (type && type->is_scalar() && type->text_or_empty() == "aprilgrid") return;
    if (type) type->fail("allowed: aprilgrid");
    for (const std::string& given : root.keys())
        if (nearest_word(given, {key}) == key)
            root.at(given).fail(fmt::format("unknown key; did you mean {}?", key));
    throw InputError(
        fmt::format("{}: {}: missing: a target file of kalibr is needed; allowed: {}: aprilgrid, with "
                    "tagCols, tagRows, tagSize, tagSpacing",
                    root.source().string(), key, key));
}

}  // namespace

CameraTarget april_grid(int columns, int rows, double tag_size_mm, double spacing) {
    const double pitch_mm = tag_size_mm * (1.0 + spacing);
    CameraTarget target{
        {},
        fmt::format("AprilGrid of {} x {} tags, {:g} mm, at {:g} mm", columns, rows, tag_size_mm, pitch_mm),
        false};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            target.tags.push_back({.id = row * columns + column,
                                   .centre_mm = {pitch_mm * column, -pitch_mm * row},
                                   .side_mm = tag_size_mm,
                                   .print = {.border_cells = 2}});
    return target;
}

CameraTarget april_grid(const std::string& grid, double tag_size_mm, double spacing) {
    int columns = 0, rows = 0;
    const char* const end = grid.data() + grid.size();
    const auto first = std::from_chars(grid.data(), end, columns);
    const bool has_x = first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x';
    const auto second = has_x ? std::from_chars(first.ptr + 1, end, rows) : first;
    if (!has_x || second.ec != std::errc{} || second.ptr != end || columns < 1 || rows < 1 ||
        columns > most_a_side || rows > most_a_side || columns * rows > code_book)
        throw InputError(
            fmt::format("--grid: {}: must be COLUMNSxROWS, e.g. 6x6, of {} tags at most", grid, code_book));
    if (!(tag_size_mm > 0.0))
        throw InputError("--tag-size-mm: missing or not above 0: the side of a tag's black square, mm");
    if (!(spacing > 0.0))
        throw InputError(
            "--tag-spacing: missing or not above 0: the gap between tags as a share of their side");
    return april_grid(columns, rows, tag_size_mm, spacing);
}

CameraTarget load_kalibr_target(const std::filesystem::path& file) {
    constexpr double mm_per_m = 1000.0;
    const YamlValue root = YamlValue::load(file);
    demand_april_grid(root);
    root.allow_only({"target_type", "tagCols", "tagRows", "tagSize", "tagSpacing", "codeOffset"});
    const int columns = root.at("tagCols").integer(1, most_a_side);
    const int rows = root.at("tagRows").integer(1, most_a_side);
    if (columns * rows > code_book)
        root.at("tagRows").fail(fmt::format("the code book has {} tags", code_book));
    const int first_id =
        root.find("codeOffset") ? root.at("codeOffset").integer(0, code_book - columns * rows) : 0;
    CameraTarget target = april_grid(columns, rows, mm_per_m * root.at("tagSize").number(positive),
                                     root.at("tagSpacing").number(positive));
    for (PlateTag& tag : target.tags) tag.id += first_id;
    return target;
}

CameraTarget plate_target(const FiducialParameters& fiducials) {
    return {
        plate_of(fiducials).tags,
        fmt::format("plate of {} x {} tags, {:g} mm", fiducials.columns, fiducials.rows, fiducials.side_mm),
        true};
}

}  // namespace fidservo

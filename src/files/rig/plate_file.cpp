// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/plate_file.h"

#include "core/fiducial_parameters.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "core/units.h"
#include "src/files/rig/tag_print_keys.h"
#include "src/files/text/yaml_reader.h"

#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr NumberRange reflectance_range{0.0, 1.0};

Eigen::Vector2d read_point_mm(const YamlValue& value) {
    const std::vector<double> xy = value.numbers(2);
    return {xy[0], xy[1]};
}

/// A length given as NAME_um or NAME_mm; exactly one of them.
double read_length_mm(const YamlValue& map, const std::string& name) {
    const auto um = map.find(name + "_um");
    const auto mm = map.find(name + "_mm");
    if (um && mm) mm->fail(fmt::format("{0}_um is given too; give one of them", name));
    return um ? mm_from_um(um->number(positive)) : map.at(name + "_mm").number(positive);
}

double read_angle_rad(const YamlValue& map) {
    const auto angle = map.find("angle_deg");
    return angle ? angle->number({-360.0, 360.0}) * std::numbers::pi / 180.0 : 0.0;
}

PlateTag read_tag(const YamlValue& map, std::optional<double> usual_side_mm, const TagPrint& print) {
    map.allow_only({"id", "centre_mm", "side_mm", "angle_deg"});
    const auto side = map.find("side_mm");
    return {.id = read_tag_id(map.at("id"), print),
            .centre_mm = read_point_mm(map.at("centre_mm")),
            .side_mm = !side && usual_side_mm ? *usual_side_mm : map.at("side_mm").number(positive),
            .angle_rad = read_angle_rad(map),
            .print = print};
}

std::vector<PlateTag> read_grid(const YamlValue& map, const TagPrint& print) {
    map.allow_only({"columns", "rows", "pitch_mm", "first_id", "origin_mm", "side_mm"});
    const std::vector<double> pitch = map.at("pitch_mm").numbers(2, not_negative);
    const int family_size = print.family->size();
    const FiducialParameters grid{.print = print,
                                  .side_mm = map.at("side_mm").number(positive),
                                  .pitch_x_mm = pitch[0],
                                  .pitch_y_mm = pitch[1],
                                  .columns = map.at("columns").integer(1, family_size),
                                  .rows = map.at("rows").integer(1, family_size),
                                  .first_id = read_tag_id(map.at("first_id"), print)};
    if (grid.first_id + grid.columns * grid.rows > family_size)
        map.at("columns").fail(fmt::format("columns, rows and first_id go beyond the last tag of {}, {}",
                                           print.family->name, family_size - 1));
    const auto origin = map.find("origin_mm");
    const Eigen::Vector2d origin_mm = origin ? read_point_mm(*origin) : Eigen::Vector2d(0.0, 0.0);
    std::vector<PlateTag> tags = plate_of(grid).tags;
    for (PlateTag& tag : tags) tag.centre_mm += origin_mm;
    return tags;
}

Dot read_dot(const YamlValue& map) {
    map.allow_only({"dot", "centre_mm", "diameter_um", "diameter_mm", "reflectance"});
    return {read_point_mm(map.at("centre_mm")), read_length_mm(map, "diameter")};
}

Pad read_pad(const YamlValue& map) {
    map.allow_only(
        {"pad", "centre_mm", "width_um", "width_mm", "height_um", "height_mm", "angle_deg", "reflectance"});
    return {read_point_mm(map.at("centre_mm")),
            {read_length_mm(map, "width"), read_length_mm(map, "height")},
            read_angle_rad(map)};
}

Line read_line(const YamlValue& map) {
    map.allow_only({"line", "from_mm", "to_mm", "width_um", "width_mm", "reflectance"});
    const Line line{read_point_mm(map.at("from_mm")), read_point_mm(map.at("to_mm")),
                    read_length_mm(map, "width")};
    if (line.from_mm == line.to_mm) map.at("to_mm").fail("must differ from from_mm");
    return line;
}

Scratch read_scratch(const YamlValue& map) {
    map.allow_only({"scratch", "points_mm", "width_um", "width_mm", "reflectance"});
    Scratch scratch{{}, read_length_mm(map, "width")};
    for (const YamlValue& point : map.at("points_mm").items())
        scratch.points_mm.push_back(read_point_mm(point));
    if (scratch.points_mm.size() < 2)
        map.at("points_mm").fail("must be a list of at least two points [x, y] in mm");
    return scratch;
}

}  // namespace

Feature read_feature(const YamlValue& map, double ink_reflectance) {
    const auto reflectance = map.find("reflectance");
    const double grey = reflectance ? reflectance->number(reflectance_range) : ink_reflectance;
    if (const auto name = map.find("dot")) return {name->text(), read_dot(map), grey};
    if (const auto name = map.find("pad")) return {name->text(), read_pad(map), grey};
    if (const auto name = map.find("line")) return {name->text(), read_line(map), grey};
    if (const auto name = map.find("scratch")) return {name->text(), read_scratch(map), grey};
    map.fail("must have one of the keys dot, pad, line, scratch, with the feature's name");
}

Plate read_plate(const YamlValue& root) {
    root.allow_only({"family", "border_cells", "inverted", "paper_reflectance", "ink_reflectance", "grid",
                     "side_mm", "tags", "features"});
    Plate plate;
    const TagPrint print = read_tag_print(root);
    if (const auto paper = root.find("paper_reflectance"))
        plate.paper_reflectance = paper->number(reflectance_range);
    if (const auto ink = root.find("ink_reflectance")) plate.ink_reflectance = ink->number(reflectance_range);
    if (const auto grid = root.find("grid")) plate.tags = read_grid(*grid, print);

    std::optional<double> side_mm;
    if (const auto side = root.find("side_mm")) side_mm = side->number(positive);
    std::set<int> ids;
    for (const PlateTag& tag : plate.tags) ids.insert(tag.id);
    if (const auto tags = root.find("tags"))
        for (const YamlValue& value : tags->items()) {
            plate.tags.push_back(read_tag(value, side_mm, print));
            if (!ids.insert(plate.tags.back().id).second) value.at("id").fail("is on the plate already");
        }
    if (plate.tags.empty()) root.fail("a plate needs fiducials: give grid, or tags, or both");

    std::set<std::string> names;
    if (const auto features = root.find("features"))
        for (const YamlValue& value : features->items()) {
            plate.features.push_back(read_feature(value, plate.ink_reflectance));
            if (!names.insert(plate.features.back().name).second)
                value.fail(fmt::format("a feature named {} exists already", plate.features.back().name));
        }
    return plate;
}

Plate load_plate(const std::filesystem::path& file) {
    return read_plate(YamlValue::load(file));
}

std::string plate_yaml(const std::vector<PlateTag>& tags) {
    std::string text = tag_print_yaml(tags.empty() ? TagPrint{} : tags.front().print, "\n") + "\ntags:\n";
    for (const PlateTag& tag : tags)
        text += fmt::format("  - {{ id: {}, centre_mm: [{}, {}], side_mm: {}, angle_deg: {} }}\n", tag.id,
                            tag.centre_mm.x(), tag.centre_mm.y(), tag.side_mm,
                            tag.angle_rad * 180.0 / std::numbers::pi);
    return text;
}

Plate plate_of(const FiducialParameters& fiducials) {
    Plate plate;
    for (int row = 0; row < fiducials.rows; ++row)
        for (int column = 0; column < fiducials.columns; ++column)
            plate.tags.push_back({.id = fiducials.first_id + row * fiducials.columns + column,
                                  .centre_mm = {column * fiducials.pitch_x_mm, row * fiducials.pitch_y_mm},
                                  .side_mm = fiducials.side_mm,
                                  .print = fiducials.print});
    return plate;
}

Plate rig_plate(const Rig& rig, const std::filesystem::path& rig_file) {
    if (!rig.fiducials)
        throw InputError(
            fmt::format("{}: fiducials: missing; needed to find the way on the plate", rig_file.string()));
    return plate_of(*rig.fiducials);
}

}  // namespace fidservo

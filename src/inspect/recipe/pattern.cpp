// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/pattern.h"

#include "src/files/rig/plate_file.h"

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

void move(Dot& dot, const Eigen::Vector2d& by_mm) {
    dot.centre_mm += by_mm;
}
void move(Pad& pad, const Eigen::Vector2d& by_mm) {
    pad.centre_mm += by_mm;
}
void move(Line& line, const Eigen::Vector2d& by_mm) {
    line.from_mm += by_mm;
    line.to_mm += by_mm;
}
void move(Scratch& scratch, const Eigen::Vector2d& by_mm) {
    for (Eigen::Vector2d& point_mm : scratch.points_mm) point_mm += by_mm;
}

}  // namespace

Feature moved(Feature feature, const Eigen::Vector2d& by_mm) {
    std::visit([&](auto& shape) { move(shape, by_mm); }, feature.shape);
    return feature;
}

std::string name_at(const std::string& feature, int tag_id) {
    return fmt::format("{}@{}", feature, tag_id);
}

void add_pattern(const YamlValue& list, const std::vector<int>& tag_ids, Plate& plate) {
    for (const YamlValue& value : list.items()) {
        const Feature feature = read_feature(value, plate.ink_reflectance);
        for (const int id : tag_ids) {
            Feature printed = moved(feature, find_tag(plate, id)->centre_mm);
            printed.name = name_at(feature.name, id);
            if (find_feature(plate, printed.name))
                value.fail(fmt::format("a feature named {} exists already", printed.name));
            plate.features.push_back(std::move(printed));
        }
    }
}

View of_site(const View& view, const Plate& plate, int tag_id) {
    const auto resolve = [&](std::string& name) {
        const std::string here = name_at(name, tag_id);
        if (find_feature(plate, here)) name = here;
    };
    View resolved = view;
    for (Check& check : resolved.checks) {
        if (auto* mark = std::get_if<MarkCheck>(&check)) resolve(mark->feature);
        if (auto* line = std::get_if<LineCheck>(&check)) resolve(line->feature);
        if (auto* edges = std::get_if<EdgeDistanceCheck>(&check)) {
            resolve(edges->feature_a);
            resolve(edges->feature_b);
        }
    }
    return resolved;
}

}  // namespace fidservo::inspect

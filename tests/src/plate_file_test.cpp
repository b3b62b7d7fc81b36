// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/plate_file.h"

#include "tests/src/message_of.h"

#include <numbers>
#include <string>
#include <variant>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;

Plate parse(const std::string& text) {
    return read_plate(YamlValue::parse(text, "plate.yaml"));
}

const std::string grid =
    "grid: { columns: 3, rows: 2, pitch_mm: [2, 3], first_id: 5, origin_mm: [1, -1], side_mm: 1.2 }\n";

TEST(PlateFile, Grid_CountsColumnsFirst) {
    const Plate plate = parse(grid);
    ASSERT_EQ(plate.tags.size(), 6u);
    EXPECT_EQ(plate.tags[4].id, 9);
    EXPECT_EQ(plate.tags[4].centre_mm, Eigen::Vector2d(3.0, 2.0));
    EXPECT_DOUBLE_EQ(plate.tags[4].side_mm, 1.2);
}

TEST(PlateFile, ListOfTags_TakesTheCommonSide) {
    const Plate plate = parse(
        "side_mm: 1.5\ntags:\n  - { id: 7, centre_mm: [4, 0] }\n"
        "  - { id: 3, centre_mm: [8, 0.1], side_mm: 1.0, angle_deg: 90 }\n");
    EXPECT_DOUBLE_EQ(plate.tags[0].side_mm, 1.5);
    EXPECT_DOUBLE_EQ(plate.tags[1].side_mm, 1.0);
    EXPECT_DOUBLE_EQ(plate.tags[1].angle_rad, std::numbers::pi / 2.0);
}

TEST(PlateFile, Features_KeepOrderNamesAndUnits) {
    const Plate plate = parse(grid + R"(ink_reflectance: 0.2
features:
  - { dot: d, centre_mm: [1, 2], diameter_um: 300 }
  - { pad: p, centre_mm: [1, 2], width_um: 400, height_mm: 0.2, reflectance: 0.5 }
  - { line: l, from_mm: [0, 0], to_mm: [1, 0], width_um: 60 }
  - { scratch: s, points_mm: [[0, 0], [1, 1], [2, 0]], width_um: 15, reflectance: 0.95 }
)");
    ASSERT_EQ(plate.features.size(), 4u);
    EXPECT_DOUBLE_EQ(std::get<Dot>(plate.features[0].shape).diameter_mm, 0.3);
    EXPECT_DOUBLE_EQ(plate.features[0].reflectance, 0.2);
    EXPECT_EQ(std::get<Pad>(plate.features[1].shape).size_mm, Eigen::Vector2d(0.4, 0.2));
    EXPECT_DOUBLE_EQ(std::get<Line>(plate.features[2].shape).width_mm, 0.06);
    EXPECT_EQ(std::get<Scratch>(plate.features[3].shape).points_mm.size(), 3u);
    EXPECT_EQ(plate.features[3].name, "s");
}

TEST(PlateFile, PrintOfTheTags_IsEveryTags) {
    const Plate plate = parse("family: DICT_5X5_100\nborder_cells: 2\ninverted: true\n" + grid);
    const TagPrint print{find_tag_family("DICT_5X5_100"), 2, true};
    for (const PlateTag& tag : plate.tags) EXPECT_EQ(tag.print, print);
    EXPECT_EQ(parse(plate_yaml(plate.tags)).print(), print);
    EXPECT_EQ(parse(grid).print(), TagPrint{});
}

TEST(PlateFile, IdBeyondTheFamily_IsNamedWithItsRange) {
    EXPECT_EQ(
        message_of([] { parse("family: tag16h5\nside_mm: 1\ntags:\n  - { id: 30, centre_mm: [0, 0] }\n"); }),
        "plate.yaml:4: tags[0].id: 30: must be 0 to 29, the tags of tag16h5");
}

TEST(PlateFile, Mistakes_AreNamed) {
    EXPECT_EQ(message_of([] { parse("family: tag36h11\n"); }),
              "plate.yaml:1: a map: a plate needs fiducials: give grid, or tags, or both");
    EXPECT_EQ(message_of([] { parse(grid + "tags:\n  - { id: 6, centre_mm: [50, 0], side_mm: 1 }\n"); }),
              "plate.yaml:3: tags[0].id: 6: is on the plate already");
    EXPECT_EQ(
        message_of([] { parse(grid + "features:\n  - { dot: d, centre_mm: [0, 0], diameter_px: 3 }\n"); }),
        "plate.yaml:3: features[0].diameter_px: 3: unknown key; did you mean diameter_um, in um?");
    EXPECT_EQ(
        message_of([] { parse(grid + "features:\n  - { dot: d, centre_mm: [0, 0], diameter_um: -3 }\n"); }),
        "plate.yaml:3: features[0].diameter_um: -3: must be a number in um above 0");
    EXPECT_EQ(message_of([] { parse(grid + "features:\n  - { circle: d }\n"); }),
              "plate.yaml:3: features[0]: a map: must have one of the keys dot, pad, line, scratch, with the "
              "feature's name");
}

}  // namespace
}  // namespace fidservo

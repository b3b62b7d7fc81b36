// SPDX-License-Identifier: GPL-3.0-or-later
// Inspection by a camera that is turned, tilted, distorting, on an oblique axis, and whose rig file says so.
#include "core/rig.h"
#include "src/inspect/inspection_run.h"
#include "src/inspect/recipe/seen_box.h"
#include "tests/src/temporary_folder.h"

#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

using testing::TemporaryFolder;
using testing::text_of;

constexpr double degree = std::numbers::pi / 180;

CameraGeometry straight_camera() {
    return {1280, 960, 5000.0, {639.5, 479.5}, 20.0};
}

TEST(SeenBox, StraightCamera_SeesItsWholeImage) {
    const Box seen = box_seen(straight_camera(), 100.0), around = box_around_seen(straight_camera(), 100.0);
    EXPECT_LT((seen.low_mm - Eigen::Vector2d(100.0 - 2.558, -1.918)).norm(), 1e-9);
    EXPECT_LT((seen.high_mm - Eigen::Vector2d(100.0 + 2.558, 1.918)).norm(), 1e-9);
    EXPECT_LT((around.low_mm - seen.low_mm).norm() + (around.high_mm - seen.high_mm).norm(), 1e-9);
}

TEST(SeenBox, CameraUpsideDown_SeesTheSameBox) {
    CameraGeometry camera = straight_camera();
    camera.rotation_rad = std::numbers::pi;
    EXPECT_LT((box_seen(camera, 100.0).low_mm - box_seen(straight_camera(), 100.0).low_mm).norm(), 1e-9);
    EXPECT_LT((box_seen(camera, 100.0).high_mm - box_seen(straight_camera(), 100.0).high_mm).norm(), 1e-9);
}

TEST(SeenBox, GeneralCamera_SeesTheInnerBoxWhollyAndNothingBeyondTheOuterOne) {
    CameraGeometry camera = straight_camera();
    camera.distortion.k1 = -0.2;
    camera.rotation_rad = 1.0 * degree;
    camera.tilt_rad = {2.0 * degree, -2.236 * degree};
    const Box seen = box_seen(camera, 50.0), around = box_around_seen(camera, 50.0);
    constexpr double chord_px = 0.05;
    for (int k = 0; k <= 20; ++k) {
        const double share = k / 20.0;
        const Eigen::Vector2d along = seen.low_mm + share * (seen.high_mm - seen.low_mm);
        for (const Eigen::Vector2d& rim :
             {Eigen::Vector2d(along.x(), seen.low_mm.y()), Eigen::Vector2d(along.x(), seen.high_mm.y()),
              Eigen::Vector2d(seen.low_mm.x(), along.y()), Eigen::Vector2d(seen.high_mm.x(), along.y())}) {
            const Eigen::Vector2d pixel = project(camera, rim, 50.0);
            EXPECT_GT(pixel.minCoeff(), -chord_px);
            EXPECT_LT(pixel.x(), 1279.0 + chord_px);
            EXPECT_LT(pixel.y(), 959.0 + chord_px);
        }
        const Eigen::Vector2d corner = back_project(camera, {1279.0 * share, 959.0 * (1 - share)}, 50.0);
        EXPECT_TRUE((corner.array() > around.low_mm.array() - 1e-3).all());
        EXPECT_TRUE((corner.array() < around.high_mm.array() + 1e-3).all());
    }
}

std::string replaced(std::string text, const std::string& piece, const std::string& replacement) {
    const auto place = text.find(piece);
    EXPECT_NE(place, std::string::npos) << piece;
    return text.replace(place, piece.size(), replacement);
}

/// Two sites; the plate is right at the first and wrong at the second: the dot is displaced by 30 um, and
/// there is a stain.
const std::string recipe = R"(name: aslant
plate:
  grid: {columns: 101, rows: 1, pitch_mm: [2.0, 0.0], first_id: 0, side_mm: 1.2}
pattern:
  - {dot: dot, centre_mm: [0.2, 1.4], diameter_um: 300}
  - {pad: pad, centre_mm: [2.0, 1.4], width_um: 600, height_um: 400}
  - {line: line, from_mm: [-1.0, 2.1], to_mm: [2.6, 2.1], width_um: 120}
sites:
  tags: [10, 14]
views:
  - name: only
    offset_um: 0
    checks:
      - fiducial_placement: {tolerance_um: 10}
      - mark: {feature: dot, centre_tolerance_um: 10, size_tolerance_um: 10}
      - mark: {feature: pad, centre_tolerance_um: 10, size_tolerance_um: 10}
      - line: {feature: line, width_tolerance_um: 10}
      - edge_distance: {between: [line, pad], tolerance_um: 10}
      - reference: {longest_defect_um: 25}
simulation: {plate: plate.yaml, seed: 3}
)";

const std::string printed = R"(grid: {columns: 101, rows: 1, pitch_mm: [2.0, 0.0], first_id: 0, side_mm: 1.2}
features:
  - {dot: dot@10, centre_mm: [20.2, 1.4], diameter_um: 300}
  - {pad: pad@10, centre_mm: [22.0, 1.4], width_um: 600, height_um: 400}
  - {line: line@10, from_mm: [19.0, 2.1], to_mm: [22.6, 2.1], width_um: 120}
  - {dot: dot@14, centre_mm: [28.23, 1.4], diameter_um: 300}
  - {pad: pad@14, centre_mm: [30.0, 1.4], width_um: 600, height_um: 400}
  - {line: line@14, from_mm: [27.0, 2.1], to_mm: [30.6, 2.1], width_um: 120}
  - {dot: stain, centre_mm: [29.0, 1.5], diameter_um: 60, reflectance: 0.4}
)";

TEST(SlowInspection, CameraThatLooksAslant_PassesAGoodSiteAndFindsTheDefects) {
    const TemporaryFolder folder;
    std::filesystem::copy_file(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "preisach_fod.csv",
                               folder / "preisach_fod.csv");
    folder.write("plate.yaml", printed);
    InspectionOptions options;
    options.recipe = folder.write("recipe.yaml", recipe);
    options.session.rig_file = folder.write(
        "rig.yaml",
        replaced(text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml"), "  distance_mm: 20\n",
                 "  distance_mm: 20\n  focal_ratio: 1.002\n  distortion: [-0.2, 0.05, 0.001, -0.0005, 0]\n"
                 "  rotation_rad: 0.0175\n  tilt_rad: [0.035, -0.039]\n  axis_rad: [0.0005, -0.0003]\n"));
    options.out = folder / "out";
    run_inspection(options);

    std::map<std::string, std::set<std::string>> failed;
    std::map<std::string, int> passed;
    std::istringstream rows(text_of(folder / "out/results.csv"));
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
        const std::string site = row.substr(0, row.find(','));
        std::istringstream fields(row);
        std::string ignored, check;
        std::getline(fields, ignored, ',');
        std::getline(fields, ignored, ',');
        std::getline(fields, check, ',');
        if (row.find(",pass,") != std::string::npos)
            ++passed[site];
        else
            failed[site].insert(check);
    }
    EXPECT_TRUE(failed["10"].empty()) << text_of(folder / "out/results.csv");
    EXPECT_GE(passed["10"], 12);
    EXPECT_EQ(failed["14"], (std::set<std::string>{"mark_centre_x", "reference"}))
        << text_of(folder / "out/results.csv");
}

}  // namespace
}  // namespace fidservo::inspect

// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings that were made over a plate of their own.
#include "gap/evidence/plate_tag.h"

#include "core/rig.h"
#include "gap/evidence.h"
#include "plant/actual_camera.h"
#include "tests/gap/root_mean_square.h"
#include "tests/gap/simulated_campaign.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::rms;

TEST(PlateTag, IsTheRigFilesGrid_UnlessTheRecordingStatesAnother) {
    Recording recording;
    EXPECT_EQ(plate_tag(recording, reference_rig(), 7)->centre_mm, Eigen::Vector2d(14.0, 0.0));
    EXPECT_FALSE(plate_tag(recording, reference_rig(), 101));
    recording.plate = {{.id = 300, .centre_mm = {5.0, 0.5}, .side_mm = 0.9}};
    EXPECT_EQ(plate_tag(recording, reference_rig(), 300), recording.plate[0]);
    EXPECT_FALSE(plate_tag(recording, reference_rig(), 7));
    Rig without = reference_rig();
    without.fiducials.reset();
    EXPECT_TRUE(shows_tags(recording, without));
    EXPECT_FALSE(shows_tags({}, without));
    EXPECT_FALSE(plate_tag({}, without, 7));
}

TEST(PlateTag, CornersOfATurnedTag_AreTurnedWithIt) {
    const auto corners_mm = plate_corners_mm(
        {.id = 1, .centre_mm = {5.0, 1.0}, .side_mm = 2.0, .angle_rad = 0.5 * std::numbers::pi});
    const std::array<Eigen::Vector2d, 4> expected{Eigen::Vector2d(4.0, 0.0), Eigen::Vector2d(4.0, 2.0),
                                                  Eigen::Vector2d(6.0, 2.0), Eigen::Vector2d(6.0, 0.0)};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((corners_mm[k] - expected[k]).norm(), 1e-12) << k;
}

/// Each detection moved, in its picture, to where a camera sees a tag of another side beside the first one,
/// turned, under another id.
Recording over_another_plate(Recording recording, const Rig& rig) {
    constexpr int first_id = 200;
    const plant::ActualCamera camera{rig.camera->geometry};
    constexpr int tags = 101;
    std::vector<PlateTag> grid;
    grid.reserve(tags);
    for (int id = 0; id < tags; ++id) grid.push_back(*plate_tag(recording, rig, id));
    for (const PlateTag& tag : grid)
        recording.plate.push_back({.id = first_id + tag.id,
                                   .centre_mm = tag.centre_mm + Eigen::Vector2d(0.1, -0.2),
                                   .side_mm = 0.9,
                                   .angle_rad = 0.3});
    for (TagDetection& detection : recording.detections) {
        const PlateTag of_grid = *plate_tag({}, rig, detection.tag_id);
        Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
        for (const Eigen::Vector2d& corner_px : detection.corners_px) middle_px += 0.25 * corner_px;
        const double s_mm = of_grid.centre_mm.x() -
                            back_project(rig.camera->geometry, middle_px, of_grid.centre_mm.x()).x() +
                            of_grid.centre_mm.x();
        const auto here_mm = plate_corners_mm(of_grid);
        detection.tag_id += first_id;
        const auto there_mm = plate_corners_mm(*plate_tag(recording, rig, detection.tag_id));
        for (std::size_t k = 0; k < 4; ++k)
            detection.corners_px[k] += camera.image_px(there_mm[k], s_mm) - camera.image_px(here_mm[k], s_mm);
    }
    return recording;
}

TEST(PlateTag, RecordingOverAPlateOfItsOwn_IsAtTheFloor) {
    constexpr std::uint64_t seed = 12;
    const Rig& rig = reference_rig();
    const Recording recording =
        over_another_plate(simulate(rig, {}, make_experiment("integrated", rig, seed, "a"), "a", seed), rig);
    Rig without = rig;
    without.fiducials.reset();
    for (const Rig& judged_by : {rig, without}) {
        const Evidence evidence(judged_by, {recording});
        const Errors none = evidence.errors({}, everything(evidence));
        EXPECT_LT(rms(evidence, none, Signal::tag), 1.1);
    }
    Recording unstated = recording;
    unstated.plate.clear();
    const Evidence evidence(rig, {unstated});
    EXPECT_TRUE(std::isnan(evidence.floor(Signal::tag)) ||
                std::isnan(rms(evidence, evidence.errors({}, everything(evidence)), Signal::tag)));
}

}  // namespace
}  // namespace fidservo

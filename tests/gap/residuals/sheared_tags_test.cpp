// SPDX-License-Identifier: GPL-3.0-or-later
// Tags of a camera with a rolling shutter, and of cameras with other defects.
#include "gap/residuals/sheared_tags.h"

#include "core/rig.h"
#include "gap/diagnose.h"
#include "tests/gap/simulated_campaign.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::effects;

bool shows_shear(const Hypothesis& truth) {
    const Evidence evidence = testing::campaign(truth, {"micro-steps"});
    return tags_are_sheared(evidence, evidence.errors({}, everything(evidence)));
}

/// The next tag of the plate, seen a pitch beside.
TagDetection beside(TagDetection tag) {
    const Rig& rig = reference_rig();
    const double side_px = (tag.corners_px[1] - tag.corners_px[0]).norm();
    ++tag.tag_id;
    for (Eigen::Vector2d& corner : tag.corners_px)
        corner.x() += side_px / rig.fiducials->side_mm * rig.fiducials->pitch_x_mm;
    return tag;
}

TEST(ShearedTags, ReadoutOfEitherSign_Shears) {
    EXPECT_TRUE(shows_shear(effects({"rolling_shutter:readout_ms=8"})));
    EXPECT_TRUE(shows_shear(effects({"rolling_shutter:readout_ms=-15"})));
}

/// Where frames show two tags, these alternate in the list of detections.
TEST(ShearedTags, TwoTagsInEachFrame_ShearToo) {
    for (const double readout_ms : {0.0, 8.0}) {
        const Hypothesis truth = effects({fmt::format("rolling_shutter:readout_ms={}", readout_ms)});
        Recording recording = testing::campaign(truth, {"micro-steps"}).recordings().front();
        std::vector<TagDetection> both;
        for (const TagDetection& tag : recording.detections) both.insert(both.end(), {tag, beside(tag)});
        recording.detections = std::move(both);
        const Evidence evidence(reference_rig(), {std::move(recording)});
        EXPECT_EQ(tags_are_sheared(evidence, evidence.errors({}, everything(evidence))), readout_ms > 0.0);
    }
}

TEST(ShearedTags, OtherCauses_DoNotShear) {
    for (const char* other : {"camera_latency", "lens_distortion", "pixel_scale", "camera_rotation",
                              "camera_tilt", "clock_skew", "hall_gain"})
        EXPECT_FALSE(shows_shear(effects({other}))) << other;
    EXPECT_FALSE(shows_shear({}));
}

TEST(SlowShearedTags, WhereNoEffectExplainsThem_TheImageIsAccused) {
    const Evidence evidence = testing::campaign(effects({"rolling_shutter:readout_ms=12"}), {"micro-steps"});
    const Diagnosis diagnosis = gap::diagnose(evidence, {});
    EXPECT_EQ(diagnosis.verdict, Verdict::unexplained);
    ASSERT_FALSE(diagnosis.where.empty());
    EXPECT_EQ(diagnosis.where.front().block, "camera.image");
    ASSERT_TRUE(diagnosis.unexplained.has_value());
    EXPECT_EQ(diagnosis.unexplained->depends_on, std::vector<std::string>{"how fast tags move, row by row"});
}

}  // namespace
}  // namespace fidservo

// Tags of a camera whose rows are exposed one after the other, and of cameras that are off otherwise.
#include "gap/sheared_tags.h"

#include "gap/diagnose.h"
#include "tests/gap/simulated_campaign.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::effects;

bool shows_shear(const Hypothesis& truth) {
    const Evidence evidence = testing::campaign(truth, {"micro-steps"});
    return tags_are_sheared(evidence, evidence.errors({}, everything(evidence)));
}

TEST(ShearedTags, ReadoutOfEitherSign_Shears) {
    EXPECT_TRUE(shows_shear(effects({"rolling_shutter:readout_ms=8"})));
    EXPECT_TRUE(shows_shear(effects({"rolling_shutter:readout_ms=-15"})));
}

TEST(ShearedTags, OtherCauses_DoNotShear) {
    for (const char* other : {"camera_latency", "lens_distortion", "pixel_scale", "camera_rotation",
                              "camera_tilt", "clock_skew", "hall_gain"})
        EXPECT_FALSE(shows_shear(effects({other}))) << other;
    EXPECT_FALSE(shows_shear({}));
}

TEST(ShearedTags, WhereNoEffectExplainsThem_TheImageIsAccused) {
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

// Effects that show only beside what another one does.
#include "gap/diagnose.h"
#include "tests/gap/effect_names.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::effects;
using testing::names;

Diagnosis diagnosed(std::initializer_list<std::string_view> truth,
                    std::initializer_list<std::string_view> kinds, const std::vector<std::string>& tried) {
    return diagnose(campaign(effects(truth), kinds), {.only = tried, .without = {}, .selection = {}});
}

const FoundEffect& found(const Diagnosis& diagnosis, std::string_view name) {
    return *std::ranges::find(diagnosis.effects, name, &FoundEffect::effect);
}

/// What it does in the middle of the rail hides within a count.
TEST(Diagnosis, SmallFalseScaleOfEitherSign_IsFound) {
    for (const double factor : {0.9992, 1.0008}) {
        const std::string text = fmt::format("encoder_scale:factor={}", factor);
        const Diagnosis diagnosis = diagnosed({text}, {"macro-square", "integrated"},
                                              {"encoder_scale", "viscous_friction", "camera_tilt"});
        ASSERT_EQ(names(diagnosis), std::vector<std::string>{"encoder_scale"})
            << text << ", gap " << diagnosis.gap.before;
        EXPECT_NEAR(diagnosis.effects.front().parameters.front().value, factor, 1e-4);
    }
}

/// Its period is one of the rail, which the encoder reads at a false scale.
TEST(Diagnosis, RippleBesideAFalseScale_IsFoundWithItsPeriod) {
    const Diagnosis diagnosis =
        diagnosed({"encoder_scale:factor=1.01", "encoder_ripple:amplitude_um=60,period_mm=8,phase_rad=1"},
                  {"macro-sweep", "integrated"}, {"encoder_scale", "encoder_ripple", "viscous_friction"});
    ASSERT_EQ(names(diagnosis), (std::vector<std::string>{"encoder_ripple", "encoder_scale"}));
    EXPECT_NEAR(found(diagnosis, "encoder_ripple").parameters[0].value, 60.0, 3.0);
    EXPECT_NEAR(found(diagnosis, "encoder_ripple").parameters[1].value, 8.0, 0.01);
}

/// What the platform feels is fitted first where the carriage moves as its file says, which it does not.
TEST(Diagnosis, PlatformThatFeelsACarriageOfAnotherGain_HasNoThirdEffect) {
    const Diagnosis diagnosis =
        diagnosed({"drive_gain:factor=0.97", "macro_coupling"}, {"macro-square", "macro-sweep", "integrated"},
                  {"drive_gain", "macro_coupling", "payload", "stroke_change", "hall_crosstalk"});
    EXPECT_EQ(names(diagnosis), (std::vector<std::string>{"drive_gain", "macro_coupling"}));
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// What a search finds at once: where one signal is far off for a reason of its own, the others are explained.
#include "gap/search/search.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::AnyOf;
using testing::effects;
using ::testing::IsSupersetOf;
using ::testing::UnorderedElementsAre;

std::vector<std::string_view> names_of(const Search::Together& together) {
    std::vector<std::string_view> names;
    for (const Candidate* candidate : together.candidates) names.push_back(candidate->effect->name);
    return names;
}

TEST(SlowTogether, TagsThatAreFarOffForAnotherReason_DoNotHideSmallCausesOfTheWire) {
    const Evidence evidence =
        testing::campaign(effects({"encoder_ripple:amplitude_um=800,period_mm=9.3", "heater_delay:delay_ms=3",
                                   "heating_lag:factor=1.03"}),
                          {"macro-sweep", "micro-steps", "micro-triangle"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    EXPECT_THAT(names_of(search.everything_beside(search.nothing())),
                IsSupersetOf({"heater_delay", "heating_lag"}));
}

/// No sizes alone come near: what they stand in for is seen before they are fitted.
TEST(SlowTogether, HallReadingThatNeedsAShape_IsExplainedWithIt_AndWithWhatIsSmallBesideIt) {
    const Evidence evidence =
        testing::campaign(effects({"second_thermal_mass:conductance=0.19,mass_tau_s=7.2",
                                   "ambient_temperature:shift_degC=-0.6", "hall_offset:offset_V=0.0034"}),
                          {"macro-sweep", "micro-steps", "micro-triangle"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    const Search::Together found = search.everything_beside(search.nothing());
    EXPECT_THAT(names_of(found), UnorderedElementsAre("second_thermal_mass", "hall_offset",
                                                      AnyOf("ambient_temperature", "stress_shift")));
    EXPECT_FALSE(search.far_off(found.fitted)[index_of(Signal::hall)]);
}

/// A view that only a tilt explains is explained with it, not by all effects of wire and view.
TEST(SlowTogether, TagsThatNeedAShapeOfTheCamera_AreExplainedByWhatTheCameraAloneSees) {
    const Evidence evidence =
        testing::campaign(effects({"camera_tilt:about_u_deg=0.4,about_v_deg=-0.3",
                                   "camera_rotation:angle_deg=-0.1", "lens_distortion:k1=-0.06"}),
                          {"macro-sweep", "macro-square"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    const Search::Together found = search.everything_beside(search.nothing());
    EXPECT_THAT(names_of(found), UnorderedElementsAre("camera_tilt", "camera_rotation", "lens_distortion"));
    EXPECT_FALSE(search.off(found.fitted)[index_of(Signal::tag)]);
}

}  // namespace

}  // namespace fidservo

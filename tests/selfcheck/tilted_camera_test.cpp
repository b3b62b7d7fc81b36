// SPDX-License-Identifier: GPL-3.0-or-later
// A camera may be tilted about its mount, about the plate, or about anything between: one effect, which
// includes the displacement of the camera's centre.
#include "gap/diagnose.h"
#include "src/selfcheck/draw/campaign.h"
#include "tests/effort.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

struct Tilt {
    double about_u_deg, about_v_deg;
    double height;  ///< height of the axis relative to the camera's
    friend std::ostream& operator<<(std::ostream& out, const Tilt& tilt) {
        return out << tilt.about_u_deg << " and " << tilt.about_v_deg << " deg at " << tilt.height;
    }
};

class TiltedCamera : public ::testing::TestWithParam<Tilt> {};

TEST_P(TiltedCamera, OfTheIndependentModel_IsNamedWithItsParameters) {
    constexpr double rad_per_deg = std::numbers::pi / 180.0;
    const auto [about_u_deg, about_v_deg, height] = GetParam();
    TrueRig tilted{reference_rig(), {}};
    tilted.departures.camera.tilt_rad = -rad_per_deg * std::hypot(about_u_deg, about_v_deg);
    tilted.departures.camera.tilt_axis_rad = std::atan2(about_v_deg, about_u_deg);
    tilted.departures.camera.tilt_height = height;
    const gap::Evidence evidence(reference_rig(), record_campaign(reference_rig(), tilted, 11));
    const gap::Diagnosis found = gap::diagnose(evidence);
    EXPECT_EQ(found.verdict, gap::Verdict::explained);
    ASSERT_EQ(found.effects.size(), 1U);
    ASSERT_EQ(found.effects.front().effect, "camera_tilt");
    const auto& parameters = found.effects.front().parameters;
    EXPECT_NEAR(parameters[0].value, about_u_deg, 0.02);
    EXPECT_NEAR(parameters[1].value, about_v_deg, 0.02);
    EXPECT_NEAR(parameters[2].value, height, 0.02);
}

/// All tilts; the first two, which differ in all parameters, are those used without --all-draws.
std::vector<Tilt> tilts() {
    std::vector<Tilt> all{Tilt{1.5, 0.0, 0.0}, Tilt{-0.4, 0.7, 1.0}, Tilt{0.0, 0.6, 0.0},
                          Tilt{-0.8, -0.6, 0.6}};
    all.resize(static_cast<std::size_t>(fidservo::testing::draws(4, 2)));
    return all;
}

INSTANTIATE_TEST_SUITE_P(SlowAxes, TiltedCamera, ::testing::ValuesIn(tilts()));

}  // namespace
}  // namespace fidservo::selfcheck

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/effects/effect_rig.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

CameraDeviation deviation_of(const std::string& effect) {
    return *plant_with(effect).camera;
}

TEST(CameraEffects, Units_AreThoseOfTheirNames) {
    constexpr double deg = std::numbers::pi / 180.0;
    EXPECT_DOUBLE_EQ(deviation_of("pixel_scale:factor=1.01").pixel_scale, 1.01);
    EXPECT_DOUBLE_EQ(deviation_of("camera_rotation:angle_deg=2").rotation_rad, 2.0 * deg);
    EXPECT_DOUBLE_EQ(deviation_of("lens_distortion:k1=-0.2").distortion, -0.2);
    EXPECT_DOUBLE_EQ(deviation_of("camera_latency:delay_ms=30").delay_s, 0.03);
    EXPECT_DOUBLE_EQ(deviation_of("clock_skew:skew_ppm=200").clock_rate, 1.0002);
    EXPECT_DOUBLE_EQ(deviation_of("defocus:blur_px=1.5").extra_blur_px, 1.5);
    EXPECT_DOUBLE_EQ(deviation_of("motion_blur:extra_exposure_ms=4").extra_exposure_s, 0.004);
    EXPECT_DOUBLE_EQ(deviation_of("sensor_noise:read_noise_e=30").extra_read_noise_e, 30.0);
    EXPECT_DOUBLE_EQ(deviation_of("sensor_noise:gain_spread=0.02").gain_spread, 0.02);
    EXPECT_DOUBLE_EQ(deviation_of("rolling_shutter:readout_ms=-8").readout_s, -0.008);
}

TEST(CameraEffects, Tilt_IsARotationVectorInTheImage) {
    constexpr double deg = std::numbers::pi / 180.0;
    const CameraDeviation tilted = deviation_of("camera_tilt:about_u_deg=1,about_v_deg=-2");
    EXPECT_NEAR((tilted.tilt_rad - deg * Eigen::Vector2d(1.0, -2.0)).norm(), 0.0, 1e-15);
    EXPECT_EQ(deviation_of("camera_tilt:axis_height=0.8").tilt_axis_height, 0.8);
}

TEST(CameraEffects, Light_FallsOffInAddition) {
    const CameraDeviation camera = deviation_of("uneven_light:gradient_u=0.1,gradient_v=-0.2,vignetting=0.3");
    EXPECT_EQ(camera.light_gradient, Eigen::Vector2d(0.1, -0.2));
    EXPECT_EQ(camera.vignetting, 0.3);
}

TEST(CameraEffects, StageAndItsReadings_AreUntouched) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    for (const Effect* effect : effect_catalogue()) {
        if (!effect->block.starts_with("camera.")) continue;
        const StagePlant plant = plant_with(effect->name);
        StageState state = start(plant, 50.0, 3), other = start(nominal, 50.0, 3);
        for (int k = 0; k < 500; ++k) {
            ASSERT_EQ(sample(plant, state).hall_adc, sample(nominal, other).hall_adc) << effect->name;
            advance(plant, state, 4.0, 1.6);
            advance(nominal, other, 4.0, 1.6);
        }
        EXPECT_EQ(camera_position_mm(state), camera_position_mm(other)) << effect->name;
    }
}

}  // namespace
}  // namespace fidservo::plant

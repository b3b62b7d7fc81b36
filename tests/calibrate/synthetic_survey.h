// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The recording of a quick survey on a rig with known numbers: without images or motion, only with the
// sensors' noise and rounding and the corners' noise.
#include "src/calibrate/stage_numbers.h"
#include "tests/calib/stage_views.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fidservo {

inline int synthetic_reading(const HallParameters& hall, double platform_mm, NoiseStream& noise) {
    return static_cast<int>(
        std::lround(hall_voltage_V(hall, platform_mm) / hall_lsb_V(hall) + hall.noise_lsb * noise.normal()));
}

/// The measurements of a rig with known numbers at rest.
class SyntheticStands {
  public:
    /// @param truth  the true rig
    SyntheticStands(const Rig& truth, std::uint64_t seed, double corner_std_px)
        : truth_(truth), corner_std_px_(corner_std_px), corners_(seed, "corners"), sensor_(seed, "hall") {}

    StageShot at(StageMove move, double carriage_mm, double platform_mm) {
        constexpr int readings = 41;
        StageShot shot{move,
                       0.0,
                       calib::synthetic_view(truth_.camera.value().geometry, 0.0, carriage_mm + platform_mm,
                                             corner_std_px_, corners_),
                       std::floor(carriage_mm / truth_.macro.encoder_resolution_mm + 0.5),
                       {},
                       {}};
        for (int i = 0; i < readings; ++i)
            shot.hall_adc.push_back(synthetic_reading(truth_.micro.value().hall, platform_mm, sensor_));
        return shot;
    }

  private:
    Rig truth_;
    double corner_std_px_;
    NoiseStream corners_, sensor_;
};

inline std::vector<StageShot> synthetic_survey(const Rig& truth, std::uint64_t seed, double corner_std_px) {
    SyntheticStands stands(truth, seed, corner_std_px);
    NoiseStream places(seed, "places");
    std::vector<StageShot> shots;
    shots.reserve(static_cast<std::size_t>(quick_plan.travel));
    const double parked_mm = 2.0 + 0.05 * places.uniform();
    for (int i = 0; i < quick_plan.travel; ++i)
        shots.push_back(stands.at(StageMove::travel, 2.0 + 194.0 * (i + places.uniform()) / quick_plan.travel,
                                  parked_mm));
    const double carriage_mm = 190.0 + places.uniform();
    shots.push_back(stands.at(StageMove::extended, carriage_mm, 0.0));
    const int platform = quick_plan.platform_up + quick_plan.platform_down;
    for (int i = 0; i < platform; ++i)
        shots.push_back(
            stands.at(StageMove::platform, carriage_mm, 0.2 + 3.6 * (i + places.uniform()) / platform));
    return shots;
}

}  // namespace fidservo

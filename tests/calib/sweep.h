// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A tuning sweep of the micro stage as the sensors would record it, on a rig whose true parameters the test
// chooses.
#include "calib/hall/hall_map.h"
#include "core/random.h"
#include "plant/stage_plant.h"
#include "tests/reference_rig.h"

#include <functional>
#include <vector>

namespace fidservo::calib {

struct Sweep {
    HallTrace hall;
    std::vector<double> command_V;
    std::vector<double> true_position_mm;
    std::vector<CameraSight> sights;
};

/// Rest, heat for `heat_s`, cool for two seconds; frames 20 ms apart, stamped `delay_s` late.
inline Sweep make_sweep(const plant::PlantParameters& physics, std::uint64_t seed, double delay_s = 0.0,
                        double heat_s = 1.6, double camera_std_mm = 0.0002) {
    constexpr int rest_ticks = 100, frame_ticks = 20;
    constexpr double heat_V = 1.585, carriage_mm = 50.0;
    const plant::StagePlant stage = plant::make_stage_plant(physics);
    plant::StageState truth = plant::start(stage, carriage_mm, seed);
    NoiseStream camera(seed, "camera");
    Sweep sweep;
    sweep.hall = {0, ns_per_ms, {}};
    const int heat_ticks = static_cast<int>(1000 * heat_s), ticks = rest_ticks + heat_ticks + 2000;
    for (int k = 0; k < ticks; ++k) {
        const bool heats = k >= rest_ticks && k < rest_ticks + heat_ticks;
        sweep.true_position_mm.push_back(truth.micro->position_mm);
        if (k % frame_ticks == 3)
            sweep.sights.push_back({k * ns_per_ms + nanoseconds(delay_s),
                                    plant::camera_position_mm(truth) + camera_std_mm * camera.normal(),
                                    camera_std_mm});
        sweep.hall.adc.push_back(plant::sample(stage, truth).hall_adc);
        sweep.command_V.push_back(heats ? heat_V : 0.0);
        plant::advance(stage, truth, 0.0, sweep.command_V.back());
    }
    return sweep;
}

}  // namespace fidservo::calib

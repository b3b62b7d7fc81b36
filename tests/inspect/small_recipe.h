// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A recipe of two sites on a small rig, and a function to introduce errors into it.
#include "core/rig.h"
#include "src/inspect/recipe/recipe.h"

#include <string>

namespace fidservo::inspect {

/// Travel 0..200 mm, micro 0..4 mm, the reference camera: 5.1 x 3.84 mm in view.
inline Rig small_rig() {
    Rig rig{};
    rig.name = "small";
    rig.tick_s = 0.001;
    rig.macro.low_mm = 0.0;
    rig.macro.high_mm = 200.0;
    rig.micro.emplace();
    rig.micro->low_mm = 0.0;
    rig.micro->high_mm = 4.0;
    rig.camera = CameraParameters{.geometry = {1280, 960, 5000.0, {639.5, 479.5}, 20.0},
                                  .frame_rate_hz = 50.0,
                                  .exposure_s = 0.002,
                                  .full_well_e = 10000.0,
                                  .read_noise_e = 5.0,
                                  .blur_px = 0.8,
                                  .latency_s = 0.03,
                                  .corner_noise_px = 0.02,
                                  .max_speed_mm_per_s = 20.0};
    return rig;
}

inline const std::string small_recipe = R"(name: small
plate:
  grid: {columns: 101, rows: 1, pitch_mm: [2.0, 0.0], first_id: 0, side_mm: 1.2}
pattern:
  - {dot: dot, centre_mm: [1.0, -1.3], diameter_um: 300}
  - {pad: pad, centre_mm: [-1.0, -1.3], width_um: 600, height_um: 400}
  - {line: line, from_mm: [-2.0, 1.3], to_mm: [2.0, 1.3], width_um: 120}
sites:
  tags: [10, 20]
views:
  - name: left
    offset_um: -1000
    checks:
      - fiducial_placement: {tolerance_um: 15}
      - mark: {feature: pad, centre_tolerance_um: 15, size_tolerance_um: 15}
  - name: right
    offset_um: 1000
    checks:
      - mark: {feature: dot, centre_tolerance_um: 15, size_tolerance_um: 15}
      - line: {feature: line, width_tolerance_um: 10}
      - edge_distance: {between: [line, fiducial], tolerance_um: 15}
      - reference: {longest_defect_um: 20}
)";

/// The recipe with one piece of text replaced by another.
inline std::string spoilt(const std::string& from, const std::string& to) {
    std::string text = small_recipe;
    const auto at = text.find(from);
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

}  // namespace fidservo::inspect

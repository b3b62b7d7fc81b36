// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The simulated camera's frame times, and its positions meanwhile.
#include "core/time.h"
#include "plant/stage_plant.h"

#include <cstdint>
#include <vector>

namespace fidservo {

/// The frame times: frames are taken by the camera's own clock, the first one at 3.3 ms; their stamps are
/// that clock's times plus the delay (plant/camera.h).
class FrameClock {
  public:
    struct Frame {
        TimeNs time_ns;  ///< middle of the exposure, true
        TimeNs stamp_ns;
    };

    FrameClock(double frame_rate_hz, const plant::CameraDeviation& camera);
    Frame frame(std::int64_t index) const;

  private:
    TimeNs period_ns_;
    plant::CameraDeviation camera_;
};

/// The plant's exact state a part of a tick later, under held commands in V.
plant::StageState moved_on(const plant::PlantParameters& parameters, plant::StageState state, TimeNs way_ns,
                           double macro_V, double micro_V);

/// The camera's true position over the last while: two exact positions a tick and a parabola through three of
/// them, within 5 nm of the motion at the reference rig's highest acceleration.
class CameraTrack {
  public:
    /// @param keep_s  how long positions are remembered
    CameraTrack(const plant::PlantParameters& parameters, double keep_s);

    /// Adds the tick that begins at time_ns, a multiple of the tick; every tick must be added in turn.
    void add(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V);
    /// The position at a time within keep_s before the last tick added; before the first tick, the initial
    /// position.
    double position_mm(double time_s) const;

  private:
    struct Tick {
        double start_mm, middle_mm;
    };
    plant::StagePlant half_tick_;
    double tick_s_;
    std::int64_t last_ = 0;
    std::vector<Tick> ticks_;  ///< by number modulo their count
};

}  // namespace fidservo

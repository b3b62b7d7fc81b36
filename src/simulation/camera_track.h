// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// When the simulated camera takes its frames, and where it is meanwhile.
#include "core/time.h"
#include "plant/stage_plant.h"

#include <cstdint>
#include <vector>

namespace fidservo {

/// Frames come when the camera's own clock says so, the first at 3.3 ms of it; stamps are that clock's times
/// and the delay (plant/camera.h).
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

/// The plant a part of a tick later, exactly, under commands in V that are held.
plant::StageState moved_on(const plant::PlantParameters& parameters, plant::StageState state, TimeNs way_ns,
                           double macro_V, double micro_V);

/// The camera's true position over the last while: two exact positions a tick and a parabola through three of
/// them, within 5 nm of the motion at the reference rig's highest acceleration.
class CameraTrack {
  public:
    /// @param keep_s  how long positions are remembered
    CameraTrack(const plant::PlantParameters& parameters, double keep_s);

    /// The tick that begins at time_ns, a multiple of the tick; every tick in turn.
    void add(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V);
    /// At any time within keep_s before the last tick that was added; where it began before that.
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

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A rig in real time: the simulated stage advances by the wall clock, independent of when it is read, and a
// camera's frame can be rendered for any time within the last second.
#include "core/plate.h"
#include "core/time.h"
#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"
#include "plant/view/plate_view.h"

#include <array>
#include <cstdint>
#include <mutex>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo {

struct Rig;

class LiveRig {
  public:
    /// Begins now, on CLOCK_MONOTONIC.
    /// @param effects  effects that the rig's file does not state; those of time stamps, arrival times and
    /// the camera's clock are not simulated here
    LiveRig(const Rig& rig, const Plate& printed, double carriage_mm, std::uint64_t seed,
            std::span<const plant::EffectSetting> effects = {});

    /// The commands in force from the present tick on.
    void command(double macro_V, double micro_V);
    /// The sensors' readings at a time.
    plant::StageReading read(TimeNs now_ns);
    /// The sensors' readings at a time up to which these commands have been in force since the last call: for
    /// a caller that reads the commands at intervals. A command then acts earlier than it was given, by the
    /// age of the next reading, so that a program which commands and reads at regular times sees no delay.
    /// From the first call on, time advances only by such calls.
    plant::StageReading follow(double macro_V, double micro_V, TimeNs now_ns);
    /// Where the camera's axis was at a time of the last second, mm.
    double camera_mm(TimeNs time_ns);
    double carriage_mm();
    /// The frame number `frame`, exposed around a time that has passed.
    cv::Mat frame_at(TimeNs time_ns, std::uint64_t frame);

  private:
    void go_on_to(TimeNs now_ns);
    double camera_at(TimeNs time_ns) const;

    std::mutex mutex_;
    plant::StagePlant plant_;
    plant::PlateView view_;
    plant::StageState state_;
    TimeNs tick_ns_, start_ns_;
    std::int64_t tick_ = 0;
    double macro_V_ = 0.0, micro_V_ = 0.0;
    bool is_followed_ = false;
    std::array<double, 1024> past_mm_{};  ///< by tick modulo its size
};

}  // namespace fidservo

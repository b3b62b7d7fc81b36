#pragma once
// A rig in real time: the simulated stage goes on by the wall clock, whoever asks and however late, and a
// camera's frame can be had of any moment of the last second.
#include "core/plate.h"
#include "core/time.h"
#include "plant/stage_plant.h"
#include "plant/view/plate_view.h"

#include <array>
#include <cstdint>
#include <mutex>

#include <opencv2/core/mat.hpp>

namespace fidservo {

struct Rig;

class LiveRig {
  public:
    /// Begins now, on CLOCK_MONOTONIC.
    LiveRig(const Rig& rig, const Plate& printed, double carriage_mm, std::uint64_t seed);

    /// The commands in force from the present tick on.
    void command(double macro_V, double micro_V);
    /// What the sensors show at a time.
    plant::StageReading read(TimeNs now_ns);
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
    std::array<double, 1024> past_mm_{};  ///< by tick modulo its size
};

}  // namespace fidservo

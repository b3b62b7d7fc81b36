// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/on_rig.h"

#include "core/failure.h"
#include "core/rig.h"
#include "src/record/travel_watch.h"
#include "src/session/pilot.h"
#include "src/simulation/experiment_law.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// An experiment under way; on a real stage it is the loop's thread that ticks it.
class ExperimentRun {
  public:
    ExperimentRun(const Rig& rig, const Experiment& experiment, const EncoderZero& zero)
        : rig_(rig),
          experiment_(experiment),
          zero_count_(zero.count),
          travel_(travel_watch(rig)),
          tick_ns_(nanoseconds(rig.tick_s)),
          ticks_(std::llround(experiment.duration_s / rig.tick_s)) {}

    control::StageCommand tick(const control::StageSample& sample, Setpoints& setpoints) {
        if (!start_ns_) start_ns_ = sample.time_ns;
        // Ticks that a late loop left out have gone by all the same.
        const TimeNs k = (sample.time_ns - *start_ns_ + tick_ns_ / 2) / tick_ns_;
        StageRow row{.time_ns = sample.time_ns};
        row.encoder_count = static_cast<double>(sample.encoder_count);
        row.hall_adc = sample.hall_adc;
        if (leaves_travel(travel_, travel_state_,
                          (row.encoder_count - zero_count_) * rig_.macro.encoder_resolution_mm))
            end_ = ExperimentEnd::end_of_travel;
        else if (k >= ticks_)
            end_ = ExperimentEnd::whole;
        if (end_) {
            setpoints = {};
            return {};
        }
        command_tick(rig_, experiment_, std::round(zero_count_), static_cast<double>(k) * rig_.tick_s, loops_,
                     row);
        setpoints = {row.macro_setpoint_mm, row.micro_setpoint_mm};
        return {row.macro_command_V, row.micro_command_V};
    }

    const std::optional<ExperimentEnd>& end() const { return end_; }

  private:
    const Rig& rig_;
    const Experiment& experiment_;
    double zero_count_;
    TravelWatch travel_;
    TravelWatchState travel_state_;
    TimeNs tick_ns_, ticks_;
    std::optional<TimeNs> start_ns_;
    ExperimentLoops loops_;
    std::optional<ExperimentEnd> end_;
};

}  // namespace

Result<ExperimentEnd> run_on_rig(Session& session, const Experiment& experiment, Progress& progress) {
    Pilot& pilot = session.pilot();
    ExperimentRun run(pilot.rig, experiment, pilot.encoder_zero().value());
    Setpoints setpoints;
    const TimeNs start_ns = pilot.machine.now_ns();
    TimeNs told_s = 0;
    const auto meanwhile = [&] {
        for (; (pilot.machine.now_ns() - start_ns) / ns_per_s > told_s; ++told_s) progress.advance();
        return session.look();
    };
    const auto ran =
        pilot.machine.run([&](const control::StageSample& sample) { return run.tick(sample, setpoints); },
                          [&] { return run.end().has_value(); }, setpoints, meanwhile);
    if (!ran) return forward(ran.error());
    pilot.begin_anew();
    if (*run.end() == ExperimentEnd::end_of_travel)
        pilot.machine.note("end_of_travel",
                           fmt::format("broken off with the carriage at {:.1f} mm", pilot.carriage_mm()));
    return *run.end();
}

}  // namespace fidservo

#include "src/simulation/simulate.h"

#include "control/nonlinear_pd.h"
#include "control/pi_antiwindup.h"
#include "core/random.h"
#include "plant/effects/catalogue.h"
#include "src/recording/writer.h"
#include "src/simulation/practice_detections.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo {

namespace {

/// The published controllers, as far as the experiment closes their loops.
struct Loops {
    control::PdState pd;
    std::optional<control::PiState> pi;
};

double macro_command_V(const Rig& rig, const Experiment& experiment, Loops& loops, StageRow& row,
                       double t_s) {
    const double limit_V = rig.macro.command_limit_V;
    if (experiment.macro_setpoint_mm) {
        row.macro_setpoint_mm = experiment.macro_setpoint_mm(t_s);
        const double setpoint_count =
            std::floor(row.macro_setpoint_mm / rig.macro.encoder_resolution_mm + 0.5);
        return control::pd_update(*rig.macro.pd, limit_V, loops.pd, setpoint_count - row.encoder_count);
    }
    return experiment.macro_V ? std::clamp(experiment.macro_V(t_s), -limit_V, limit_V) : 0.0;
}

double micro_command_V(const Rig& rig, const Experiment& experiment, Loops& loops, StageRow& row,
                       double t_s) {
    if (experiment.micro_setpoint_mm) {
        row.micro_setpoint_mm = experiment.micro_setpoint_mm(t_s);
        const double position_mm = hall_position_mm_of_adc(rig.micro->hall, static_cast<int>(row.hall_adc));
        if (!loops.pi) loops.pi = control::pi_start(*rig.micro->pi);
        return control::pi_update(*rig.micro->pi, rig.tick_s, *loops.pi, row.micro_setpoint_mm - position_mm);
    }
    return experiment.micro_V ? std::clamp(experiment.micro_V(t_s), 0.0, rig.micro->heater.limit_V) : 0.0;
}

/// Frames fall between ticks: the plant is moved on from the last tick for the rest of the way, exactly.
class PracticeCamera {
  public:
    PracticeCamera(const Rig& rig, const plant::PlantParameters& parameters, std::uint64_t seed)
        : parameters_(parameters),
          detector_(*rig.camera, *rig.fiducials, seed),
          tick_ns_(nanoseconds(rig.tick_s)),
          period_ns_(nanoseconds(1.0 / rig.camera->frame_rate_hz)),
          delay_ns_(nanoseconds(parameters.camera->delay_s)) {}

    /// Takes the frames whose exposure is centred in the tick that begins at time_ns, under the commands
    /// given.
    void look(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V,
              std::vector<TagDetection>& detections) {
        for (; next_frame_ns_ < time_ns + tick_ns_; next_frame_ns_ += period_ns_) {
            const plant::StageState there = moved_on(state, next_frame_ns_ - time_ns, macro_V, micro_V);
            const plant::StageState after = moved_on(there, probe_ns, macro_V, micro_V);
            const double s_mm = plant::camera_position_mm(there);
            const double speed_mm_per_s = (plant::camera_position_mm(after) - s_mm) / seconds(probe_ns);
            if (const auto seen = detector_.detect(next_frame_ns_ + delay_ns_, s_mm, speed_mm_per_s))
                detections.push_back(*seen);
        }
    }

  private:
    static constexpr TimeNs first_frame_ns = 3'300'000;
    static constexpr TimeNs probe_ns = 10'000;  ///< over which the speed is taken

    plant::StageState moved_on(plant::StageState state, TimeNs way_ns, double macro_V, double micro_V) const {
        if (way_ns <= 0) return state;
        plant::PlantParameters parameters = parameters_;
        parameters.tick_s = seconds(way_ns);
        plant::advance(plant::make_stage_plant(parameters), state, macro_V, micro_V);
        return state;
    }

    plant::PlantParameters parameters_;
    PracticeDetector detector_;
    TimeNs tick_ns_;
    TimeNs period_ns_;
    TimeNs delay_ns_;  ///< of the stamp
    TimeNs next_frame_ns_ = first_frame_ns;
};

}  // namespace

Recording simulate(const Rig& rig, std::span<const plant::EffectSetting> effects,
                   const Experiment& experiment, const std::string& name, std::uint64_t seed) {
    const std::uint64_t noise_seed = NoiseStream(seed, "noise/" + name).bits();
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, effects);
    const plant::StagePlant stage = plant::make_stage_plant(parameters);
    plant::StageState state =
        plant::start(stage, experiment.carriage_mm, noise_seed, plant::EncoderOrigin::end_of_travel);
    std::optional<PracticeCamera> camera;
    if (rig.camera && rig.fiducials) camera.emplace(rig, parameters, noise_seed);

    Recording recording;
    recording.name = name;
    recording.rig = rig.name;
    recording.experiment = experiment.kind;
    recording.tick_s = rig.tick_s;
    recording.columns = columns_of(rig);
    const TimeNs tick_ns = nanoseconds(rig.tick_s);
    const auto ticks = static_cast<TimeNs>(std::llround(experiment.duration_s / rig.tick_s));
    recording.rows.reserve(static_cast<std::size_t>(ticks));
    Loops loops;
    for (TimeNs k = 0; k < ticks; ++k) {
        const plant::StageReading reading = plant::sample(stage, state);
        StageRow row{.time_ns = k * tick_ns};
        row.encoder_count = static_cast<double>(reading.encoder_count);
        row.hall_adc = reading.hall_adc;
        const double t_s = static_cast<double>(k) * rig.tick_s;
        row.macro_command_V = macro_command_V(rig, experiment, loops, row, t_s);
        row.micro_command_V = micro_command_V(rig, experiment, loops, row, t_s);
        recording.rows.push_back(row);
        if (camera)
            camera->look(state, row.time_ns, row.macro_command_V, row.micro_command_V, recording.detections);
        plant::advance(stage, state, row.macro_command_V, row.micro_command_V);
    }
    return recording;
}

}  // namespace fidservo

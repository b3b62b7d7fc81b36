#include "src/simulation/simulate.h"

#include "plant/effects/catalogue.h"
#include "src/simulation/practice_detections.h"
#include "src/simulation/run_experiment.h"

#include <optional>

namespace fidservo {

namespace {

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

class PlantHardware final : public SimulatedHardware {
  public:
    PlantHardware(const Rig& rig, const plant::PlantParameters& parameters, double carriage_mm,
                  std::uint64_t seed)
        : stage_(plant::make_stage_plant(parameters)),
          state_(plant::start(stage_, carriage_mm, seed, plant::EncoderOrigin::end_of_travel)) {
        if (rig.camera && rig.fiducials) camera_.emplace(rig, parameters, seed);
    }

    Reading sample() override {
        const plant::StageReading reading = plant::sample(stage_, state_);
        return {reading.encoder_count, reading.hall_adc};
    }

    void look(TimeNs time_ns, double macro_V, double micro_V,
              std::vector<TagDetection>& detections) override {
        if (camera_) camera_->look(state_, time_ns, macro_V, micro_V, detections);
    }

    void advance(double macro_V, double micro_V) override {
        plant::advance(stage_, state_, macro_V, micro_V);
    }

  private:
    plant::StagePlant stage_;
    plant::StageState state_;
    std::optional<PracticeCamera> camera_;
};

}  // namespace

Recording simulate(const Rig& rig, std::span<const plant::EffectSetting> effects,
                   const Experiment& experiment, const std::string& name, std::uint64_t seed) {
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, effects);
    PlantHardware hardware(rig, parameters, experiment.carriage_mm, noise_seed(name, seed));
    return run_experiment(rig, experiment, name, hardware);
}

}  // namespace fidservo

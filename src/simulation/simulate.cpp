// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/simulate.h"

#include "core/demand.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/simulation/practice_camera.h"
#include "src/simulation/run_experiment.h"

#include <functional>
#include <optional>
#include <utility>

namespace fidservo {

namespace {

using Look = std::function<void(const plant::StageState& state, TimeNs time_ns, double macro_V,
                                double micro_V, std::vector<TagDetection>& detections)>;

class PlantHardware final : public SimulatedHardware {
  public:
    /// @param look  empty without a camera
    PlantHardware(const plant::PlantParameters& parameters, double carriage_mm, std::uint64_t seed, Look look)
        : stage_(plant::make_stage_plant(parameters)),
          state_(plant::start(stage_, carriage_mm, seed, plant::EncoderOrigin::end_of_travel)),
          look_(std::move(look)) {}

    Reading sample() override {
        const plant::StageReading reading = plant::sample(stage_, state_);
        return {reading.encoder_count, reading.hall_adc};
    }

    void look(TimeNs time_ns, double macro_V, double micro_V,
              std::vector<TagDetection>& detections) override {
        if (look_) look_(state_, time_ns, macro_V, micro_V, detections);
    }

    void advance(double macro_V, double micro_V) override {
        plant::advance(stage_, state_, macro_V, micro_V);
    }

  private:
    plant::StagePlant stage_;
    plant::StageState state_;
    Look look_;
};

}  // namespace

Recording simulate(const Rig& rig, std::span<const plant::EffectSetting> effects,
                   const Experiment& experiment, const std::string& name, std::uint64_t seed,
                   const FilmCamera::Keep& keep_frame) {
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, effects);
    const std::uint64_t noise = noise_seed(name, seed);
    const bool sees = rig.camera && rig.fiducials;
    FIDSERVO_DEMAND(sees || !keep_frame);
    std::optional<PracticeCamera> practice;
    std::optional<FilmCamera> film;
    Look look;
    if (keep_frame) {
        film.emplace(rig, parameters, noise, keep_frame);
        look = std::bind_front(&FilmCamera::look, &*film);
    } else if (sees) {
        practice.emplace(rig, parameters, noise);
        look = std::bind_front(&PracticeCamera::look, &*practice);
    }
    PlantHardware hardware(parameters, experiment.carriage_mm, noise, std::move(look));
    return run_experiment(rig, experiment, name, hardware);
}

}  // namespace fidservo

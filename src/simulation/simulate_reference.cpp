// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/simulate_reference.h"

#include "reference/reference_rig.h"
#include "src/simulation/run_experiment.h"

namespace fidservo {

namespace {

class ReferenceHardware final : public SimulatedHardware {
  public:
    ReferenceHardware(const Rig& rig, const reference::Departures& departures, double carriage_mm,
                      std::uint64_t seed, std::vector<double>* way_mm, int substeps)
        : model_(reference::make_rig_model(rig, departures, substeps)),
          state_(reference::start(model_, carriage_mm, seed)),
          way_mm_(way_mm) {}

    Reading sample() override {
        const reference::Reading reading = reference::sample(model_, state_);
        return {reading.encoder_count, reading.hall_adc};
    }

    void look(TimeNs /*time_ns*/, double macro_V, double micro_V,
              std::vector<TagDetection>& detections) override {
        reference::look(model_, state_, macro_V, micro_V, detections);
    }

    void advance(double macro_V, double micro_V) override {
        if (way_mm_ != nullptr) {
            const reference::Truth there = reference::truth(model_, state_);
            way_mm_->push_back(there.carriage_mm + there.platform_mm);
        }
        reference::advance(model_, state_, macro_V, micro_V);
    }

  private:
    reference::RigModel model_;
    reference::State state_;
    std::vector<double>* way_mm_;
};

}  // namespace

Recording simulate_reference(const Rig& rig, const reference::Departures& departures,
                             const Experiment& experiment, const std::string& name, std::uint64_t seed,
                             std::vector<double>* way_mm, std::optional<int> substeps) {
    ReferenceHardware hardware(rig, departures, experiment.carriage_mm, noise_seed(name, seed), way_mm,
                               substeps.value_or(reference::default_substeps));
    return run_experiment(rig, experiment, name, hardware);
}

}  // namespace fidservo

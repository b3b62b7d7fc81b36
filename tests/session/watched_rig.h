// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A simulated rig whose true state is logged, tick by tick, while a session drives it through its devices.
#include "core/plate.h"
#include "core/result.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/session/session.h"
#include "src/session/simulated_rig.h"

#include <memory>
#include <utility>
#include <vector>

namespace fidservo {

class WatchedStage final : public control::Stage {
  public:
    explicit WatchedStage(std::shared_ptr<SimulatedRig> rig) : rig_(rig), stage_(std::move(rig), nullptr) {}

    Result<control::StageSample> read() override { return stage_.read(); }
    Status write(const control::StageCommand& command) override {
        history.push_back(rig_->truth());
        commands.push_back(command);
        return stage_.write(command);
    }

    std::vector<plant::StageState> history;  ///< states before each command
    std::vector<control::StageCommand> commands;

  private:
    std::shared_ptr<SimulatedRig> rig_;
    SimulatedStage stage_;
};

/// The reference rig's file, a true rig that may differ from it, and a session that knows the file only.
struct WatchedRig {
    WatchedRig(const plant::PlantParameters& physics, const Plate& printed, std::uint64_t seed)
        : WatchedRig(physics, printed, seed, load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml")) {}

    /// @param of  the rig file that the session knows
    WatchedRig(const plant::PlantParameters& physics, const Plate& printed, std::uint64_t seed, Rig of)
        : file(std::move(of)),
          nominal(plate_of(file.fiducials.value())),
          rig(std::make_shared<SimulatedRig>(physics, file.camera.value(), printed, seed)),
          stage(std::make_shared<WatchedStage>(rig)),
          session(SessionOptions{}, file, nominal, Devices{stage, std::make_shared<SimulatedCamera>(rig)}) {}

    Rig file;
    Plate nominal;
    std::shared_ptr<SimulatedRig> rig;
    std::shared_ptr<WatchedStage> stage;
    Session session;
};

inline plant::PlantParameters reference_physics() {
    return plant::plant_parameters(load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml"));
}

inline Plate reference_plate() {
    return plate_of(load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml").fiducials.value());
}

}  // namespace fidservo

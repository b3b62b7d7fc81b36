#pragma once
// A simulated rig whose truth a test writes down, tick by tick, while a session drives it through its
// devices.
#include "core/plate.h"
#include "core/result.h"
#include "src/config/plate_file.h"
#include "src/config/rig_file.h"
#include "src/session/session.h"
#include "src/session/simulated_rig.h"

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

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

    std::vector<plant::StageState> history;  ///< before each command
    std::vector<control::StageCommand> commands;

  private:
    std::shared_ptr<SimulatedRig> rig_;
    SimulatedStage stage_;
};

/// The reference rig's file, a rig that may differ from it, and a session that knows the file only.
struct WatchedRig {
    WatchedRig(const plant::PlantParameters& physics, const Plate& printed, std::uint64_t seed)
        : WatchedRig(physics, printed, seed, load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml")) {}

    /// @param of  what the session knows
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

/// The reference rig with a session that has homed it, seed 5. Homing is done once in a process, and
/// restored.
/// @param printed  as the reference plate where homing looks at it
inline std::unique_ptr<WatchedRig> homed_rig(const Plate& printed = reference_plate()) {
    static const auto homed = [] {
        WatchedRig rig(reference_physics(), reference_plate(), 5);
        EXPECT_TRUE(rig.session.home());
        return std::pair(rig.rig->snapshot(), rig.session.checkpoint());
    }();
    auto rig = std::make_unique<WatchedRig>(reference_physics(), printed, 5);
    rig->rig->restore(homed.first);
    rig->session.restore(homed.second);
    return rig;
}

}  // namespace fidservo

#include "src/session/devices.h"

#include "src/config/rig_file.h"
#include "src/session/camera_choice.h"
#include "src/session/faulty_devices.h"
#include "src/session/paced_stage.h"

#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {

namespace {

/// Where the guardian's files are. A folder of the program's own in the temporary folder goes when the
/// program ends in order, unless the guardian has logged something.
class GuardianFolder {
  public:
    explicit GuardianFolder(const SessionOptions& options) : temporary_(options.guardian_folder.empty()) {
        path_ = temporary_ ? std::filesystem::temp_directory_path() / fmt::format("fidservo-{}", getpid())
                           : options.guardian_folder;
        if (temporary_) std::filesystem::create_directories(path_);
    }
    ~GuardianFolder() {
        std::error_code ignored;
        if (temporary_ && !std::filesystem::exists(log_file(), ignored))
            std::filesystem::remove_all(path_, ignored);
    }
    GuardianFolder(const GuardianFolder&) = delete;
    GuardianFolder& operator=(const GuardianFolder&) = delete;

    std::filesystem::path log_file() const { return path_ / "guardian.log"; }
    std::filesystem::path board_file() const { return path_ / "stage-outputs"; }

  private:
    bool temporary_;
    std::filesystem::path path_;
};

/// A guardian process and its folder, which outlives it.
struct SimulationGuardian {
    explicit SimulationGuardian(const SessionOptions& options)
        : folder(options),
          guardian({.heartbeat = control::Heartbeat::process, .log_file = folder.log_file()},
                   [file = folder.board_file()] { return std::make_unique<control::SimulatedBoard>(file); }) {
    }

    GuardianFolder folder;
    control::Guardian guardian;
};

void demand_simulated_stage(const std::string& stage) {
    if (stage != "sim") throw InputError(fmt::format("--stage {}: no such device; allowed: sim", stage));
}

}  // namespace

RigDevices make_devices(const SessionOptions& options, const Rig& rig, const Plate& printed) {
    demand_simulated_stage(options.stage);
    const Rig truth = options.sim_rig_file.empty() ? rig : load_rig(options.sim_rig_file);
    if (!truth.camera || !truth.micro)
        throw InputError(fmt::format("{}: {}: missing; the simulated rig needs it",
                                     options.sim_rig_file.string(), truth.camera ? "micro" : "camera"));
    RigDevices devices;
    const auto guarding = std::make_shared<SimulationGuardian>(options);
    devices.guardian = std::shared_ptr<control::Guardian>(guarding, &guarding->guardian);
    const auto simulated =
        std::make_shared<SimulatedRig>(plant::plant_parameters(truth), *truth.camera, printed, options.seed);
    devices.stage = std::make_shared<SimulatedStage>(simulated, devices.guardian);
    if (camera_is_simulated(options)) {
        devices.simulated = simulated;
        devices.camera = std::make_shared<SimulatedCamera>(simulated);
    } else {
        devices.stage = std::make_shared<PacedStage>(devices.stage);
        devices.camera = open_camera(options, rig.camera.value());
    }
    if (!options.faults.empty()) {
        devices.stage = std::make_shared<FaultyStage>(devices.stage, options.faults);
        devices.camera = std::make_shared<FaultyCamera>(devices.camera, options.faults);
    }
    return devices;
}

}  // namespace fidservo

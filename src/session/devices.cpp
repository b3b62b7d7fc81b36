// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/devices.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/process/interrupt.h"
#include "src/session/camera_choice.h"
#include "src/session/faulty_devices.h"
#include "src/session/stage_choice.h"

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
struct GuardianInFolder {
    GuardianInFolder(const SessionOptions& options, control::Heartbeat heartbeat,
                     std::chrono::milliseconds patience, const control::BoardFactory& board)
        : folder(options),
          guardian({.heartbeat = heartbeat, .timeout = patience, .log_file = folder.log_file()}, board) {}
    explicit GuardianInFolder(const SessionOptions& options)
        : folder(options),
          guardian({.heartbeat = control::Heartbeat::process, .log_file = folder.log_file()},
                   [file = folder.board_file()] { return std::make_unique<control::SimulatedBoard>(file); }) {
    }

    GuardianFolder folder;
    control::Guardian guardian;
};

std::shared_ptr<control::Guardian> in_folder(std::shared_ptr<GuardianInFolder> both) {
    return {both, &both->guardian};
}

/// A drill's times are those of a session in virtual time.
void refuse_drills_of_real_devices(const SessionOptions& options) {
    if (options.faults.empty() || (stage_is_simulated(options) && camera_is_simulated(options))) return;
    throw InputError(
        fmt::format("--fault {}: drills are for the simulated rig; leave --stage and --camera out",
                    name_of(options.faults.front().kind)));
}

RigDevices real_devices(const SessionOptions& options, const Rig& rig) {
    if (camera_is_simulated(options))
        throw InputError(fmt::format(
            "--camera {}: does not see the stage {}; allowed beside it: v4l2:NODE (fidservo cameras)",
            options.camera, options.stage));
    const ComediChoice board(options, rig);
    RigDevices devices;
    devices.guardian = in_folder(std::make_shared<GuardianInFolder>(options, control::Heartbeat::loop,
                                                                    board.patience(), board.outputs()));
    devices.camera = open_camera(options, rig.camera.value());
    devices.loop = std::make_shared<control::StageLoop>(
        board.stage(devices.guardian),
        control::LoopOptions{
            .tick_s = rig.tick_s, .watchdog = board.watchdog(), .stop_requested = interrupt_requested});
    return devices;
}

}  // namespace

RigDevices make_devices(const SessionOptions& options, const Rig& rig, const Plate& printed) {
    refuse_drills_of_real_devices(options);
    if (!stage_is_simulated(options)) return real_devices(options, rig);
    const Rig truth = options.sim_rig_file.empty() ? rig : load_rig(options.sim_rig_file);
    if (!truth.camera || !truth.micro)
        throw InputError(fmt::format("{}: {}: missing; the simulated rig needs it",
                                     options.sim_rig_file.string(), truth.camera ? "micro" : "camera"));
    RigDevices devices;
    devices.guardian = in_folder(std::make_shared<GuardianInFolder>(options));
    const auto simulated =
        std::make_shared<SimulatedRig>(plant::plant_parameters(truth), *truth.camera, printed, options.seed);
    devices.stage = std::make_shared<SimulatedStage>(simulated, devices.guardian);
    if (camera_is_simulated(options)) {
        devices.simulated = simulated;
        devices.camera = std::make_shared<SimulatedCamera>(simulated);
    } else {
        devices.camera = open_camera(options, rig.camera.value());
        devices.loop = std::make_shared<control::StageLoop>(
            devices.stage, control::LoopOptions{
                               .tick_s = rig.tick_s, .watchdog = {}, .stop_requested = interrupt_requested});
    }
    if (!options.faults.empty()) {
        devices.stage = std::make_shared<FaultyStage>(devices.stage, options.faults);
        devices.camera = std::make_shared<FaultyCamera>(devices.camera, options.faults);
    }
    return devices;
}

}  // namespace fidservo

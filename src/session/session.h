// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A rig in use: stage, camera, controllers and vision put together, and the recording of all that happens.
// In simulation one thread runs everything in virtual time; same seed, same bytes.
#include "core/plate.h"
#include "core/result.h"
#include "src/files/recording/description.h"
#include "src/session/faults.h"
#include "src/session/machine.h"
#include "vision/camera.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct RecordingOptions;
struct Rig;

class LiveFeed;
class Pilot;

/// The position reached by a motion to a fiducial-relative target, as the camera measured it at rest.
struct Arrival {
    int tag_id = -1;                ///< the fiducial that was measured
    double target_dx_um = 0.0;      ///< target of the camera's axis, from that fiducial's centre
    double reached_dx_um = 0.0;     ///< position of the camera's axis, from that fiducial's centre
    double reached_std_um = 0.0;    ///< standard deviation of reached_dx_um
    double reached_dy_um = 0.0;     ///< position across the stage's axis
    double macro_time_s = 0.0;      ///< from the command to the settled macro stage
    double micro_time_s = 0.0;      ///< from the first micro setpoint to the confirmed arrival
    int micro_moves = 0;            ///< number of micro moves: the approach and its corrections
    bool within_tolerance = false;  ///< within the session's tolerance
};

/// Options of a session.
struct SessionOptions {
    std::filesystem::path rig_file;  ///< of the rig that is driven
    /// The rig that is simulated, where it differs from what rig_file says; the program never sees it. Empty:
    /// rig_file.
    std::filesystem::path sim_rig_file;
    std::string stage = "sim";        ///< sim | comedi:/dev/comedi0
    std::string camera = "sim";       ///< sim | v4l2:/dev/video0 | images:DIR
    std::uint64_t seed = 1;           ///< seed of the simulated rig's noise
    double tolerance_um = 1.0;        ///< tolerance of a motion's arrival
    double camera_reconnect_s = 0.0;  ///< how long to wait for a camera that is lost
    std::vector<Fault> faults;        ///< faults to be simulated in stage and camera, as a drill
    /// What recordings state besides stage, camera and program: unit and labels.
    RecordingOrigin origin = {};
    /// Whether recordings state the time of their beginning; otherwise the same seed gives the same bytes.
    bool recordings_state_time = false;
    /// Folder of the guardian's files: FOLDER/stage-outputs, FOLDER/guardian.log. Empty: a temporary folder.
    std::filesystem::path guardian_folder;
};

/// Whether a recording keeps images, or only the tags found in them.
enum class KeepFrames {
    no,   ///< only the tags found
    yes,  ///< the images too
};

/// Assembles a machine, homes it, moves it and takes images at rest. In any case it ends with both stage
/// commands zero.
class Session {
  public:
    /// @param nominal  the plate as it should be: what the program knows
    /// @param printed  the plate as it is: only the simulated camera sees it
    Session(const SessionOptions& options, const Rig& rig, const Plate& nominal, const Plate& printed);
    /// The same with given devices; such a session has no checkpoints of its hardware.
    Session(const SessionOptions& options, const Rig& rig, const Plate& nominal, Devices devices);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Starts a recording folder (EuRoC layout); all ticks and detections go there until the next call.
    void record_to(const std::filesystem::path& folder, const std::string& experiment,
                   KeepFrames keep_frames = KeepFrames::no);
    /// The same with name, experiment, controllers and frames as the options state.
    void record_to(const std::filesystem::path& folder, RecordingOptions recording);
    /// Closes the recording; all of it is on the disk then.
    Status end_recording();
    /// Leaves the recording as it is, unfinished.
    void leave_recording();

    /// End stop, registration against a tag, and the tuning sweep of the micro stage.
    Status home();
    /// Brings the camera's axis to tag + dx along the stage axis, and confirms it at rest.
    Result<Arrival> go_to(int tag_id, double dx_mm);
    /// Whether something is wrong with the images, so that a fiducial may not be found although it is there.
    bool camera_is_in_doubt() const;
    /// Checks whether the rig still responds, after a motion that did not end as it should (rig_check.h).
    Status check_rig();
    /// A frame taken at rest, with the stage confirmed at rest before and after the exposure.
    Result<vision::Frame> capture();
    /// Holds the position for a while.
    Status hold(double duration_s);
    /// Holds the position and records the tags in every frame; also the frames, if they are to be kept.
    Status observe(double duration_s);
    /// Records the tags of a frame that has just arrived, as far as their corners can be measured
    /// (vision/tags/tag_refinement.h); also the frame, if frames are kept.
    Status look();

    /// Shows everything on the live page from now on.
    void show_to(std::shared_ptr<LiveFeed> feed);
    /// Switches motor and heater off at once and ends the run at its next tick. Any thread may call it, also
    /// while the session is busy, but not after its end.
    void stop_now() noexcept;
    /// Waits, at rest and holding its place, until the condition is gone or the user stops the run. A stage
    /// in virtual time stands still meanwhile.
    Status wait_while(const std::function<bool()>& condition);

    /// The rig in operation, for commands with motions of their own.
    Pilot& pilot();

    /// Where the camera's axis was at the last confirmed arrival, plate frame, mm.
    Eigen::Vector2d camera_mm() const;
    /// What has become of the camera's frames so far.
    vision::FrameCounts frame_counts() const;
    /// How punctual the control loop is; empty in simulated time.
    std::optional<control::LoopStatistics> loop_statistics() const;
    /// Session time on the rig's clock.
    double now_s() const;
    /// Session time since the first tick.
    double elapsed_s() const;

    /// The state that a later process needs to continue from here without a difference (JSON text). For a
    /// simulated rig it includes the rig itself.
    std::string checkpoint() const;
    /// Continues from a checkpoint. Throws InputError if the text is none.
    void restore(const std::string& checkpoint);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo

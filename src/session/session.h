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

/// What a motion to a fiducial-relative target reached, as the camera measured it at rest.
struct Arrival {
    int tag_id = -1;                ///< the fiducial that was measured
    double target_dx_um = 0.0;      ///< of the camera's axis from that fiducial's centre
    double reached_dx_um = 0.0;     ///< of the camera's axis from that fiducial's centre
    double reached_std_um = 0.0;    ///< one standard deviation of that
    double reached_dy_um = 0.0;     ///< across the stage's axis
    double macro_time_s = 0.0;      ///< from the command to the settled macro stage
    double micro_time_s = 0.0;      ///< from the first micro setpoint to the confirmed arrival
    int micro_moves = 0;            ///< the approach and its corrections
    bool within_tolerance = false;  ///< whether it is as near as the session was told
};

/// What the session was told.
struct SessionOptions {
    std::filesystem::path rig_file;  ///< of the rig that is driven
    /// The rig that is simulated, where it differs from what rig_file says; the program never sees it. Empty:
    /// rig_file.
    std::filesystem::path sim_rig_file;
    std::string stage = "sim";        ///< sim | comedi:/dev/comedi0
    std::string camera = "sim";       ///< sim | v4l2:/dev/video0 | images:DIR
    std::uint64_t seed = 1;           ///< of the simulated rig's noise
    double tolerance_um = 1.0;        ///< of a motion's arrival
    double camera_reconnect_s = 0.0;  ///< a camera that is lost is waited for so long
    std::vector<Fault> faults;        ///< put into stage and camera: a drill
    /// What recordings say of themselves beside stage, camera and program: unit and labels.
    RecordingOrigin origin = {};
    /// Whether they say when they began, by the clock; otherwise the same seed gives the same bytes.
    bool recordings_state_time = false;
    /// What the guardian's board file and log are called: FOLDER/stage-outputs, FOLDER/guardian.log. Empty: a
    /// temporary folder.
    std::filesystem::path guardian_folder;
};

/// Does a recording keep the images too, or only what was found in them?
enum class KeepFrames {
    no,   ///< what was found in them
    yes,  ///< the images too
};

/// Puts a machine together, homes it, moves it and takes pictures at rest. Ends with both stage commands
/// zero, whatever happens.
class Session {
  public:
    /// @param nominal  the plate as it should be: what the program knows
    /// @param printed  the plate as it is: only the simulated camera sees it
    Session(const SessionOptions& options, const Rig& rig, const Plate& nominal, const Plate& printed);
    /// The same on devices that somebody else made; such a session has no checkpoints of its hardware.
    Session(const SessionOptions& options, const Rig& rig, const Plate& nominal, Devices devices);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Starts a recording folder (EuRoC layout); all ticks and detections go there until the next call.
    void record_to(const std::filesystem::path& folder, const std::string& experiment,
                   KeepFrames keep_frames = KeepFrames::no);
    /// The same with a name, an experiment, controllers and frames as the options have them.
    void record_to(const std::filesystem::path& folder, RecordingOptions recording);
    /// Closes the recording; all of it is on the disk then.
    Status end_recording();
    /// Leaves the recording as it is, unfinished.
    void leave_recording();

    /// End stop, registration against a tag, and the tuning sweep of the micro stage.
    Status home();
    /// Brings the camera's axis to tag + dx along the stage axis, and confirms it at rest.
    Result<Arrival> go_to(int tag_id, double dx_mm);
    /// Whether something is wrong with the images, so that a fiducial that is not found need not be missing.
    bool camera_is_in_doubt() const;
    /// Whether the rig still answers, for when a motion did not end as it should (rig_check.h).
    Status check_rig();
    /// A frame taken at rest, with the stage confirmed at rest before and after the exposure.
    Result<vision::Frame> capture();
    /// Holds the position for a while.
    Status hold(double duration_s);
    /// The same, and keeps what every frame shows in the recording; the frames too, if they are to be kept.
    Status observe(double duration_s);
    /// Keeps the tags of a frame that has just arrived in the recording, as far as their corners can be
    /// measured (vision/tags/tag_refinement.h); the frame too, if frames are kept.
    Status look();

    /// All that happens from now on is shown there too.
    void show_to(std::shared_ptr<LiveFeed> feed);
    /// Switches motor and heater off at once and ends the run at its next tick. Any thread may call it, also
    /// while the session is busy, but not after its end.
    void stop_now() noexcept;
    /// Waits, at rest and holding its place, until the condition is gone or the user stops the run. A stage
    /// in virtual time stands still meanwhile.
    Status wait_while(const std::function<bool()>& condition);

    /// The rig under way, for commands that move it in ways of their own.
    Pilot& pilot();

    /// Where the camera's axis was at the last confirmed arrival, plate frame, mm.
    Eigen::Vector2d camera_mm() const;
    /// What became of the camera's frames so far.
    vision::FrameCounts frame_counts() const;
    /// How punctual the control loop is; empty in simulated time.
    std::optional<control::LoopStatistics> loop_statistics() const;
    /// Session time on the rig's clock.
    double now_s() const;
    /// The same since the first tick.
    double elapsed_s() const;

    /// All that a later process needs to go on from here as if nothing had happened (JSON text). On a
    /// simulated rig that includes the rig itself.
    std::string checkpoint() const;
    /// Goes on from there. Throws InputError if the text is not a checkpoint.
    void restore(const std::string& checkpoint);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo

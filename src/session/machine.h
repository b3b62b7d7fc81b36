#pragma once
// The one loop: sample, control, write, record; a tick at a time.
#include "control/stage.h"
#include "core/recording.h"
#include "core/rig.h"
#include "src/recording/writer.h"
#include "src/session/camera_watch.h"
#include "vision/camera.h"

#include <concepts>
#include <memory>
#include <optional>

namespace fidservo {

/// The hardware, or what stands for it.
struct Devices {
    std::shared_ptr<control::Stage> stage;
    std::shared_ptr<vision::Camera> camera;
};

class LiveFeed;

/// Set points to be recorded beside a command; NaN: not in force.
struct Setpoints {
    double macro_mm = not_in_force;
    double micro_mm = not_in_force;
};

class Machine {
  public:
    Machine(Devices devices, const CameraWatchParams& watch)
        : devices_(std::move(devices)), camera_watch_(watch) {}
    /// Leaves both commands at zero.
    ~Machine();
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    /// One tick: control(sample) gives the command. Fails with Reason::stopped if the user interrupts, with
    /// Reason::device if stage or recorder fail; the commands are then zero.
    template <std::invocable<const control::StageSample&> Control>
    Status tick(Control&& control, const Setpoints& setpoints = {}) {
        const auto sample = begin_tick();
        if (!sample) return tl::make_unexpected(sample.error());
        return end_tick(*sample, control(*sample), setpoints);
    }

    /// The newest frame, if a new one has arrived by the last tick. Fails with Reason::device where the
    /// camera does, or where what it gives cannot be an image taken now (camera_watch.h).
    Result<std::optional<vision::Frame>> poll_camera();
    /// Whether something was wrong with its last frame; not for long enough to be a fault.
    bool camera_is_in_doubt() const { return camera_watch_.is_in_doubt(); }
    /// Keeps detections in the recording.
    Status keep(const std::vector<TagDetection>& detections);
    /// Keeps a frame in the recording, which must be one that keeps frames.
    Status keep(const vision::Frame& frame);
    vision::FrameCounts frame_counts() const { return devices_.camera->counts(); }

    /// All ticks from now on go to this recording; null: none.
    void record_to(std::unique_ptr<RecordingWriter> recorder) { recorder_ = std::move(recorder); }
    /// Closes the recording; all of it is on the disk then.
    Status end_recording();

    /// All that happens from now on is shown there too.
    void show_to(std::shared_ptr<LiveFeed> feed) { feed_ = std::move(feed); }

    TimeNs now_ns() const { return now_ns_; }
    void set_now(TimeNs now_ns) { now_ns_ = now_ns; }
    /// From the first tick to the last.
    TimeNs elapsed_ns() const { return first_ns_ ? now_ns_ - *first_ns_ : 0; }

    /// Both commands to zero.
    Status switch_off();

  private:
    Result<control::StageSample> begin_tick();
    Status end_tick(const control::StageSample& sample, const control::StageCommand& command,
                    const Setpoints& setpoints);

    Devices devices_;
    CameraWatch camera_watch_;
    control::StageSample sample_;  ///< of the last tick
    std::unique_ptr<RecordingWriter> recorder_;
    std::shared_ptr<LiveFeed> feed_;
    TimeNs now_ns_ = 0;
    std::optional<TimeNs> first_ns_;
};

}  // namespace fidservo

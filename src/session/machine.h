// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The one loop: sample, control, write, record; a tick at a time.
//
// In virtual time the calling thread ticks the stage itself. In real time a StageLoop does, in a thread of
// its own (control/stage_loop.h): controllers run there, the rows are recorded here, and samples of ticks
// without a controller can be passed to one afterwards, whose commands are then ignored.
#include "control/stage.h"
#include "control/stage_loop.h"
#include "core/recording.h"
#include "core/result.h"
#include "src/files/recording/writer.h"
#include "src/session/camera_watch.h"
#include "vision/camera.h"

#include <atomic>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>

namespace fidservo {

/// The real or simulated devices.
struct Devices {
    std::shared_ptr<control::Stage> stage;  ///< ticked by the machine; unused where there is a loop
    std::shared_ptr<vision::Camera> camera;
    std::shared_ptr<control::StageLoop> loop = nullptr;  ///< ticks in real time; null in virtual time
};

class LiveFeed;

/// Set points to be recorded with a command; NaN: not in force.
struct Setpoints {
    double macro_mm = not_in_force;
    double micro_mm = not_in_force;
};

class Machine {
  public:
    Machine(Devices devices, const CameraWatchParams& watch)
        : devices_(std::move(devices)), camera_watch_(watch) {}
    /// Sets both commands to zero.
    ~Machine();
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    /// One tick: control(sample) gives the command. Fails with Reason::stopped if the user interrupts, with
    /// Reason::device if stage or recorder fail; the commands are then zero. In real time, a tick that passed
    /// without a controller may be processed first.
    template <std::invocable<const control::StageSample&> Control>
    Status tick(Control&& control, const Setpoints& setpoints = {}) {
        if (devices_.loop) {
            if (const auto held = devices_.loop->next()) return make_up(*held, control, setpoints);
            return run_in_loop(
                control, [] { return true; }, setpoints, no_meanwhile);
        }
        const auto sample = begin_tick();
        if (!sample) return tl::make_unexpected(sample.error());
        return end_tick(*sample, control(*sample), setpoints);
    }

    /// Ticks until done(). In real time control and done are called in the loop's thread, which has what they
    /// work on to itself meanwhile: they must not wait, lock or allocate. meanwhile() is called in this
    /// thread, now and then (in virtual time after each tick); its failure ends the ticks.
    template <std::invocable<const control::StageSample&> Control, std::predicate Done,
              std::invocable Meanwhile>
    Status run(Control&& control, Done&& done, const Setpoints& setpoints, Meanwhile&& meanwhile) {
        if (devices_.loop) {
            if (auto skipped = skip_held(); !skipped) return skipped;
            return done() ? Status() : run_in_loop(control, done, setpoints, meanwhile);
        }
        while (!done()) {
            if (auto ticked = tick(control, setpoints); !ticked) return ticked;
            if (auto seen = meanwhile(); !seen) return seen;
        }
        return {};
    }
    template <std::invocable<const control::StageSample&> Control, std::predicate Done>
    Status run(Control&& control, Done&& done, const Setpoints& setpoints = {}) {
        return run(control, done, setpoints, no_meanwhile);
    }

    /// Passes all ticks without a controller to one; there are none in virtual time.
    template <std::invocable<const control::StageSample&> Control>
    Status catch_up(Control&& control, const Setpoints& setpoints = {}) {
        if (!devices_.loop) return {};
        while (const auto held = devices_.loop->next())
            if (auto made = make_up(*held, control, setpoints); !made) return made;
        return {};
    }

    /// The newest frame, if a new one has arrived by the last tick. Fails with Reason::device where the
    /// camera does, or where what it gives cannot be an image taken now (camera_watch.h).
    Result<std::optional<vision::Frame>> poll_camera();
    /// Whether something is wrong with the last frame, but not yet for long enough to be a fault.
    bool camera_is_in_doubt() const { return camera_watch_.is_in_doubt(); }
    /// Records the measured tags, and shows the found ones on the live page.
    Status keep(const std::vector<TagDetection>& found, const std::vector<TagDetection>& measured);
    /// Keeps a frame in the recording, which must be one that keeps frames.
    Status keep(const vision::Frame& frame);
    vision::FrameCounts frame_counts() const { return devices_.camera->counts(); }

    /// All ticks from now on go to this recording; null: none.
    void record_to(std::unique_ptr<RecordingWriter> recorder);
    /// Closes the recording; all of it is on the disk then.
    /// @param zero  the encoder's zero, as far as it is known
    Status end_recording(const std::optional<EncoderZero>& zero = {});
    /// Ends the recording as unfinished; everything is on the disk then, if the disk takes it.
    void leave_recording(const std::optional<EncoderZero>& zero = {});
    bool is_recording() const { return recorder_ != nullptr; }
    /// Records an event that happens now.
    void note(std::string what, std::string text);

    /// Shows everything on the live page from now on.
    void show_to(std::shared_ptr<LiveFeed> feed) { feed_ = std::move(feed); }

    /// The sample of the last tick.
    const control::StageSample& last_sample() const { return sample_; }
    TimeNs now_ns() const { return now_ns_; }
    void set_now(TimeNs now_ns) { now_ns_ = now_ns; }
    /// Time from the first tick to the last.
    TimeNs elapsed_ns() const { return first_ns_ ? now_ns_ - *first_ns_ : 0; }

    /// Sets the travel's ends in encoder counts, for the watchdog.
    void set_travel(const control::CarriageTravel& travel);
    /// How punctual the loop is; empty in virtual time.
    std::optional<control::LoopStatistics> loop_statistics() const;

    /// Sets both commands to zero, for good.
    Status switch_off();

  private:
    static Status no_meanwhile() { return {}; }

    Result<control::StageSample> begin_tick();
    Status end_tick(const control::StageSample& sample, const control::StageCommand& command,
                    const Setpoints& setpoints);

    /// The program that is given to the loop.
    template <class Control, class Done>
    struct Call {
        Control& control;
        Done& done;
        const Setpoints& setpoints;
        std::atomic<bool> abandoned{false};

        static control::LoopStep tick(void* self, const control::StageSample& sample) {
            auto& call = *static_cast<Call*>(self);
            const control::StageCommand command = call.control(sample);
            const bool done = call.done() || call.abandoned.load(std::memory_order_relaxed);
            return {command, call.setpoints.macro_mm, call.setpoints.micro_mm, done};
        }
    };

    template <class Control, class Done, class Meanwhile>
    Status run_in_loop(Control& control, Done&& done, const Setpoints& setpoints, Meanwhile& meanwhile) {
        Call<Control, std::remove_reference_t<Done>> call{control, done, setpoints};
        devices_.loop->start({&call, call.tick});
        Status went;
        for (bool was_last = false; !was_last;) {
            const bool ended = devices_.loop->ended().has_value();
            if (!ended) wait_for_ticks();
            Status now = record_ticks(was_last);
            if (now && !was_last) now = meanwhile();
            if (!now && went) {
                went = now;
                call.abandoned.store(true, std::memory_order_relaxed);
            }
            if (ended) break;
        }
        if (const auto why = devices_.loop->ended()) return note_end(*why);
        return went;
    }

    /// Passes a tick without a controller to one; its command is ignored.
    template <class Control>
    Status make_up(const control::TickRecord& held, Control& control, const Setpoints& setpoints) {
        (void)control(held.sample);
        return record(held.sample, held.step.command, setpoints);
    }

    /// Takes out the recording's writer, after its last statements.
    std::unique_ptr<RecordingWriter> take_recorder(const std::optional<EncoderZero>& zero);
    /// Records the event that ended the run.
    tl::unexpected<Failure> note_end(Failure why);
    /// Records how many frames the camera has lost or damaged since the last such event.
    void note_missing_frames();
    void wait_for_ticks();
    /// Records the loop's ticks, up to the last one of a program.
    Status record_ticks(bool& was_last);
    Status skip_held();
    Status record(const control::StageSample& sample, const control::StageCommand& command,
                  const Setpoints& setpoints);

    Devices devices_;
    CameraWatch camera_watch_;
    control::StageSample sample_;  ///< of the last tick
    std::unique_ptr<RecordingWriter> recorder_;
    bool end_noted_ = false;      ///< the end was recorded as an event
    vision::FrameCounts counts_;  ///< counts when missing frames were last recorded
    TimeNs counted_ns_ = 0;
    std::shared_ptr<LiveFeed> feed_;
    TimeNs now_ns_ = 0;
    std::optional<TimeNs> first_ns_;
};

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The 1 kHz loop of a rig in real time: a thread of its own samples the stage at absolute deadlines, lets the
// program that was handed to it control, and writes. It shares no lock with anybody and allocates nothing.
//
//     session thread                                    loop thread
//     start(program), wait() ........................>  read, program.tick, write, record, every tick
//     next(): the record of each tick, in order  <....  ring of a minute
//
// A program has its state to itself until it has ended. Between programs, while the session looks at an
// image or writes to the disk, the loop goes on with the last command: a tick that is held. Where the command
// is constant anyway (motor off, wire held), nothing is missed; a motor that runs without a program is an
// alarm.
#include "control/loop_statistics.h"
#include "control/stage.h"
#include "control/watchdog.h"
#include "core/failure.h"
#include "core/result.h"
#include "core/spsc_ring.h"
#include "core/wake_signal.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

namespace fidservo::control {

/// What a program answers to a sample.
struct LoopStep {
    StageCommand command;
    double macro_setpoint_mm;  ///< to be recorded; NaN: not in force
    double micro_setpoint_mm;
    bool done = false;  ///< this was the program's last tick
};

/// Called in the loop's thread: must not wait, lock or allocate.
struct LoopProgram {
    void* self = nullptr;
    LoopStep (*tick)(void* self, const StageSample& sample) = nullptr;
};

/// One tick, as it was.
struct TickRecord {
    StageSample sample;
    LoopStep step;
    bool held = false;
};

struct LoopOptions {
    double tick_s = 0.001;
    std::optional<WatchdogParams> watchdog;
    /// Asked at every tick; once it says yes the commands are zero. Null: nobody asks.
    bool (*stop_requested)() noexcept = nullptr;
    double ring_s = 60.0;  ///< the session may be away for so long
};

class StageLoop {
  public:
    /// Starts ticking, with both commands at zero. Samples are of the time of their deadline;
    /// ticks that are missed by a whole period are left out. SCHED_FIFO and
    /// locked memory are taken where that is permitted (statistics() says). Throws RunFault where the system
    /// has no thread left.
    StageLoop(std::shared_ptr<Stage> stage, const LoopOptions& options);
    /// As stop().
    ~StageLoop();
    StageLoop(const StageLoop&) = delete;
    StageLoop& operator=(const StageLoop&) = delete;

    /// The loop runs the program from the next tick on until it says that it is done, or the loop has ended.
    /// Demands that none is running.
    void start(const LoopProgram& program);
    bool running() const { return running_.load(std::memory_order_acquire); }
    /// Waits until the program has ended, for a limited time.
    void wait(std::chrono::milliseconds limit) const;

    /// The oldest tick that was not yet taken. The ring is full after ring_s: the loop then ends rather than
    /// lose a tick.
    std::optional<TickRecord> next();

    /// Why the commands are zero for good: the stage failed, the watchdog, somebody asked to stop.
    std::optional<Failure> ended() const;

    /// The travel's ends in counts, for the watchdog, once they are known.
    void set_travel(const CarriageTravel& travel);

    LoopStatistics statistics() const;

    /// Both commands to zero, and no more ticks.
    Status stop();

  private:
    struct Shared;
    void run(const std::stop_token& stop);
    /// Waits for the next tick's time. Where a whole tick has passed by then, for the one after, so that what
    /// is sampled and commanded is of the time that is recorded; once, however late that one is.
    /// @return how many ticks were left out
    int wait_for_deadline(TimeNs period_ns);
    int skip_missed(TimeNs period_ns, TimeNs late_ns);
    bool tick(int ticks_late);
    LoopStep decide(const StageSample& sample, bool& held);
    void end(Failure why);
    void count(TimeNs late_ns, int ticks_late);

    std::shared_ptr<Stage> stage_;
    LoopOptions options_;
    SpscRing<TickRecord> ring_;
    WakeSignal wake_;  ///< the program has ended
    // Handed to the loop: the program before running_, the travel before its flag.
    LoopProgram program_;
    std::atomic<bool> running_{false};
    std::atomic<double> low_count_{0.0}, high_count_{0.0};
    std::atomic<bool> has_travel_{false};
    // Handed to the session: the failure before its flag.
    Failure why_{Reason::stopped, ""};
    std::atomic<bool> ended_{false};
    // The loop's own; the numbers of it that statistics() reads are published as they change.
    std::unique_ptr<Shared> counters_;
    WatchdogState watchdog_{};
    StageCommand last_{};
    TimeNs deadline_ns_ = 0;
    std::jthread thread_;
};

}  // namespace fidservo::control

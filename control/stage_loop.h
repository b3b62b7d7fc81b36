// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The 1 kHz loop of a rig in real time: a thread of its own samples the stage at absolute deadlines, calls
// the program that was handed to it for the commands, and writes them. The thread shares no lock with others
// and allocates nothing.
//
//     session thread                                    loop thread
//     start(program), wait() ........................>  read, program.tick, write, record, every tick
//     next(): the record of each tick, in order  <....  ring of a minute
//
// No other thread may touch a program's state until it has ended. Between programs, while the session looks
// at an image or writes to the disk, the loop goes on with the last command: a tick that is held. Where the
// command is constant anyway (motor off, wire held), nothing is missed; a motor that runs without a program
// is an alarm.
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

/// A program's answer to a sample.
struct LoopStep {
    StageCommand command;
    double macro_setpoint_mm;  ///< setpoints for the recording; NaN: none in force
    double micro_setpoint_mm;
    bool done = false;  ///< this was the program's last tick
};

/// A control program. tick() is called in the loop's thread: it must not wait, lock or allocate.
struct LoopProgram {
    void* self = nullptr;
    LoopStep (*tick)(void* self, const StageSample& sample) = nullptr;
};

/// The record of one tick; `held` where no program ran and the last command went on.
struct TickRecord {
    StageSample sample;
    LoopStep step;
    bool held = false;
};

struct LoopOptions {
    double tick_s = 0.001;
    std::optional<WatchdogParams> watchdog;
    /// Called at every tick; once it returns true the commands are set to zero. Null: nothing is called.
    bool (*stop_requested)() noexcept = nullptr;
    /// Length of the ring of records: the longest time for which the session may fetch none.
    double ring_s = 60.0;
};

class StageLoop {
  public:
    /// Starts ticking, with both commands at zero. A sample's time is its tick's deadline; ticks that are
    /// late by a whole period are left out. SCHED_FIFO and locked memory are used where that is permitted;
    /// statistics() tells. Throws RunFault where the system has no thread left.
    StageLoop(std::shared_ptr<Stage> stage, const LoopOptions& options);
    /// Does what stop() does.
    ~StageLoop();
    StageLoop(const StageLoop&) = delete;
    StageLoop& operator=(const StageLoop&) = delete;

    /// Runs the program from the next tick on until it says that it is done, or the loop has ended. Demands
    /// that no program is running.
    void start(const LoopProgram& program);
    bool running() const { return running_.load(std::memory_order_acquire); }
    /// Waits until the program has ended, for a limited time.
    void wait(std::chrono::milliseconds limit) const;

    /// The record of the oldest tick that was not fetched yet. When the ring is full, after ring_s, the loop
    /// ends rather than lose a record.
    std::optional<TickRecord> next();

    /// Why the commands are zero for good: the stage failed, the watchdog raised an alarm, or a stop was
    /// requested.
    std::optional<Failure> ended() const;

    /// The travel's ends in counts, for the watchdog, once they are known.
    void set_travel(const CarriageTravel& travel);

    LoopStatistics statistics() const;

    /// Sets both commands to zero and ends the thread.
    Status stop();

  private:
    struct Shared;
    void run(const std::stop_token& stop);
    /// Waits for the next tick's deadline. Where that is already past by a whole period or more, the missed
    /// ticks are left out and the next deadline is waited for instead, so that samples and commands belong to
    /// the time that is recorded; that is done once, however late the next one is.
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
    WakeSignal wake_;  ///< raised when the program has ended
    // Handed to the loop: program_ is written before running_, the travel before has_travel_.
    LoopProgram program_;
    std::atomic<bool> running_{false};
    std::atomic<double> low_count_{0.0}, high_count_{0.0};
    std::atomic<bool> has_travel_{false};
    // Handed to the session: why_ is written before ended_.
    Failure why_{Reason::stopped, ""};
    std::atomic<bool> ended_{false};
    // The loop thread's own. The counters that statistics() reads are published as they change.
    std::unique_ptr<Shared> counters_;
    WatchdogState watchdog_{};
    StageCommand last_{};
    TimeNs deadline_ns_ = 0;
    std::jthread thread_;
};

}  // namespace fidservo::control

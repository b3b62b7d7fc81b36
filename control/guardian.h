// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The guardian: a small process of its own that owns the stage's output board and sets both outputs to zero
// (motor and heater off) when the program is no longer in control of them: it ended in whatever way (signal,
// crash, exception, exit), was stopped, or its heartbeat is missing.
//
// The program hands its commands over in shared memory and never touches the board. A guardian that has
// switched the outputs off stays so until the run ends: the program has to start anew.
#include "control/output_board.h"
#include "core/result.h"
#include "core/wake_signal.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <sys/types.h>

namespace fidservo::control {

struct GuardianMemory;

/// What shows that the program is alive.
enum class Heartbeat {
    loop,     ///< every apply(), from the first on: a real rig, whose loop runs at 1 kHz
    process,  ///< a thread of the guardian's: a simulation in virtual time, whose ticks have no wall-clock
              ///< time
};

/// How a guardian watches.
struct GuardianOptions {
    Heartbeat heartbeat = Heartbeat::loop;  ///< whose heartbeat
    std::chrono::milliseconds timeout{20};  ///< without a heartbeat, until the outputs are set to zero
    /// A line is appended when the guardian had to act; empty: none.
    std::filesystem::path log_file;
};

/// A process that owns the outputs, and switches them off when this one is gone or silent.
class Guardian {
  public:
    /// Starts the guardian process, which opens the board and sets it to zero. Call it before the program
    /// starts threads. Throws RunFault if the process or the board does not come up.
    Guardian(GuardianOptions options, BoardFactory open_board);
    /// As finish().
    ~Guardian();
    Guardian(const Guardian&) = delete;
    Guardian& operator=(const Guardian&) = delete;

    /// Hands a command to the board; also the heartbeat, with Heartbeat::loop. Lock-free. Outputs have the
    /// resolution of a float, 24 bit. With Heartbeat::process the board follows within 4 ms of wall-clock
    /// time, and commands that are replaced sooner never show on it.
    void apply(const StageCommand& command) noexcept;

    /// Outputs to zero, for good: apply() has no effect from then on, also one that is under way. For any
    /// thread, while the program's own is busy. Lock-free.
    void stop() noexcept;

    /// Why the outputs were set to zero, once that has happened. From then on apply() has no effect: end the
    /// run with Reason::stopped. Cheap enough for every tick.
    std::optional<std::string> tripped() const;

    /// Sets the outputs to zero, waits for the board's confirmation and ends the guardian process. Fails with
    /// Reason::device if the board did not confirm. Later calls do nothing.
    Status finish();

    /// The guardian's process.
    pid_t pid() const { return process_; }

  private:
    void start();
    void hand_over(const StageCommand& command) noexcept;
    void watch(const std::stop_token& stop);
    void take_over() noexcept;

    struct Unmap {
        void operator()(GuardianMemory* memory) const;
    };

    GuardianOptions options_;
    BoardFactory open_board_;
    std::unique_ptr<GuardianMemory, Unmap> memory_;
    WakeSignal wake_;  ///< ends the guardian's sleep
    std::atomic<bool> stopped_ = false;
    pid_t process_ = -1;
    int process_fd_ = -1;
    bool off_after_loss_ = false;  ///< the board confirmed zero after the guardian process was lost
    std::jthread watcher_;
};

}  // namespace fidservo::control

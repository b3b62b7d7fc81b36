// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The guardian: a small process of its own that owns the stage's output board and sets both outputs to zero
// (motor and heater off) as soon as the program has ended (signal, crash, exception, exit), was stopped, or
// its heartbeat is missing.
//
// The program hands its commands over in shared memory and never touches the board. Once a guardian has
// switched the outputs off they stay off until the run ends; only a new run can switch them on.
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

/// What counts as the program's heartbeat.
enum class Heartbeat {
    loop,  ///< every apply(), from the first one on: for a real rig, whose loop runs at 1 kHz
    /// a thread that beats while the program lives: for a simulation in virtual time, whose ticks keep no
    /// wall-clock time.
    process,
};

/// How a guardian watches.
struct GuardianOptions {
    Heartbeat heartbeat = Heartbeat::loop;  ///< what counts as the heartbeat
    /// Time without a heartbeat after which the outputs are set to zero.
    std::chrono::milliseconds timeout{20};
    /// The file to which a line is appended when the guardian had to act; empty: none.
    std::filesystem::path log_file;
};

/// The program's handle on the guardian process, which owns the outputs and switches them off when the
/// program is gone or silent.
class Guardian {
  public:
    /// Starts the guardian process, which opens the board and sets it to zero. Call it before the program
    /// starts threads. Throws RunFault if the process or the board does not come up.
    Guardian(GuardianOptions options, BoardFactory open_board);
    /// Does what finish() does.
    ~Guardian();
    Guardian(const Guardian&) = delete;
    Guardian& operator=(const Guardian&) = delete;

    /// Hands a command to the board; with Heartbeat::loop each call is a heartbeat, too. Lock-free. Outputs
    /// have the resolution of a float, 24 bit. With Heartbeat::process the board follows within 4 ms of
    /// wall-clock time, and commands that are replaced sooner never show on it.
    void apply(const StageCommand& command) noexcept;

    /// Sets the outputs to zero for good: apply() has no effect from then on, and a call of it that is under
    /// way has none either. May be called from any thread at any time. Lock-free.
    void stop() noexcept;

    /// Why the outputs were set to zero, once that has happened; empty before. apply() then has no effect:
    /// the caller is to end the run with Reason::stopped. Cheap enough for every tick.
    std::optional<std::string> tripped() const;

    /// Sets the outputs to zero, waits for the board's confirmation and ends the guardian process. Fails with
    /// Reason::device if the board did not confirm. Later calls do nothing.
    Status finish();

    /// The guardian process's id.
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
    WakeSignal wake_;  ///< wakes the guardian process
    std::atomic<bool> stopped_ = false;
    pid_t process_ = -1;
    int process_fd_ = -1;
    bool off_after_loss_ = false;  ///< the guardian process was lost, and the board has confirmed zero since
    std::jthread watcher_;
};

}  // namespace fidservo::control

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which stage `--stage` stands for.
#include "control/guardian.h"
#include "control/watchdog.h"
#include "src/session/session.h"

#include <chrono>
#include <memory>

namespace fidservo {

struct Rig;

/// "sim".
bool stage_is_simulated(const SessionOptions& options);

/// A board that was looked at and found to be as the rig file says; nothing is driven yet.
class ComediChoice {
  public:
    /// Opens the node of "comedi:NODE" and checks the channels of the rig file's `stage.comedi` against it.
    /// Throws InputError for another word, a device that is not there or channels that it does not have;
    /// RunFault where the board does not open.
    ComediChoice(const SessionOptions& options, const Rig& rig);
    ~ComediChoice();
    ComediChoice(const ComediChoice&) = delete;
    ComediChoice& operator=(const ComediChoice&) = delete;

    /// Opens the outputs: for the guardian.
    control::BoardFactory outputs() const;
    /// How long the guardian waits for a sign of life.
    std::chrono::milliseconds patience() const;
    /// Sensors by the board, commands by the guardian.
    std::shared_ptr<control::Stage> stage(std::shared_ptr<control::Guardian> guardian) const;
    const control::WatchdogParams& watchdog() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo

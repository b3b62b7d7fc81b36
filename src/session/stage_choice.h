// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The stage that the option --stage selects.
#include "control/guardian.h"
#include "control/watchdog.h"
#include "src/session/session.h"

#include <chrono>
#include <memory>

namespace fidservo {

struct Rig;

/// Whether --stage is "sim".
bool stage_is_simulated(const SessionOptions& options);

/// A board that was checked against the rig file; no output is driven yet.
class ComediChoice {
  public:
    /// Opens the node of "comedi:NODE" and checks the channels of the rig file's `stage.comedi` against it.
    /// Throws InputError for another word, a device that is not there or channels that it does not have;
    /// RunFault where the board does not open.
    ComediChoice(const SessionOptions& options, const Rig& rig);
    ~ComediChoice();
    ComediChoice(const ComediChoice&) = delete;
    ComediChoice& operator=(const ComediChoice&) = delete;

    /// Opens the outputs, in the guardian process.
    control::BoardFactory outputs() const;
    /// The guardian's timeout for the heartbeat.
    std::chrono::milliseconds patience() const;
    /// A stage with sensors read from the board and commands passed to the guardian.
    std::shared_ptr<control::Stage> stage(std::shared_ptr<control::Guardian> guardian) const;
    const control::WatchdogParams& watchdog() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo

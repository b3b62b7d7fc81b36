// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The stage on a Comedi board. The guardian process writes the outputs, the program's loop reads the inputs;
// each opens the board for itself.
#include "control/comedi/wiring.h"
#include "control/guardian.h"
#include "control/output_board.h"
#include "control/stage.h"
#include "core/result.h"

#include <memory>

namespace fidservo::control::comedi {

/// The board's outputs: the macro command, with its direction line where there is one, and the micro command.
class ComediOutputs final : public OutputBoard {
  public:
    /// Throws RunFault if the direction line cannot be made an output.
    ComediOutputs(std::unique_ptr<BoardLink> board, const Wiring& wiring);

    /// Where there is a direction line, the amount is set to zero while the line changes.
    bool write(const StageCommand& command) noexcept override;

  private:
    bool set_macro(double volts) noexcept;

    std::unique_ptr<BoardLink> board_;
    Wiring wiring_;
    bool forward_ = true;
};

/// Extends a counter of n bits beyond its range by counting its overflows.
class Unwrapped {
  public:
    explicit Unwrapped(std::uint32_t max_value) : max_value_(max_value) {}

    /// Counts since the first reading. Right as long as the counter moves by less than half its range between
    /// two readings.
    std::int64_t follow(std::uint32_t reading) noexcept;

  private:
    std::uint32_t max_value_;  ///< 2^n - 1
    std::optional<std::uint32_t> last_;
    std::int64_t count_ = 0;
};

/// The board's inputs: encoder and Hall sensor, with the time of read() as the sampling time; commands are
/// passed to the guardian.
class ComediStage final : public Stage {
  public:
    ComediStage(std::unique_ptr<BoardLink> board, const Wiring& wiring, std::shared_ptr<Guardian> guardian);

    /// Fails with Reason::device. Does not wait.
    Result<StageSample> read() override;
    /// Fails with Reason::stopped once the guardian has switched the outputs off.
    Status write(const StageCommand& command) override;

  private:
    std::int64_t count_of(std::uint32_t reading) noexcept;

    std::unique_ptr<BoardLink> board_;
    Wiring wiring_;
    std::shared_ptr<Guardian> guardian_;
    Unwrapped counter_;
};

}  // namespace fidservo::control::comedi

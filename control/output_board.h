// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The boundary to the board that drives the stage: two D/A outputs that hold their last value, whatever
// happens to the program that wrote them.
#include "control/stage.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace fidservo::control {

/// Two D/A outputs. Opened by the guardian process, which owns them (control/guardian.h).
class OutputBoard {
  public:
    OutputBoard() = default;
    OutputBoard(const OutputBoard&) = delete;
    OutputBoard& operator=(const OutputBoard&) = delete;
    virtual ~OutputBoard() = default;

    /// Sets both outputs, V; they hold until the next write. False if the device refused.
    [[nodiscard]] virtual bool write(const StageCommand& command) noexcept = 0;
};

/// Opens the board; throws RunFault where that is not possible.
using BoardFactory = std::function<std::unique_ptr<OutputBoard>()>;

/// A board whose D/A registers are a file of two float64 (macro V, micro V), so that the outputs can be seen
/// from outside, also after the program has died: `od -A n -t f8 FILE`.
class SimulatedBoard final : public OutputBoard {
  public:
    /// Creates the file with both outputs zero. Throws RunFault.
    explicit SimulatedBoard(const std::filesystem::path& file);
    ~SimulatedBoard() override;

    bool write(const StageCommand& command) noexcept override;

    /// What a board with this file puts out now. Throws RunFault.
    static StageCommand outputs(const std::filesystem::path& file);

  private:
    struct Registers;
    Registers* registers_;  ///< in the mapped file
};

}  // namespace fidservo::control

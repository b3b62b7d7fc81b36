// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Errors of the counted windows without the rows of all others, which saves memory when derivatives are
// stored for each parameter.
#include "gap/evidence.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Selects the counted windows and stores their errors one after the other.
class CountedRows {
  public:
    /// @param counted  one flag for each window
    CountedRows(std::span<const Window> windows, const Wanted& counted);

    /// The counted windows in order; their ranges are those in what of() returns.
    const std::vector<Window>& windows() const { return windows_; }

    /// The number of rows of the counted windows.
    std::size_t size() const { return rows_; }

    /// The errors of the counted windows; empty if the simulator rejected the hypothesis.
    /// @param errors  of all windows
    Errors of(const Errors& errors) const;

    /// The flags of the counted windows, from those of all windows.
    Wanted flags_of(const Wanted& flags) const;

  private:
    std::vector<Window> windows_;
    std::vector<std::size_t> places_;  ///< of each counted window among all
    std::vector<std::size_t> begins_;  ///< of each counted window among the errors of all
    std::size_t rows_ = 0;
};

}  // namespace fidservo::gap

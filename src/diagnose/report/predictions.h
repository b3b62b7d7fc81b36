// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The predictions of the recordings by the rig file alone and by the explanation, for the report's plots.
#include "gap/diagnosis.h"

#include <array>
#include <vector>

namespace fidservo::diagnose {

/// Errors in floors of the windows of an evidence. The explanation's parameters are those fitted to all
/// recordings, whereas the numbers in a diagnosis are for held-out data.
struct Predictions {
    gap::Errors nominal, explained;
    bool is_explained = false;  ///< whether there is an explanation; otherwise `explained` is `nominal`
};

Predictions predict(const gap::Evidence& evidence, const gap::Hypothesis& hypothesis);

/// R.m.s. errors in floors; NaN where nothing was judged.
struct RunGap {
    double before, after;
};

/// A recording's gaps, signal by signal.
using RunGaps = std::array<RunGap, gap::signal_count>;

/// The gaps of each recording.
std::vector<RunGaps> gaps_by_run(const gap::Evidence& evidence, const Predictions& predictions);

/// Accumulates an r.m.s. error in floors.
class RootMeanSquare {
  public:
    void add(const gap::Errors& errors, const gap::Window& window);
    double value() const;  ///< NaN without values

  private:
    double sum_ = 0.0;
    std::size_t count_ = 0;
};

/// The window in which a recording's signal has the largest r.m.s. error; nullptr if none has values.
const gap::Window* worst_window(const gap::Evidence& evidence, const gap::Errors& errors, std::size_t run,
                                gap::Signal signal);

}  // namespace fidservo::diagnose

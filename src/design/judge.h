// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The value of an experiment before it is recorded.
#include "gap/budget.h"
#include "src/design/explanations.h"
#include "src/simulation/experiments.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::design {

/// How detailed a judgement is.
struct Depth {
    std::size_t draws;  ///< largest number of draws of each explanation, the last ones first
    int iterations;     ///< iterations of design::log_odds
};

struct Judgement {
    /// The least of all numbers below; negative where the rig cannot do the experiment.
    double value = -1.0;
    std::vector<double> log_odds;       ///< for each duel, the mean over the draws of its truth
    std::optional<double> information;  ///< information about the unknown (src/design/unknown.h)
    std::optional<std::string> refused;
};

class Judge {
  public:
    /// @param question  must outlive the judge
    /// @param wire_limit_degC  limit of `record` for the wire; empty: none
    Judge(const Rig& rig, const OpenQuestion& question, std::optional<double> wire_limit_degC,
          std::shared_ptr<const gap::Budget> budget)
        : rig_(rig), question_(question), wire_limit_degC_(wire_limit_degC), budget_(std::move(budget)) {}

    /// Judges by simulation: first `record`'s own check (src/record/foresight.h) with the rig file and with
    /// every draw of the explanations; then each draw's recording is fitted by the rivals. Deterministic.
    /// Throws BudgetEnded.
    Judgement judge(const Experiment& experiment, const Depth& depth) const;

    const Rig& rig() const { return rig_; }
    const OpenQuestion& question() const { return question_; }

  private:
    struct OfDraw;
    OfDraw judge_draw(const Experiment& experiment, std::size_t truth, std::size_t draw,
                      const Depth& depth) const;
    bool is_truth(std::size_t explanation) const;

    const Rig& rig_;
    const OpenQuestion& question_;
    std::optional<double> wire_limit_degC_;
    std::shared_ptr<const gap::Budget> budget_;
};

}  // namespace fidservo::design

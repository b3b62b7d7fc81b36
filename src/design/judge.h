// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an experiment is worth before it is recorded.
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

/// How closely it is looked at.
struct Depth {
    std::size_t draws;  ///< of each explanation at most, the last ones first
    int iterations;     ///< design::log_odds
};

struct Judgement {
    /// The least of all below; below 0 where the rig cannot do it.
    double value = -1.0;
    std::vector<double> log_odds;       ///< of each duel, the mean over the draws of its truth
    std::optional<double> information;  ///< about the unknown (src/design/unknown.h)
    std::optional<std::string> refused;
};

class Judge {
  public:
    /// @param question  outlives it
    /// @param wire_limit_degC  that `record` keeps; empty: none
    Judge(const Rig& rig, const OpenQuestion& question, std::optional<double> wire_limit_degC,
          std::shared_ptr<const gap::Budget> budget)
        : rig_(rig), question_(question), wire_limit_degC_(wire_limit_degC), budget_(std::move(budget)) {}

    /// In the simulator: `record`'s own look in advance (src/record/foresight.h), on the rig file and on
    /// every draw of the explanations; then each draw's recording is judged by the rivals. Deterministic.
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

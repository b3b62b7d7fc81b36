// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/design_experiment.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/design/starts.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::design {
namespace {

constexpr Depth briefly{2, 1}, closely{4, 4};

/// The least of those log odds that count and of what is learnt of the unknown.
double value_by(const Judgement& judgement, const std::vector<bool>& decidable) {
    if (judgement.refused) return judgement.value;
    double value = judgement.information.value_or(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < decidable.size(); ++k)
        if (decidable[k]) value = std::min(value, judgement.log_odds[k]);
    return value;
}

/// Experiments by their names that last longest_s at most, or are cut off then.
std::vector<Candidate> list_of(const Rig& rig) {
    constexpr std::uint64_t seed = 1;
    std::vector<Candidate> list;
    for (const std::string_view kind : experiment_kinds()) {
        if (!missing_for(kind, rig).empty()) continue;
        const Experiment experiment = make_experiment(kind, rig, seed, std::string(kind) + "-next");
        if (auto design = as_design(experiment, rig))
            list.push_back({std::string(kind), std::move(*design), {}});
    }
    return list;
}

/// Which stages the explanations that are to be told apart differ by; both for what is of neither.
Emphasis emphasis_of(const OpenQuestion& question) {
    Emphasis emphasis{false, false};
    const auto add = [&](std::string_view block) {
        emphasis.macro = emphasis.macro || !block.starts_with("micro.");
        emphasis.micro = emphasis.micro || !block.starts_with("macro.");
    };
    for (const Duel& duel : question.duels)
        for (const std::size_t k : {duel.truth, duel.rival})
            for (const plant::EffectSetting& setting : question.explanations[k].hypothesis)
                add(setting.effect->block);
    if (question.unknown)
        for (const Quantity quantity : question.unknown->depends_on)
            add(quantity == Quantity::temperature || quantity == Quantity::contraction ? "micro." : "macro.");
    if (!emphasis.macro && !emphasis.micro) return {};
    return emphasis;
}

class DesignSearch {
  public:
    DesignSearch(const Judge& judge, const std::string& name, const DesignEffort& effort, const Tell& tell)
        : judge_(judge),
          name_(name),
          effort_(effort),
          tell_(tell),
          decidable_(judge.question().duels.size(), true) {}

    /// Throws BudgetEnded; what it has found by then stays.
    void search() {
        for (Candidate& candidate : list_of(judge_.rig())) {
            say("experiments of the list");
            look(std::move(candidate));
        }
        constexpr std::uint64_t seed = 1;
        NoiseStream draw(seed, "design/starts");
        const Emphasis emphasis = emphasis_of(judge_.question());
        for (std::size_t k = 0; k < effort_.drawn; ++k) {
            say(fmt::format("experiment {} of {} that are drawn", k + 1, effort_.drawn));
            look({std::string(drawn_origin), drawn_design(judge_.rig(), emphasis, draw), {}});
        }
        find_decidable();
        std::ranges::stable_sort(seen_, std::greater{}, value_of);
        const std::size_t improved = std::min(effort_.improved, seen_.size());
        for (std::size_t k = 0; k < improved; ++k) improve(seen_[k]);
    }

    /// By all that was looked at so far; all duels where none is decided.
    void find_decidable() {
        std::vector<bool> decided(decidable_.size(), false);
        for (const Candidate& candidate : seen_)
            for (std::size_t k = 0; k < decided.size(); ++k)
                decided[k] = decided[k] || candidate.judgement.log_odds[k] >= least_log_odds;
        if (std::ranges::count(decided, true) == 0) return;
        decidable_ = decided;
        for (Candidate& candidate : seen_)
            candidate.judgement.value = value_by(candidate.judgement, decidable_);
    }

    /// Of what was found the best ones, and the best one of the list, closely. Throws BudgetEnded.
    void look_closely() {
        constexpr std::size_t finalists = 3;
        std::ranges::stable_sort(seen_, std::greater{}, value_of);
        std::size_t looked_at = 0;
        bool has_list = false;
        for (Candidate& candidate : seen_) {
            const bool is_listed =
                !has_list && candidate.origin != drawn_origin && candidate.origin != improved_origin;
            if (looked_at >= finalists && !is_listed) continue;
            ++looked_at;
            say("the best ones closely");
            candidate.judgement = judged(candidate.design, closely);
            if (!candidate.judgement.refused) final_.push_back(candidate);
            has_list = has_list || is_listed;
        }
    }

    const std::vector<bool>& decidable() const { return decidable_; }

    std::optional<Candidate> best() const {
        const std::vector<Candidate>& from = final_.empty() ? seen_ : final_;
        if (from.empty()) return {};
        return *std::ranges::max_element(from, {}, value_of);
    }

  private:
    static constexpr std::string_view drawn_origin = "drawn", improved_origin = "improved";
    static double value_of(const Candidate& candidate) { return candidate.judgement.value; }

    void say(std::string_view what) const {
        if (tell_) tell_(what);
    }

    Judgement judged(const Design& design, const Depth& depth) const {
        try {
            Judgement judgement = judge_.judge(experiment_of(design, name_, judge_.rig()), depth);
            judgement.value = value_by(judgement, decidable_);
            return judgement;
        } catch (const InputError& error) {
            Judgement judgement;
            judgement.refused = error.what();
            return judgement;
        }
    }

    void look(Candidate candidate) {
        candidate.judgement = judged(candidate.design, briefly);
        if (!candidate.judgement.refused) seen_.push_back(std::move(candidate));
    }

    void improve(Candidate start) {
        const Rig& rig = judge_.rig();
        int asked = 0;
        Candidate best = start;
        const auto value_at = [&](const std::vector<double>& at) {
            say(fmt::format("variation {} of a good one", ++asked));
            const Design design = with_numbers(start.design, at, rig);
            Judgement judgement = judged(design, briefly);
            const double value = judgement.value;
            if (value > best.judgement.value)
                best = {std::string(improved_origin), design, std::move(judgement)};
            return value;
        };
        try {
            (void)maximised(value_at, numbers(start.design, rig), start.judgement.value, effort_.optimiser);
        } catch (...) {
            seen_.push_back(best);
            throw;
        }
        seen_.push_back(best);
    }

    const Judge& judge_;
    const std::string& name_;
    const DesignEffort& effort_;
    const Tell& tell_;
    std::vector<bool> decidable_;
    std::vector<Candidate> seen_, final_;
};

}  // namespace

DesignedExperiment design_experiment(const Judge& judge, const std::string& name,
                                     const std::shared_ptr<const gap::Budget>& budget,
                                     const DesignEffort& effort, const Tell& tell) {
    DesignedExperiment designed;
    DesignSearch search(judge, name, effort, tell);
    const auto within_budget = [&](const auto& work) {
        try {
            work();
        } catch (const gap::BudgetEnded& end) {
            designed.ended = end.how();
        }
    };
    within_budget([&] { search.search(); });
    search.find_decidable();
    if (budget) budget->end_search();
    if (designed.ended != gap::Ended::interrupted) within_budget([&] { search.look_closely(); });
    designed.best = search.best();
    designed.decidable = search.decidable();
    return designed;
}

std::optional<Candidate> best_of_list(const Judge& judge, const std::vector<bool>& decidable) {
    std::optional<Candidate> best;
    for (Candidate& candidate : list_of(judge.rig())) {
        candidate.judgement =
            judge.judge(experiment_of(candidate.design, candidate.origin, judge.rig()), closely);
        if (candidate.judgement.refused) continue;
        candidate.judgement.value = value_by(candidate.judgement, decidable);
        if (!best || candidate.judgement.value > best->judgement.value) best = std::move(candidate);
    }
    return best;
}

}  // namespace fidservo::design

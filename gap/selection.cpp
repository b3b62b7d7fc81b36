#include "gap/selection.h"

#include "gap/first_sight.h"
#include "gap/parallel.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace fidservo::gap {
namespace {

/// A tie: what the rest of the candidates' predictions lack to the best one's is no more than chance.
constexpr double tie_significance = 2.0;
/// A difference too small to matter: the mean loss of a tenth of a window, whatever its significance.
constexpr double least_gain = 0.5;

std::vector<bool> windows_of(const std::vector<std::uint8_t>& half, int which) {
    std::vector<bool> chosen(half.size());
    for (std::size_t w = 0; w < half.size(); ++w) chosen[w] = half[w] == which;
    return chosen;
}

/// A search over one set of recordings.
class Search {
  public:
    Search(const Evidence& evidence, const std::vector<Candidate>& candidates,
           const SelectionOptions& options)
        : evidence_(evidence), candidates_(candidates), options_(options), half_(halves(evidence)) {
        for (int side = 0; side < 2; ++side)
            in_half_[static_cast<std::size_t>(side)] = windows_of(half_, side);
    }

    CrossFit nothing() const {
        CrossFit cross;
        judge(cross);
        return cross;
    }

    /// Candidates added to a base, fitted on both halves; best first.
    std::vector<Trial> try_all(const CrossFit& base, std::span<const Candidate* const> added) {
        std::vector<const Candidate*> open;
        for (const Candidate& candidate : candidates_)
            if (std::ranges::find(added, &candidate) == added.end()) open.push_back(&candidate);

        const Errors base_errors = predict_all(base.of_half[0]);
        std::vector<Promise> promises(open.size());
        parallel_for(open.size(), [&](std::size_t c) {
            promises[c] = at_first_sight(predictor(0, base.of_half[0], *open[c]), evidence_.windows(),
                                         in_half_[0], base.of_half[0], base_errors, *open[c]);
        });
        trials_ += static_cast<int>(open.size());
        const std::vector<std::size_t> order = worth_fitting(promises);
        std::vector<Trial> trials(order.size());
        parallel_for(order.size(), [&](std::size_t k) {
            const Candidate& candidate = *open[order[k]];
            Trial& trial = trials[k];
            trial.candidate = &candidate;
            for (std::size_t side = 0; side < 2; ++side) {
                Hypothesis start = base.of_half[side];
                start.push_back(promises[order[k]].start.back());
                trial.fitted.of_half[side] =
                    fit(predictor(side, start), evidence_.windows(), in_half_[side], start).hypothesis;
            }
            judge(trial.fitted);
            trial.against_base = compared(base, trial.fitted);
        });
        std::ranges::sort(trials, {}, [](const Trial& trial) { return trial.fitted.loss; });
        return trials;
    }

    bool is_real(const Comparison& comparison) const {
        return comparison.gain > least_gain &&
               comparison.significance >
                   significance_bound(comparison.blocks, std::max(trials_, 1), options_.tail);
    }

    bool ties(const CrossFit& best, const CrossFit& other) const {
        const Comparison lead = compared(other, best);
        return lead.gain < least_gain || lead.significance < tie_significance;
    }

    Comparison compared(const CrossFit& base, const CrossFit& fitted) const {
        return compare(evidence_.windows(), base.mean_squares, fitted.mean_squares);
    }

    /// Fits all parameters of a cross fit from where they are.
    void fit_again(CrossFit& cross) const {
        for (std::size_t side = 0; side < 2; ++side)
            if (!cross.of_half[side].empty())
                cross.of_half[side] = fit(predictor(side, cross.of_half[side]), evidence_.windows(),
                                          in_half_[side], cross.of_half[side])
                                          .hypothesis;
        judge(cross);
    }

    int trials() const { return trials_; }

  private:
    Errors predict_all(const Hypothesis& hypothesis) const {
        return evidence_.errors(hypothesis, everything(evidence_));
    }

    /// Those whose promise is not far behind the best one's, best first.
    std::vector<std::size_t> worth_fitting(const std::vector<Promise>& promises) const {
        constexpr double share_of_best = 0.25;
        std::vector<std::size_t> order(promises.size());
        std::iota(order.begin(), order.end(), 0);
        const auto promised = [&](std::size_t c) { return promises[c].gain; };
        std::ranges::sort(order, std::greater{}, promised);
        order.resize(std::min(order.size(), static_cast<std::size_t>(options_.fits_per_step)));
        const double least =
            order.empty() ? 0.0 : std::max(least_gain, share_of_best * promised(order.front()));
        std::erase_if(order, [&](std::size_t c) { return !(promised(c) > least); });
        return order;
    }

    /// Of the windows of one half, in the signals that a hypothesis can change.
    Predict predictor(std::size_t side, const Hypothesis& base, const Candidate& added) const {
        Hypothesis all = base;
        all.push_back(plant::vanishing_setting(*added.effect));
        return predictor(side, all);
    }

    Predict predictor(std::size_t side, const Hypothesis& changed) const {
        Wanted wanted{.runs = runs_of(side), .signals = {}};
        for (const plant::EffectSetting& setting : changed)
            for (const Signal signal : reach_of(*setting.effect))
                wanted.signals[static_cast<std::size_t>(signal)] = true;
        return [this, wanted = std::move(wanted)](const Hypothesis& hypothesis) {
            return evidence_.errors(hypothesis, wanted);
        };
    }

    std::vector<std::uint8_t> runs_of(std::size_t side) const {
        std::vector<std::uint8_t> runs(evidence_.recordings().size(), 0);
        for (std::size_t w = 0; w < half_.size(); ++w)
            if (half_[w] == side) runs[evidence_.windows()[w].run] = 1;
        return runs;
    }

    /// What was fitted on one half, judged on the other.
    void judge(CrossFit& cross) const {
        cross.mean_squares.assign(evidence_.windows().size(), 0.0);
        for (std::size_t side = 0; side < 2; ++side) {
            const std::vector<double> squares =
                mean_squares(evidence_.windows(), predict_all(cross.of_half[side]));
            for (std::size_t w = 0; w < squares.size(); ++w)
                if (half_[w] != side) cross.mean_squares[w] = squares[w];
        }
        cross.loss = total_loss(cross.mean_squares);
    }

    const Evidence& evidence_;
    const std::vector<Candidate>& candidates_;
    SelectionOptions options_;
    std::vector<std::uint8_t> half_;
    std::array<std::vector<bool>, 2> in_half_;
    int trials_ = 0;
};

/// The explanation as it grows.
struct Chain {
    std::vector<Choice> choices;
    CrossFit fitted;  ///< with all of them

    std::vector<const Candidate*> candidates() const {
        std::vector<const Candidate*> all;
        for (const Choice& choice : choices) all.push_back(choice.candidate);
        return all;
    }
};

Choice choice_of(const Search& search, const CrossFit& beside, std::vector<Trial> trials) {
    Choice choice{trials.front().candidate, beside.loss, {}, {}};
    for (std::size_t k = 1; k < trials.size(); ++k)
        if (trials[k].against_base.gain > least_gain && search.ties(trials[0].fitted, trials[k].fitted))
            choice.ties.push_back(trials[k].candidate);
    choice.alternatives = std::move(trials);
    return choice;
}

/// Takes in what is best, as long as it is no chance.
void grow(Search& search, Chain& chain, int most_effects, std::vector<Trial>* first_step) {
    while (static_cast<int>(chain.choices.size()) < most_effects) {
        std::vector<Trial> trials = search.try_all(chain.fitted, chain.candidates());
        if (first_step != nullptr) *first_step = trials;
        first_step = nullptr;
        if (trials.empty() || !search.is_real(trials.front().against_base)) return;
        CrossFit fitted = trials.front().fitted;
        chain.choices.push_back(choice_of(search, chain.fitted, std::move(trials)));
        chain.fitted = std::move(fitted);
    }
}

/// The chain without one of its effects, fitted anew.
Chain without(const Search& search, const Chain& chain, std::size_t left_out) {
    Chain shorter = chain;
    const auto at = static_cast<std::ptrdiff_t>(left_out);
    shorter.choices.erase(shorter.choices.begin() + at);
    for (Hypothesis& hypothesis : shorter.fitted.of_half) hypothesis.erase(hypothesis.begin() + at);
    search.fit_again(shorter.fitted);
    return shorter;
}

/// An effect that was taken in first may have been a compromise of two others: each is given up where the
/// rest does as well without it, and otherwise exchanged for what is best beside the rest.
void exchange(Search& search, Chain& chain) {
    constexpr int most_exchanges = 4;
    int exchanges = 0;
    for (std::size_t k = 0; chain.choices.size() > 1 && k < chain.choices.size();) {
        Chain rest = without(search, chain, k);
        if (!search.is_real(search.compared(rest.fitted, chain.fitted))) {
            chain = std::move(rest);
            k = 0;
            continue;
        }
        std::vector<Trial> trials = search.try_all(rest.fitted, rest.candidates());
        const bool is_other = !trials.empty() && trials.front().candidate != chain.choices[k].candidate;
        const bool better = !trials.empty() && trials.front().fitted.loss < chain.fitted.loss - least_gain;
        if (!is_other) {
            // The same again, with its alternatives as they are beside the whole rest.
            if (!trials.empty()) chain.choices[k] = choice_of(search, rest.fitted, std::move(trials));
            ++k;
        } else if (better && exchanges++ < most_exchanges) {
            CrossFit fitted = trials.front().fitted;
            rest.choices.push_back(choice_of(search, rest.fitted, std::move(trials)));
            rest.fitted = std::move(fitted);
            chain = std::move(rest);
            k = 0;
        } else {
            ++k;
        }
    }
}

/// The first `count` effects of a chain alone.
CrossFit first_of(const Search& search, const Chain& chain, std::size_t count) {
    CrossFit fitted = chain.fitted;
    for (Hypothesis& hypothesis : fitted.of_half) hypothesis.resize(count);
    search.fit_again(fitted);
    return fitted;
}

}  // namespace

std::vector<std::uint8_t> halves(const Evidence& evidence) {
    constexpr std::size_t windows_in_stretch = 4;
    std::map<std::string, std::vector<std::size_t>> runs_of;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run)
        runs_of[evidence.recordings()[run].experiment].push_back(run);
    std::vector<int> half_of_run(evidence.recordings().size(), -1);
    for (const auto& [experiment, runs] : runs_of)
        if (runs.size() > 1)
            for (std::size_t k = 0; k < runs.size(); ++k) half_of_run[runs[k]] = static_cast<int>(k % 2);
    const std::vector<Window>& windows = evidence.windows();
    std::vector<std::uint8_t> half(windows.size());
    std::size_t in_run = 0;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const bool begins =
            w == 0 || windows[w].run != windows[w - 1].run || windows[w].signal != windows[w - 1].signal;
        in_run = begins ? 0 : in_run + 1;
        const int of_run = half_of_run[windows[w].run];
        half[w] = static_cast<std::uint8_t>(of_run >= 0 ? static_cast<std::size_t>(of_run)
                                                        : in_run / windows_in_stretch % 2);
    }
    return half;
}

Fit fit_to_all(const Evidence& evidence, const CrossFit& cross) {
    const Wanted wanted = everything(evidence);
    const Predict predict = [&](const Hypothesis& hypothesis) { return evidence.errors(hypothesis, wanted); };
    return fit(predict, evidence.windows(), std::vector<bool>(evidence.windows().size(), true),
               cross.of_half[0]);
}

Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options) {
    Search search(evidence, candidates, options);
    Selection selection;
    Chain chain{{}, search.nothing()};
    selection.steps.push_back(chain.fitted);
    grow(search, chain, options.most_effects, &selection.alone);
    exchange(search, chain);
    grow(search, chain, options.most_effects, nullptr);
    for (std::size_t k = 1; k < chain.choices.size(); ++k)
        selection.steps.push_back(first_of(search, chain, k));
    if (!chain.choices.empty()) selection.steps.push_back(chain.fitted);
    selection.choices = std::move(chain.choices);
    return selection;
}

}  // namespace fidservo::gap

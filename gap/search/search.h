// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of a search: which effect, added to what is known, predicts best what was not fitted.
#include "gap/candidates/candidate.h"
#include "gap/fit/cross_fit.h"
#include "gap/search/everything.h"
#include "gap/search/search_memory.h"

#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// A candidate that was added to a hypothesis. What promised little was not fitted: no gain, no squares.
struct Trial {
    const Candidate* candidate = nullptr;
    double promised = 0.0;   ///< loss saved at first sight, in the windows that it is fitted to
    double gain = 0.0;       ///< loss saved in the held-out windows
    bool is_leader = false;  ///< fitted on both halves; otherwise on the first, judged on some of the second
    CrossFit fitted = {};
};

/// How many candidates of those that promise most a step fits, and how many of these on both halves.
struct Effort {
    std::size_t fits = 8, leaders = 4;
    /// Whether the best wave is looked for among many values where it leaves something.
    bool scatters = true;
    bool refines = true;  ///< whether the leaders are fitted closer than from afar
};

/// Share of a signal's excess that a wave takes away where its place and period are nearly right.
inline constexpr double in_its_valley = 0.999;

struct SearchOptions {
    std::size_t windows = 48;  ///< of a signal and a half, that are fitted
    /// After which it is exhausted (Evidence::effort): 12 to 25 s of two cores, for a campaign of 5 minutes.
    double most_effort = 5'000.0;
    /// Told what is tried next, in words.
    std::function<void(std::string_view)> tell = {};
    double tail = 0.01;  ///< of taking in anything where there is nothing, over the whole search
};

/// The effort that a search may take was spent where it counts.
class SearchExhausted : public std::exception {
  public:
    const char* what() const noexcept override { return "the effort of the search was spent"; }
};

/// A search over one set of recordings. Counts what it tries, and does nothing twice.
class Search {
  public:
    Search(const Evidence& evidence, const std::vector<Candidate>& candidates, const SearchOptions& options);
    Search(const Search&) = delete;
    Search& operator=(const Search&) = delete;

    /// Throws SearchExhausted once the evidence's budget has ended while what was found last was refined.
    void throw_if_over() const;

    /// Whether the effort counts: not for the first effect, and not where what is known is fitted and judged
    /// again. Where it counts and is spent, whatever fits throws SearchExhausted.
    void limit(bool is_limited) { is_limited_ = is_limited; }

    /// Of which signals causes are looked for from now on, and with what share of all effort, counted from
    /// the start; of all signals with all of it at first.
    void look_for_causes_in(const SignalFlags& signals, double share_of_effort) {
        focus_ = signals;
        share_of_effort_ = share_of_effort;
    }

    /// What is needed of all smooth candidates of the Hall reading and the tags beside what a base knows of
    /// the carriage, fitted at once (gap/search/everything.h), on both halves; the base's own settings of
    /// these begin as they are. In the fit they are the last ones, in the order of the candidates.
    struct Together {
        std::vector<const Candidate*> candidates;
        std::vector<double> worth;  ///< loss that each saves beside the others
        CrossFit fitted;
    };
    Together everything_beside(const CrossFit& base) const;

    /// The same with one further effect that has a shape of its own: each time another one, of those that
    /// promise most in the signals that the base leaves off.
    std::vector<Together> shaped_beside(const CrossFit& base) const;

    /// The same of the carriage beside a base that knows nothing of it: from the models that balance its
    /// forces (gap/balance/force_regression.h) the one that predicts best where it is followed, in the form
    /// that does, with all that is smooth. The base where nothing balances them. Does not count as effort.
    Together forces_beside(const CrossFit& base);

    /// How the budget ended while something was refined that was kept.
    std::optional<Ended> over() const { return over_; }

    CrossFit nothing() const;

    /// Candidates added to a base, all of them but those `added` in it; leaders first, then by gain,
    /// but of those that tie with the best, or leave it nothing, the one of fewest parameters first. What
    /// could only improve signals that are at their floors is not fitted.
    std::vector<Trial> try_all(const CrossFit& base, std::span<const Candidate* const> added,
                               const Effort& effort = {});

    /// Looks for a weak wave of force beside a base among all that there may be (gap/search/wave_scan.h), by
    /// windows that are far off. Returns whether one promises more than those that were known, so that
    /// try_all would come to something else.
    bool scan_for_wave(const CrossFit& base, std::span<const Candidate* const> added);

    /// The base with a candidate that try_all has tried beside it, fitted on both halves; none where no
    /// prediction was possible: the plant refuses it, or the search was stopped.
    std::optional<CrossFit> with(const CrossFit& base, const Candidate& candidate);

    /// Takes over from a whole, which is the base and a candidate at a place, what it has found for that one:
    /// try_all beside this base then fits only what promises about as much.
    void remember(const CrossFit& base, const Candidate& candidate, const CrossFit& whole, std::size_t at);

    /// Fits those parameters of a cross fit again, from where they are, that meet some signals.
    void fit_again(CrossFit& cross, const SignalFlags& signals) const;

    /// Judges a cross fit as it is.
    void judge(CrossFit& cross) const { fitter_.judge(cross); }

    /// A whole, whose last effect is a candidate, with that and what it meets fitted closer.
    /// @param base  that it is told from: without the last effect at least
    CrossFit closer(const CrossFit& base, CrossFit whole, const Candidate& last) const;

    /// Signals at whose fits an effect of a cross fit has a say (gap/fit/cross_fit.h).
    SignalFlags concerned_by(const Candidate& candidate, const CrossFit& whole) const {
        return fitter_.concerned_by(*candidate.effect, whole.of_half[0]);
    }

    /// Whether an effect's gain is more than chance, over all that was tried, and takes away a good part of
    /// what a signal exceeds its floor by: where the true law differs a little from the catalogue's, many an
    /// effect gains a little. So it does beside an effect whose law is not quite the true one: what leaves a
    /// signal off its floor, by more than next to nothing, has to take away a thousandth of what the signal
    /// exceeded it by at first. What one half of the data has taught and brings three windows or more of
    /// either half, six of two runs, or the shapes of six tags, from far off to the floor is no chance
    /// however few they are.
    bool is_real(const CrossFit& without, const CrossFit& with) const;

    /// Whether an effect's gain is more than chance, over all that was tried, however much it leaves.
    /// @param times  by how many times the significance that this takes
    bool is_no_chance(const CrossFit& without, const CrossFit& with, double times = 1.0) const;

    /// Whether a signal loses a share of what it exceeds its floor by.
    bool nearly_clears(const CrossFit& without, const CrossFit& with, double share = 0.98) const;

    /// Signals above their floors.
    SignalFlags off(const CrossFit& fitted) const;

    /// Signals at some floors and more.
    SignalFlags far_off(const CrossFit& fitted, double floors = 3.0) const;

    /// How large a gap a setting alone would make beside the rig file, over all signals, in floors
    /// (gap/fit/gap_size.h): by what the predictions change with it.
    double gap_alone(const plant::EffectSetting& setting) const;

    /// Whether every signal is at its floor: nothing is left for another effect to explain.
    bool is_at_floor(const CrossFit& fitted) const;

    /// Signals that exceed their floors by as much as a further effect has to take away of them.
    SignalFlags leaves_much(const CrossFit& fitted) const;

    /// Whether no signal does.
    bool leaves_little(const CrossFit& fitted) const;

    /// Whether what the other lacks to the best is no more than chance.
    bool ties(const CrossFit& best, const CrossFit& other) const;

    struct Contender;

  private:
    Together together(const std::array<Hypothesis, 2>& beside, NeededCandidates needed) const;
    struct EverythingBeside;
    /// @param of_tags_alone  only what the Hall reading does not tell of, the rest as it is known
    EverythingBeside everything_of(const CrossFit& base, bool of_tags_alone = false) const;
    Together needed_of(const EverythingBeside& all) const;
    /// Of the encoder, as its errors show them.
    Hypothesis waves_of_reading(const CrossFit& base, std::span<const Candidate* const> candidates) const;
    Together balanced_beside(const CrossFit& base) const;
    class CloserFit;
    /// By those encoder windows of the first half that are far off without a wave (gap/search/wave_scan.h).
    /// None where the predicted carriage never runs away, as a weak wave shows by nothing else, and none of a
    /// carriage on a belt, whose predictions are too dear.
    std::optional<plant::EffectSetting> scanned_wave(const Hypothesis& beside, const Candidate& wave) const;
    Contender contender(const CrossFit& base, const Candidate& candidate);
    /// Candidates that are not `added` and may improve a signal that is off.
    std::vector<const Candidate*> in_question(const CrossFit& base,
                                              std::span<const Candidate* const> added) const;
    std::vector<Contender> contenders(const CrossFit& base, std::span<const Candidate* const> added);
    /// Looks for values from which their fits may begin.
    void look_at(const CrossFit& base, std::span<Contender> contenders);
    void fit_simple_first(const CrossFit& base, std::span<Contender> contenders) const;
    /// From each of a contender's best starts; then judges it on some windows of the other half.
    void fit_first_half(const CrossFit& base, std::span<Contender* const> contenders) const;
    void judge_first_half(const CrossFit& base, Contender& contender) const;
    void fit_second_half(const CrossFit& base, Contender& contender) const;
    /// From what a richer effect, of which it is the limit, has found on both halves: beside what the richer
    /// one has taken it may promise nothing by itself. Keeps what it had if that is better.
    void fit_plain_form(const CrossFit& base, const Contender& richer, Contender& plain) const;
    /// From what its limit has found, along the richer one's shapes: where it was fitted from afar it may
    /// have ended at its limit. Keeps what it had if that is better.
    void fit_rich_form(const CrossFit& base, const Contender& plain, Contender& richer) const;
    /// The leaders, which come first and best first, with those others that are fitted now and gain as much
    /// as a leader has to. @param fit  returns whether it has fitted one
    static std::span<Contender> with_fitted(std::span<Contender> all, std::size_t leaders,
                                            const std::function<bool(Contender&)>& fit);
    /// The leaders with the limits of the best one, fitted from it.
    std::span<Contender> with_limits(const CrossFit& base, std::span<Contender> all,
                                     std::size_t leaders) const;
    /// The leaders with those of which the best one is the limit, fitted from it where it leaves something.
    std::span<Contender> with_richer(const CrossFit& base, std::span<Contender> all,
                                     std::size_t leaders) const;
    /// Where a fit from afar leaves more than the floor: again from where it ended, to the windows that say
    /// most there; of a wave by a simplex over all windows, as its losses have many minima. Where slopes do
    /// not lead there, by a simplex too: of encoder and camera, as the place within a count gives way up to
    /// its end, and of what leaves nearly nothing of a signal's gap. Ends after a share of the search's
    /// effort: a single effect that is not close by then may be a compromise of two.
    void fit_closer(const CrossFit& base, Contender& contender, bool scatters = true,
                    double share_of_effort = 0.25) const;
    /// Those that come near the best, closer too where that leaves something: fitted no further than from
    /// afar the cause may be behind what imitates it. Sorted by gain after it.
    void fit_rivals(const CrossFit& base, std::span<Contender> leaders) const;
    /// Fits the leaders closer, with their limits and richer forms among all; the one to be taken in is the
    /// first of all then. What takes the place of another one is judged to be better, so that whenever this
    /// ends nothing is lost.
    void refine(const CrossFit& base, std::span<Contender> all, std::span<Contender> leaders,
                const Effort& effort) const;
    Hypothesis fitted_from_there(const CrossFit& base, const Contender& contender, std::size_t side,
                                 double step_scales) const;
    /// A wave, from the best of many values.
    Contender scattered(const CrossFit& base, const Contender& contender) const;
    /// Each half from what the other one has found, where that fits it better than its own.
    Contender crossed(const CrossFit& base, const Contender& contender) const;
    /// With one or two refinements of what is fitted, from any of their values: where a fit has begun
    /// without, no slope leads to them, and from afar they only seem to do harm.
    Contender refined(const CrossFit& base, const Contender& contender) const;
    /// With what it fits from such a start of the first half, then from there on the other one: of two
    /// valleys beside each other that may miss the deeper one by itself.
    Contender fitted_on(const CrossFit& base, const Contender& contender, const Hypothesis& start) const;
    Fit polished(const Contender& contender, std::size_t side, const Places& places) const;
    void judge_both_halves(const CrossFit& base, Contender& contender) const;
    /// Of all windows of a half that teach an effect.
    double loss_on_half(std::size_t side, const Hypothesis& whole, const Candidate& taught) const;
    /// Over all that was tried.
    bool is_significant(const Comparison& comparison, double times = 1.0) const;
    /// Whether some signal loses such a share of its excess, and comes to its floor or loses at least such a
    /// share of what it exceeds it by where nothing is known.
    bool clears_a_signal(const CrossFit& without, const CrossFit& with, double share,
                         double share_of_first = 0.0) const;
    /// Whether a signal comes to its floor that was far off; of tags, whether next to nothing is left.
    bool clears_what_is_far_off(const CrossFit& without, const CrossFit& with) const;
    /// Whether a signal is off by 3 floors and more in three windows of each half or in six of one half and
    /// of two runs, or in the shapes of twice as many tags: of what does not depend on where the stages are,
    /// the errors of one frame say nothing of the next one's.
    bool is_far_off(const CrossFit& cross, Signal signal) const;
    /// Of each detection of a half, predicted by what the other half has taught.
    std::vector<std::size_t> runs_of_shapes_far_off(const CrossFit& cross, std::size_t side) const;
    /// Of leaders, best first, the one of fewest parameters among those that tie with the best, leave nothing
    /// in the signals that teach it, or are its limit and no worse than by chance: bristles that bend over no
    /// way are Coulomb friction, fitted a little better.
    std::size_t simplest(std::span<const Contender> leaders) const;

    bool is_exhausted() const;
    /// What was fitted since is worth nothing: fits end at once from then on.
    void throw_if_exhausted() const;

    const std::vector<Candidate>& candidates_;
    SearchOptions options_;
    double effort_at_start_;
    bool is_limited_ = false;
    SignalFlags focus_ = all_signals;
    double share_of_effort_ = 1.0;
    std::optional<Ended> over_;  ///< how the budget ended
    CrossFitter fitter_;
    SearchMemory memory_;
    SignalExcess first_excess_;  ///< where nothing is known
    int trials_ = 0;
};

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of a search: which effect, added to those known, predicts best the windows that were not fitted.
#include "gap/budget.h"
#include "gap/candidates/candidate.h"
#include "gap/fit/cross_fit.h"
#include "gap/fit/gap_size.h"
#include "gap/numbers.h"
#include "gap/search/everything.h"
#include "gap/search/search_memory.h"

#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// A candidate that was added to a hypothesis. If it promised little it was not fitted: it has no gain and no
/// cross fit.
struct Trial {
    const Candidate* candidate = nullptr;
    double promised = 0.0;  ///< estimated loss saved, without a fit, in the windows to be fitted
    double gain = 0.0;      ///< loss saved in the held-out windows
    /// Whether it was fitted on both halves; otherwise it was fitted on the first one at most, and judged on
    /// some windows of the second.
    bool is_leader = false;
    CrossFit fitted = {};
};

/// How many of the most promising candidates a step fits, and how many of these on both halves.
struct Effort {
    std::size_t fits = wide_beam, leaders = beam;
    /// Whether the best wave or spring is also fitted from many drawn values if it leaves a gap.
    bool scatters = true;
    bool refines = true;  ///< whether the leaders' first, coarse fits are followed by close ones
    /// Another explanation that the candidates compete with: what promises little beside its gain is not
    /// fitted.
    const CrossFit* competitor = nullptr;
};

/// Share of the effort of a search that the close fit of one effect gets; and what each of two searches gets
/// of the time, or of the effort.
inline constexpr double usual_share_of_effort = 0.25, half_of_it = 0.5;

/// Shares of a signal's excess that count as all of it but for noise; and which a wave removes once its place
/// and period are nearly right.
inline constexpr double all_but_noise = 0.98, in_its_valley = 1.0 - next_to_none;

/// R.m.s. error, in floors, from which on a signal or a window is far off.
inline constexpr double far_off_floors = 3.0;

/// Repetitions of what may improve a result further.
inline constexpr int most_rounds = 4;

struct SearchOptions {
    std::size_t windows = 48;  ///< the largest number of windows of one signal and one half that are fitted
    /// Effort (Evidence::effort) after which the search is exhausted: 12 to 25 s on two cores for recordings
    /// of 5 minutes.
    double most_effort = 5'000.0;
    /// Called with a description of what is tried next.
    std::function<void(std::string_view)> tell = {};
    /// Probability of accepting anything where there is nothing, over the whole search.
    double tail = 0.01;
};

/// Thrown when the effort of a search is spent, or its budget has ended.
class SearchExhausted : public std::exception {
  public:
    const char* what() const noexcept override { return "the effort of the search was spent"; }
};

/// A search over one set of recordings. It counts what it tries, and does nothing twice
/// (gap/search/search_memory.h).
class Search {
  public:
    Search(const Evidence& evidence, const std::vector<Candidate>& candidates, const SearchOptions& options);
    Search(const Search&) = delete;
    Search& operator=(const Search&) = delete;

    /// Throws SearchExhausted if the evidence's budget has ended during a refinement, whose best result was
    /// kept.
    void throw_if_over() const;

    /// Whether the effort is limited: it is not for the first effect, nor where known effects are refitted
    /// and judged. Once a limited effort is spent, all functions that fit throw SearchExhausted.
    void limit(bool is_limited) { is_limited_ = is_limited; }

    /// Restricts the search to causes that show in some signals, and to a share of the whole effort, counted
    /// from the start of the search. Initially it includes all signals and the whole effort.
    void look_for_causes_in(const SignalFlags& signals, double share_of_effort) {
        focus_ = signals;
        share_of_effort_ = share_of_effort;
    }

    /// Those of all smooth candidates of Hall reading and tags that are needed beside a base's other effects,
    /// fitted at once on both halves (gap/search/everything.h), starting from the base's own settings of
    /// these candidates. They are the last settings of the fit, in the order of `candidates`. A Hall reading
    /// that is off its floor is explained first, without the tags, which show what moves the platform and
    /// what the camera sees of it: by sizes, or, where these do not come near, with shapes that promise
    /// anything. Where it is not far off any more, the tags are explained next by what the camera alone can
    /// see. Where that leaves something in the tags, both signals are explained together, unless the reason
    /// may be a carriage that is still to be explained.
    struct Together {
        std::vector<const Candidate*> candidates;
        std::vector<double> worth;  ///< loss that each saves beside the others
        CrossFit fitted;
    };
    Together everything_beside(const CrossFit& base);

    /// everything_beside() of the tags: what the camera alone sees, unless the Hall reading is far off, and
    /// then of both signals together where the tags are still off. No candidates where that does not come
    /// near its optimum.
    Together tags_beside(const CrossFit& base);

    /// An explanation like that of everything_beside(), with further effects that have shapes of their own:
    /// all those that promise anything in one signal (the Hall reading alone, or the tags beside it), fitted
    /// at once; or, if together they are found not to be needed, the one that promises most. The base alone
    /// where none promises anything.
    Together shaped_beside(const CrossFit& base, Signal signal);

    /// Effects on the carriage beside a base that has none. Of the models from the balance of forces
    /// (gap/balance/force_regression.h), and of the forms of their effects, those are taken that predict best
    /// when the carriage is simulated, with all further smooth effects that are needed. The base alone where
    /// there is no such model. Does not count as effort.
    Together forces_beside(const CrossFit& base);

    /// Whether the balance of forces can show a candidate (gap/balance/force_regression.h).
    bool is_force(const Candidate& candidate) const;

    /// The time budget.
    const Budget& budget() const { return *fitter_.evidence().budget(); }

    /// How the budget ended, if it did during a refinement; what had been found until then was kept.
    std::optional<Ended> over() const { return over_; }

    CrossFit nothing() const;

    /// Tries all candidates except those in `added` as additions to a base. Leaders come first, those whose
    /// gain is real before the others, and after them the rest by gain; of leaders that tie with the best, or
    /// bring its signals to their floors, the one with the fewest parameters is first. Candidates that could
    /// only improve signals already at their floors are not fitted.
    std::vector<Trial> try_all(const CrossFit& base, std::span<const Candidate* const> added,
                               const Effort& effort = {});

    /// Scans all possible weak waves of force beside a base (gap/starts/wave_scan.h), in windows that are far
    /// off. Returns whether one promises more than the start values known before, so that try_all would come
    /// to another result.
    bool scan_for_wave(const CrossFit& base, std::span<const Candidate* const> added);

    /// The base with a candidate that try_all has tried beside it, fitted on both halves. Empty where no
    /// prediction was possible, because the plant refuses the candidate or the search was stopped.
    std::optional<CrossFit> with(const CrossFit& base, const Candidate& candidate);

    /// Stores the values of a candidate in a cross fit `whole`, of which it is the setting at index `at` and
    /// the base is the rest: try_all beside this base then fits only candidates that promise about as much.
    void remember(const CrossFit& base, const Candidate& candidate, const CrossFit& whole, std::size_t at);

    /// Refits, from their present values, the parameters of those settings that are estimated from any of the
    /// given signals, or coupled with such settings.
    void fit_again(CrossFit& cross, const SignalFlags& signals) const;

    /// Judges a cross fit with its present values.
    void judge(CrossFit& cross) const { fitter_.judge(cross); }

    /// A cross fit whose last effect is a candidate, after a close fit of that effect and of those coupled
    /// with it.
    /// @param base  cross fit from which gains are counted; it lacks at least the last effect
    CrossFit closer(const CrossFit& base, CrossFit whole, const Candidate& last) const;

    /// A setting as its effect's simpler form, with the candidate of that form; empty where it has none that
    /// may be named.
    struct PlainForm {
        const Candidate* candidate;
        plant::EffectSetting setting;
    };
    std::optional<PlainForm> plain_form_of(const plant::EffectSetting& setting) const;

    /// Signals whose fits an effect influences (gap/fit/cross_fit.h).
    SignalFlags concerned_by(const Candidate& candidate, const CrossFit& whole) const {
        return fitter_.concerned_by(*candidate.effect, whole.of_half[0]);
    }

    /// Whether an effect is to be accepted: its gain is significant, corrected for all that was tried, and it
    /// removes a good part of some signal's excess over its floor. The latter is needed because many an
    /// effect gains a little where the true law, or that of another effect in the explanation, differs
    /// slightly from the catalogue's. For the same reason an effect that leaves the signal clearly off its
    /// floor has to remove a thousandth of the excess that the signal had before any effect. The gain need
    /// not be significant if a signal comes to its floor, predicted by what was fitted to the other half, of
    /// which three windows of each half, or six of one half from two runs, or the shapes of twice as many
    /// tags were far off: that is no chance, however few windows there are.
    bool is_real(const CrossFit& without, const CrossFit& with) const;

    /// Whether an effect's gain is significant, corrected for all that was tried, however large a gap it
    /// leaves.
    /// @param times  factor by which the significance must exceed its bound
    bool is_no_chance(const CrossFit& without, const CrossFit& with, double times = 1.0) const;

    /// Whether an effect removes at least `share` of some signal's excess over its floor.
    bool nearly_clears(const CrossFit& without, const CrossFit& with, double share = all_but_noise) const;

    /// Signals that are off (above) their floors.
    SignalFlags off(const CrossFit& fitted) const;

    /// Signals whose r.m.s. error is more than this many floors.
    SignalFlags far_off(const CrossFit& fitted, double floors = far_off_floors) const;

    /// The signal that is the largest number of floors off its own; empty where all are at their floors.
    std::optional<Signal> furthest_off(const CrossFit& fitted) const;

    /// A signal's typical error (gap/fit/gap_size.h), floors.
    double typical_floors(const CrossFit& fitted, Signal signal) const {
        return gap::typical_floors(fitter_.evidence().windows(), fitted.mean_squares)[index_of(signal)];
    }

    /// The gap over all signals, in floors (gap/fit/gap_size.h), that a setting alone would make in the rig
    /// as its file describes it: by how much it changes the predictions.
    double gap_alone(const plant::EffectSetting& setting) const;

    /// Whether every signal is at its floor: nothing is left for another effect to explain.
    bool is_at_floor(const CrossFit& fitted) const;

    /// Signals whose excess over their floors is larger than the least that a further effect has to remove.
    SignalFlags leaves_much(const CrossFit& fitted) const;

    /// Whether no signal has such an excess.
    bool leaves_little(const CrossFit& fitted) const;

    /// Whether the lead of the best cross fit over another one is not significant.
    bool ties(const CrossFit& best, const CrossFit& other) const;

    struct Contender;

  private:
    Together together(const std::array<Hypothesis, 2>& beside, NeededCandidates needed) const;
    struct EverythingBeside;
    /// Signals of which all smooth candidates are fitted at once. Of the tags alone: the candidates that the
    /// Hall reading does not show.
    enum class SmoothSignals { hall_and_tags, hall_alone, tags_alone };
    EverythingBeside everything_of(const CrossFit& base, SmoothSignals of) const;
    Together needed_of(const EverythingBeside& all, IfFar if_far);
    /// Where no sizes alone come near an optimum of a signal: with the shapes that promise anything, or, if
    /// none does, as near as sizes come.
    Together from_afar(SmoothSignals of, const CrossFit& base, Signal signal);
    /// What was found of the Hall reading, with what the camera alone sees; or, where that leaves something
    /// in the tags, both anew.
    Together view_and_wire(Together of_hall, bool is_of_view_alone);
    /// Both signals together. No candidates where the fit does not come near its optimum.
    Together hall_and_tags(const CrossFit& base);
    /// shaped_beside(), with effects that are estimated from these signals. Beside effects of the Hall
    /// reading beside which no shape was needed before, none is looked for again.
    Together shaped_among(SmoothSignals of, const CrossFit& base, Signal signal);
    /// Those of all smooth candidates and of some shapes that are needed beside a base's other effects.
    /// @param all  of Hall reading and tags beside this base
    Together needed_with(const CrossFit& base, const EverythingBeside& all, const Hypothesis& shapes);

    /// Ends the search, because the budget has ended; what was found is still judged.
    void end(Ended how);
    /// Settings of waves with the periods along the rail that the errors of encoder and tags show.
    Hypothesis waves_of_reading(const CrossFit& base, std::span<const Candidate* const> candidates) const;
    Together balanced_beside(const CrossFit& base) const;
    class CloserFit;
    /// The wave that a scan finds in those encoder windows of the first half that are far off without one
    /// (gap/starts/wave_scan.h). Empty unless the predicted carriage runs away in a few windows, by which
    /// alone a weak wave shows; and empty for a carriage on a belt, whose predictions cost too much.
    std::optional<plant::EffectSetting> scanned_wave(const Hypothesis& beside, const Candidate& wave) const;
    /// Loss that an explanation saves in those windows of the first half in which candidates are looked at.
    double gain_where_looked(const CrossFit& base, const CrossFit& explanation) const;
    Contender contender(const CrossFit& base, const Candidate& candidate);
    /// Candidates that are not `added` and may improve a signal that is off its floor.
    std::vector<const Candidate*> in_question(const CrossFit& base,
                                              std::span<const Candidate* const> added) const;
    std::vector<Contender> contenders(const CrossFit& base, std::span<const Candidate* const> added);
    /// Finds start values for the fits of contenders.
    void look_at(const CrossFit& base, std::span<Contender> contenders);
    void fit_simple_first(const CrossFit& base, std::span<Contender> contenders) const;
    /// Fits a contender on the first half from each of its best start values, then judges it on some windows
    /// of the other half.
    void fit_first_half(const CrossFit& base, std::span<Contender* const> contenders) const;
    void judge_first_half(const CrossFit& base, Contender& contender) const;
    void fit_second_half(const CrossFit& base, Contender& contender) const;
    /// Fits the simpler form on both halves, starting from the richer effect's fit: beside a base that was
    /// fitted without either, it may promise nothing by itself. Keeps the earlier fit if that is better.
    void fit_plain_form(const CrossFit& base, const Contender& richer, Contender& plain) const;
    /// Fits the richer effect over the grid of its shapes, starting from its simpler form's fit: a fit from a
    /// distant start may have ended at that form. Keeps the earlier fit if that is better.
    void fit_rich_form(const CrossFit& base, const Contender& plain, Contender& richer) const;
    /// The leaders, joined by others that are fitted now and gain enough for a leader; sorted by gain and
    /// moved to the front.
    /// @param fit  fits a contender if it is to be fitted, and returns whether it has
    static std::span<Contender> with_fitted(std::span<Contender> all, std::size_t leaders,
                                            const std::function<bool(Contender&)>& fit);
    /// The leaders, joined by the simpler forms of the best one, fitted starting from it.
    std::span<Contender> with_limits(const CrossFit& base, std::span<Contender> all,
                                     std::size_t leaders) const;
    /// The leaders, joined by the richer effects of which the best leader is the simpler form, fitted
    /// starting from it if it leaves a gap.
    std::span<Contender> with_richer(const CrossFit& base, std::span<Contender> all,
                                     std::size_t leaders) const;
    /// Continues a coarse fit that leaves its signals off their floors: from its end, on the windows that are
    /// then most instructive; a wave by a simplex on all windows, as its loss has many minima. A simplex is
    /// also used where derivatives do not lead to the optimum: for effects of encoder and camera, because the
    /// carriage's place within its count can compensate them up to the count's end, and for effects that
    /// remove nearly all of a signal's excess. Ends after a share of the search's effort: a single effect
    /// that is not close by then may be a compromise of two.
    /// @param scatters  whether a wave or a spring is also fitted from many drawn values
    void fit_closer(const CrossFit& base, Contender& contender, bool scatters = true,
                    double share_of_effort = usual_share_of_effort) const;
    /// Fits also those leaders closely that come near the best, if that leaves a gap: after coarse fits only,
    /// the true cause may rank behind an effect that imitates it. Sorts the leaders by gain.
    void fit_rivals(const CrossFit& base, std::span<Contender> leaders) const;
    /// Fits the leaders closely, with their simpler and richer forms among all contenders; afterwards the
    /// first contender is the one to be accepted. A contender replaces another one only if it is judged
    /// better, so that nothing is lost whenever this ends.
    void refine(const CrossFit& base, std::span<Contender> all, std::span<Contender> leaders,
                const Effort& effort) const;
    /// Of the leaders, which precede all others, moves those whose gain is real before the rest.
    void put_real_ones_first(const CrossFit& base, std::span<Contender> all) const;
    Hypothesis fitted_from_there(const CrossFit& base, const Contender& contender, std::size_t side,
                                 double step_scales) const;
    /// A wave or a spring, fitted from the best of many drawn values.
    Contender scattered(const CrossFit& base, const Contender& contender) const;
    /// Refits each half from the other half's values where these fit it better than its own.
    Contender crossed(const CrossFit& base, const Contender& contender) const;
    /// Fits with one or two optional parameters, from each of their start values: from a fit without them no
    /// derivative leads to them, and far from the optimum they only seem to do harm.
    Contender refined(const CrossFit& base, const Contender& contender) const;
    /// Fits the first half from a given start, then the other half from that result: a fit of the other half
    /// alone may miss the deeper of two neighbouring minima.
    Contender fitted_on(const CrossFit& base, const Contender& contender, const Hypothesis& start) const;
    Fit polished(const Contender& contender, std::size_t side, const Places& places) const;
    void judge_both_halves(const CrossFit& base, Contender& contender) const;
    /// Loss in all windows of a half from which the candidate's parameters are estimated.
    double loss_on_half(std::size_t side, const Hypothesis& whole, const Candidate& taught) const;
    /// Whether a gain is significant, corrected for all that was tried.
    bool is_significant(const Comparison& comparison, double times = 1.0) const;
    /// Whether some signal loses this share of its excess, and either comes near its floor or loses
    /// `share_of_first` of the excess that it had before any effect.
    bool clears_a_signal(const CrossFit& without, const CrossFit& with, double share,
                         double share_of_first = 0.0) const;
    /// Whether a signal that was far off comes to its floor; of tags, nearly so.
    bool clears_what_is_far_off(const CrossFit& without, const CrossFit& with) const;
    /// Whether a signal is off by 3 floors and more in three windows of each half, or in six of one half that
    /// come from two runs, or in the shapes of twice as many tags. A shape, the seven values of a detection
    /// that do not depend on where the stages are, has errors that are independent from frame to frame.
    bool is_far_off(const CrossFit& cross, Signal signal) const;
    /// For each detection of a half whose shape is far off, as predicted by the fit to the other half: its
    /// run.
    std::vector<std::size_t> runs_of_shapes_far_off(const CrossFit& cross, std::size_t side) const;
    /// Index, among leaders sorted by gain, of the one with the fewest parameters that ties with the best, or
    /// brings the best one's signals to their floors, or is the best one's simpler form if the latter's gain
    /// over it is not real. (Bristles that deflect over no distance are Coulomb friction, fitted a little
    /// better.)
    std::size_t simplest(std::span<const Contender> leaders) const;

    bool is_exhausted() const;
    /// Throws SearchExhausted if the effort is spent: fits end at once from then on, so that their results
    /// are worthless.
    void throw_if_exhausted() const;

    const std::vector<Candidate>& candidates_;
    SearchOptions options_;
    double effort_at_start_;
    bool is_limited_ = false;
    SignalFlags focus_ = all_signals;
    double share_of_effort_ = 1.0;
    std::optional<Ended> over_;  ///< how the budget ended during a refinement
    CrossFitter fitter_;
    SearchMemory memory_;
    SignalExcess first_excess_;  ///< before any effect
    /// Effects of the Hall reading beside which no shape was needed.
    std::optional<std::set<const plant::Effect*>> hall_screened_beside_;
    int trials_ = 0;
};

}  // namespace fidservo::gap

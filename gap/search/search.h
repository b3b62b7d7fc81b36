// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of a search: which effect, added to those already accepted, gives the best predictions of the
// windows that were not fitted.
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

/// A candidate as an addition to a hypothesis. A candidate that promised little was not fitted; it has no
/// gain and no cross fit.
struct Trial {
    const Candidate* candidate = nullptr;
    double promised = 0.0;  ///< loss saved in the windows to be fitted, as estimated without a fit
    double gain = 0.0;      ///< loss saved in the held-out windows
    /// Whether it was fitted on both halves. Otherwise it was fitted on the first half or not at all, and
    /// judged on some windows of the second half.
    bool is_leader = false;
    CrossFit fitted = {};
};

/// How many of the most promising candidates a step fits, and how many of these on both halves.
struct Effort {
    std::size_t fits = wide_beam, leaders = beam;
    /// Whether a wave or a spring that is best and leaves a gap is also fitted from many randomly drawn start
    /// values.
    bool scatters = true;
    bool refines = true;  ///< whether the leaders' first, coarse fits are followed by close ones
    /// Another explanation that the candidates compete with: candidates that promise little compared with its
    /// gain are not fitted. May be null.
    const CrossFit* competitor = nullptr;
};

/// Share of the effort of a search that the close fit of one effect gets; and what each of two searches gets
/// of the time, or of the effort.
inline constexpr double usual_share_of_effort = 0.25, half_of_it = 0.5;

/// Shares of a signal's excess over its floor that count as all of it but for noise; and that a wave removes
/// once it is in the right local minimum, with its phase and period nearly right.
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
    /// Significance level of the whole search: the probability of accepting any effect if the rig has none.
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

    /// Throws SearchExhausted if the evidence's budget has ended during a fit whose best result so far was
    /// kept.
    void throw_if_over() const;

    /// Switches the limit on the effort (SearchOptions::most_effort) on or off; it is off at first. Once a
    /// limited effort is spent, all functions that fit throw SearchExhausted.
    void limit(bool is_limited) { is_limited_ = is_limited; }

    /// Restricts the search to effects that change any of some signals, and to a share of the whole effort,
    /// counted from the start of the search. Without a call it looks at all signals with the whole effort.
    void look_for_causes_in(const SignalFlags& signals, double share_of_effort) {
        focus_ = signals;
        share_of_effort_ = share_of_effort;
    }

    /// The smooth candidates of Hall reading and tags (is_smooth()) that are needed beside a base's other
    /// effects, fitted at once on both halves (gap/search/everything.h). Their fits start from the base's
    /// settings of these candidates; their settings are the last ones of `fitted`, in the order of
    /// `candidates`. A Hall reading that is off its floor is explained first, without the tags: by candidates
    /// without shape parameters or, if these do not come near an optimum, also by the most promising ones
    /// with shape parameters. Once the Hall reading is not far off, the tags are explained by effects of the
    /// camera alone. If tags remain off their floor then, both signals are explained together, unless the
    /// carriage, whose errors also show in the tags, is still off.
    struct Together {
        std::vector<const Candidate*> candidates;
        std::vector<double> worth;  ///< loss that each saves beside the others
        CrossFit fitted;
    };
    Together everything_beside(const CrossFit& base);

    /// Like everything_beside(), after the Hall reading was explained: the tags by effects of the camera
    /// alone and, if they remain off their floor, both signals together. If the Hall reading is far off, both
    /// signals together at once; no candidates if that fit does not come near an optimum.
    Together tags_beside(const CrossFit& base);

    /// An explanation like that of everything_beside(), with effects that have shape parameters: all those
    /// that promise to save loss in `signal`, fitted at once. If that fit finds none of them needed, the most
    /// promising one alone. The base if none promises anything.
    /// @param signal  Signal::hall: effects estimated from the Hall reading; Signal::tag: those of both
    /// signals
    Together shaped_beside(const CrossFit& base, Signal signal);

    /// Effects on the carriage beside a base that has none. Regression of the balance of forces
    /// (gap/balance/force_regression.h) gives several models; the model, and the form of its effects, that
    /// predicts best when the carriage is simulated is taken, with all further smooth effects that are
    /// needed. The base alone if there is no model. Does not count as effort.
    Together forces_beside(const CrossFit& base);

    /// Whether a candidate can be found from the balance of forces (gap/balance/force_regression.h).
    bool is_force(const Candidate& candidate) const;

    /// The time budget.
    const Budget& budget() const { return *fitter_.evidence().budget(); }

    /// How the budget ended, if it ended during a fit whose best result so far was kept; otherwise empty.
    std::optional<Ended> over() const { return over_; }

    CrossFit nothing() const;

    /// Tries all candidates except those in `added` as additions to a base. The leaders (Trial::is_leader)
    /// come first, those whose gain is real (is_real()) before the others, by gain; but the very first is the
    /// one with the fewest parameters among those that tie with the best or also bring its signals to their
    /// floors. Candidates that could improve only signals that are at their floors are not fitted.
    std::vector<Trial> try_all(const CrossFit& base, std::span<const Candidate* const> added,
                               const Effort& effort = {});

    /// Scans the whole range of periods and phases for weak force waves along the rail beside a base
    /// (gap/starts/wave_scan.h), in windows that are far off their floors. Returns whether a wave promises
    /// more than the start values known before, so that try_all() may give another result.
    bool scan_for_wave(const CrossFit& base, std::span<const Candidate* const> added);

    /// The base with a candidate that try_all has tried beside it, fitted on both halves. Empty if no
    /// prediction was possible, because the simulator rejects the candidate or the search was stopped.
    std::optional<CrossFit> with(const CrossFit& base, const Candidate& candidate);

    /// Stores a fit of a candidate beside a base: `whole` is the base with the candidate at index `at` of its
    /// settings. try_all() beside this base then fits only candidates that promise about as much.
    void remember(const CrossFit& base, const Candidate& candidate, const CrossFit& whole, std::size_t at);

    /// Refits those settings that are estimated from any of the given signals, and the settings coupled with
    /// them, starting from their present values.
    void fit_again(CrossFit& cross, const SignalFlags& signals) const;

    /// Judges a cross fit with its present values.
    void judge(CrossFit& cross) const { fitter_.judge(cross); }

    /// A cross fit whose last effect is a candidate, after a close fit of that effect and of those coupled
    /// with it.
    /// @param base  cross fit from which gains are counted; it lacks at least the last effect
    CrossFit closer(const CrossFit& base, CrossFit whole, const Candidate& last) const;

    /// The simpler form of a setting's effect, with the setting converted to it; empty if the effect has no
    /// simpler form that may be named.
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
    /// removes a good part of some signal's excess over its floor. The latter is required because the true
    /// law of another effect may differ slightly from the catalogue's, so that many effects gain a little.
    /// For the same reason an effect that leaves the signal clearly off its floor has to remove a thousandth
    /// of the excess that the signal had before any effect. The gain need not be significant if the effect
    /// brings a signal that was far off (is_far_off()) to its floor in cross prediction; with few windows, no
    /// gain would be significant.
    bool is_real(const CrossFit& without, const CrossFit& with) const;

    /// Whether an effect's gain is significant, corrected for all that was tried. Unlike is_real(), it does
    /// not matter how much of a gap the effect removes.
    /// @param times  factor by which the significance must exceed its bound
    bool is_no_chance(const CrossFit& without, const CrossFit& with, double times = 1.0) const;

    /// Whether an effect removes at least `share` of some signal's excess over its floor.
    bool nearly_clears(const CrossFit& without, const CrossFit& with, double share = all_but_noise) const;

    /// Signals that are off (above) their floors.
    SignalFlags off(const CrossFit& fitted) const;

    /// Signals whose r.m.s. error is more than this many floors.
    SignalFlags far_off(const CrossFit& fitted, double floors = far_off_floors) const;

    /// The signal with the largest r.m.s. error in units of its floor; empty if all are at their floors.
    std::optional<Signal> furthest_off(const CrossFit& fitted) const;

    /// A signal's typical error (gap/fit/gap_size.h), floors.
    double typical_floors(const CrossFit& fitted, Signal signal) const {
        return gap::typical_floors(fitter_.evidence().windows(), fitted.mean_squares)[index_of(signal)];
    }

    /// The gap over all signals, in floors (gap/fit/gap_size.h), that would result if the rig had this effect
    /// and nothing else that its file does not state: the change of the predictions by the effect.
    double gap_alone(const plant::EffectSetting& setting) const;

    /// Whether every signal is at its floor: nothing is left for another effect to explain.
    bool is_at_floor(const CrossFit& fitted) const;

    /// Signals whose excess over their floors is large enough for a further effect: more than a thousandth of
    /// the excess before any effect (see is_real()).
    SignalFlags leaves_much(const CrossFit& fitted) const;

    /// Whether leaves_much() is true of no signal.
    bool leaves_little(const CrossFit& fitted) const;

    /// Whether the gain of the best cross fit over another one is too small to be significant.
    bool ties(const CrossFit& best, const CrossFit& other) const;

    struct Contender;

  private:
    Together together(const std::array<Hypothesis, 2>& beside, NeededCandidates needed) const;
    struct EverythingBeside;
    /// The signals whose smooth candidates are fitted at once; `tags_alone`: the candidates that do not
    /// change the Hall reading.
    enum class SmoothSignals { hall_and_tags, hall_alone, tags_alone };
    EverythingBeside everything_of(const CrossFit& base, SmoothSignals of) const;
    Together needed_of(const EverythingBeside& all, IfFar if_far);
    /// For a signal whose optimum no candidates without shape parameters come near: the result with the most
    /// promising candidates with shape parameters; or, if these are not needed, without them, as near as that
    /// fit comes.
    Together from_afar(SmoothSignals of, const CrossFit& base, Signal signal);
    /// The result for the Hall reading, with the needed effects of the camera alone added. If the tags remain
    /// off their floor, hall_and_tags() instead, where its fit comes near an optimum.
    Together view_and_wire(Together of_hall, bool is_of_view_alone);
    /// The needed smooth candidates of both signals, fitted together. No candidates if the fit does not come
    /// near an optimum.
    Together hall_and_tags(const CrossFit& base);
    /// shaped_beside(), with effects that are estimated from the signals `of`. The search for shapes in the
    /// Hall reading is not repeated beside effects beside which none was needed before.
    Together shaped_among(SmoothSignals of, const CrossFit& base, Signal signal);
    /// The candidates that are needed beside a base's other effects, out of all smooth ones, with `shapes` as
    /// start settings of those that have shape parameters.
    /// @param all  what is fitted at once beside this base
    Together needed_with(const CrossFit& base, const EverythingBeside& all, const Hypothesis& shapes);

    /// Ends the search because the budget has ended. What was found until then is still judged.
    void end(Ended how);
    /// Settings of waves with the periods along the rail that the errors of encoder and tags show.
    Hypothesis waves_of_reading(const CrossFit& base, std::span<const Candidate* const> candidates) const;
    Together balanced_beside(const CrossFit& base) const;
    class CloserFit;
    /// The force wave that a scan finds (gap/starts/wave_scan.h) in those encoder windows of the first half
    /// that are far off without a wave. Empty unless the predicted position is off by 10 mm r.m.s. in at
    /// least three windows, since a weak wave shows only in which way a carriage takes; empty for a carriage
    /// on a belt, whose predictions cost too much.
    std::optional<plant::EffectSetting> scanned_wave(const Hypothesis& beside, const Candidate& wave) const;
    /// Loss that an explanation saves relative to a base, in those windows of the first half in which the
    /// promise of candidates is estimated.
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
    /// Fits the simpler form on both halves, starting from the richer effect's fit: from its own start
    /// values, beside a base that was fitted without either form, it may seem to save nothing. Keeps the
    /// earlier fit if that is better.
    void fit_plain_form(const CrossFit& base, const Contender& richer, Contender& plain) const;
    /// Fits the richer effect over the grid of its shapes, starting from its simpler form's fit: a fit from a
    /// distant start may have ended at that form. Keeps the earlier fit if that is better.
    void fit_rich_form(const CrossFit& base, const Contender& plain, Contender& richer) const;
    /// Fits further contenders; those that gain enough join the leaders. Returns the leaders, sorted by gain
    /// and moved to the front of `all`.
    /// @param fit  fits a contender if it should be fitted, and returns whether it was
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
    /// remove nearly all of a signal's excess. Ends after a share of the search's effort, since a single
    /// effect that is still far from the optimum may be a compromise between two.
    /// @param scatters  whether a wave or a spring is also fitted from many randomly drawn start values
    void fit_closer(const CrossFit& base, Contender& contender, bool scatters = true,
                    double share_of_effort = usual_share_of_effort) const;
    /// If the best leader leaves a gap, also fits closely those leaders whose gain comes near its own: after
    /// coarse fits only, the true cause may rank behind an effect that imitates it. Sorts the leaders by
    /// gain.
    void fit_rivals(const CrossFit& base, std::span<Contender> leaders) const;
    /// Fits the leaders closely, with their simpler and richer forms among all contenders; afterwards the
    /// first contender is the one to be accepted. A contender is replaced only by a better one, so that the
    /// best result so far is kept whenever the budget ends.
    void refine(const CrossFit& base, std::span<Contender> all, std::span<Contender> leaders,
                const Effort& effort) const;
    /// Of the leaders, which precede all others, moves those whose gain is real before the rest.
    void put_real_ones_first(const CrossFit& base, std::span<Contender> all) const;
    Hypothesis fitted_from_there(const CrossFit& base, const Contender& contender, std::size_t side,
                                 double step_scales) const;
    /// A wave or a spring, fitted from the best of many randomly drawn start values.
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
    /// Whether some signal loses at least this share of its excess over its floor, and either comes near its
    /// floor or loses `share_of_first` of the excess that it had before any effect.
    bool clears_a_signal(const CrossFit& without, const CrossFit& with, double share,
                         double share_of_first = 0.0) const;
    /// Whether a signal that was far off comes to its floor; for tags, near its floor suffices.
    bool clears_what_is_far_off(const CrossFit& without, const CrossFit& with) const;
    /// Whether a signal is off by 3 floors or more in at least three windows of each half, or in six windows
    /// of one half that come from two recordings; for tags, also in the shapes of twice as many detections.
    /// The shape, the seven values of a detection that do not depend on the position of the stages, has
    /// errors that are independent from frame to frame.
    bool is_far_off(const CrossFit& cross, Signal signal) const;
    /// The recording of each detection of a half whose shape is far off, as predicted by the fit to the other
    /// half.
    std::vector<std::size_t> runs_of_shapes_far_off(const CrossFit& cross, std::size_t side) const;
    /// Index, among leaders sorted by gain, of the one with the fewest parameters that ties with the best, or
    /// brings the best one's signals to their floors, or is a simpler form of the best one, whose additional
    /// gain is not real. (Bristles of negligible deflection, for example, are Coulomb friction with one more
    /// parameter to fit.)
    std::size_t simplest(std::span<const Contender> leaders) const;

    bool is_exhausted() const;
    /// Throws SearchExhausted if the effort is spent. Fits that end after that stop at once and are
    /// worthless.
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
    /// Effects on the Hall reading beside which no effect with shape parameters was needed.
    std::optional<std::set<const plant::Effect*>> hall_screened_beside_;
    int trials_ = 0;
};

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
// The close fit of one effect: several methods, one after the other, as long as a gap is left.
#include "core/parallel.h"
#include "gap/numbers.h"
#include "gap/search/contender.h"
#include "gap/search/search.h"
#include "gap/starts/scatter.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace fidservo::gap {
namespace {

/// Whether a candidate's sizes vanish in the fit to one of the halves.
bool vanishes_on_a_half(const Trial& trial) {
    return std::ranges::any_of(trial.fitted.of_half, [&](const Hypothesis& hypothesis) {
        const plant::EffectSetting& fitted = hypothesis.back();
        return std::ranges::all_of(trial.candidate->sizes, [&](std::size_t k) {
            return fitted.values[k] == fitted.effect->parameters[k].vanishing;
        });
    });
}

/// Whether an effect displaces tags in the image. The carriage's place within its count can compensate such
/// an effect up to the count's end.
bool moves_tags(const Candidate& candidate) {
    const plant::Part part = candidate.effect->part;
    return part == plant::Part::encoder || plant::is_of_camera(part);
}

/// Shares of a signal's excess that have to be removed before a close fit, and more costly methods, are
/// tried.
constexpr double worth_it = small_part, worth_more = larger_part;

}  // namespace

/// The close fit of one contender. In each round every method that is due starts from the round's best result
/// so far, and replaces that if it gains more.
class Search::CloserFit {
  public:
    CloserFit(const Search& search, const CrossFit& base, Contender& contender, bool scatters,
              double most_effort)
        : search_(search),
          base_(base),
          contender_(contender),
          scatters_(scatters),
          most_effort_(most_effort),
          is_wave_(contender.trial.candidate->wave.has_value()),
          is_in_valleys_(has_valleys(*contender.trial.candidate)),
          effort_at_start_(search.fitter_.evidence().effort()) {}

    void run() {
        Finding& finding = *contender_.finding;
        const Sought asked = scatters_ || !is_in_valleys_ ? Sought::among_many : Sought::from_there;
        if (finding.sought >= asked || vanishes_on_a_half(contender_.trial)) return;
        if (!clears(contender_, is_wave_ ? worth_more : worth_it)) return;
        bool has_gone_on = finding.sought != Sought::nowhere;
        for (int round = 0; round < most_rounds && !is_worn_out(); ++round) {
            if (!leaves_something()) return;
            Contender closer = after_a_round(has_gone_on);
            has_gone_on = false;
            if (!keep(std::move(closer))) break;
        }
        finding.sought = asked;
    }

  private:
    /// @param has_gone_on  whether an earlier call has continued the fit from here already: that is then
    /// repeated only where drawing many values gains nothing
    Contender after_a_round(bool has_gone_on) const {
        Contender best = contender_;
        const auto or_else = [&](Contender other) {
            if (other.gain() > best.gain()) best = std::move(other);
        };
        if (!has_gone_on) or_else(gone_on());
        if (is_wave_ && is_worth_scattering(best)) or_else(search_.scattered(base_, best));
        if (has_gone_on && best.gain() <= contender_.gain()) or_else(gone_on());
        if (!is_wave_ && is_off(best)) or_else(by_slopes(close_step));
        if (is_worth_refining(best)) or_else(search_.refined(base_, best));
        // A spring is drawn once it is known whether it hardens.
        if (!is_wave_ && is_worth_scattering(best)) or_else(search_.scattered(base_, best));
        if (is_off(best)) or_else(search_.crossed(base_, best));
        if (is_worth_a_simplex(best)) or_else(by_simplex(best, itself()));
        if (is_worth_a_simplex_with_others(best)) or_else(by_simplex(best, contender_.fitted_places(base_)));
        return best;
    }

    /// @return whether another round may gain more
    bool keep(Contender closer) {
        constexpr double worth_another = 4.0 * least_gain;
        // A wave that stays far off needs another local minimum, not further rounds.
        const bool is_of_another_valley = is_wave_ && !scatters_ && is_far_off(closer);
        const bool goes_on = !is_of_another_valley && closer.gain() >= contender_.gain() + worth_another;
        if (closer.gain() > contender_.gain()) {
            for (std::size_t side = 0; side < 2; ++side)
                contender_.finding->fitted[side] = contender_.part(closer.trial.fitted.of_half[side]);
            contender_ = std::move(closer);
        }
        return goes_on;
    }

    Contender gone_on() const { return is_wave_ ? by_simplex(contender_, itself()) : by_slopes(usual_step); }

    Contender by_slopes(double step_scales) const {
        return fitted_by([&](std::size_t side) {
            return search_.fitted_from_there(base_, contender_, side, step_scales);
        });
    }

    Contender by_simplex(const Contender& from, const Places& places) const {
        return fitted_by([&](std::size_t side) { return search_.polished(from, side, places).hypothesis; });
    }

    template <class FitSide>
    Contender fitted_by(const FitSide& fit_side) const {
        Contender closer = contender_;
        parallel_for(2, [&](std::size_t side) { closer.trial.fitted.of_half[side] = fit_side(side); });
        search_.judge_both_halves(base_, closer);
        return closer;
    }

    /// Whether a signal is off its floor that the candidate changes, directly or indirectly: tags can tell
    /// more precisely than counts how the carriage moves.
    bool leaves_something() const {
        return meet(search_.off(contender_.trial.fitted),
                    reached_by({contender_.trial.fitted.of_half[0].back()}));
    }

    bool is_worth_scattering(const Contender& best) const {
        return is_in_valleys_ && scatters_ && is_far_off(best) && clears(best, all_but_noise);
    }

    /// Whether optional parameters are worth a try: a wave's harmonic once the wave is in the right local
    /// minimum or was drawn; those of other effects once most of the excess is removed, or half of it where
    /// no stick-slip hides their influence.
    bool is_worth_refining(const Contender& best) const {
        if (!is_off(best) || is_worn_out() || (is_wave_ && !scatters_ && is_far_off(best))) return false;
        if (is_wave_ && !scatters_) return clears(best, in_its_valley);
        return clears(best, contender_.teachers()[index_of(Signal::encoder)] ? nearly_all : worth_more);
    }

    bool is_worth_a_simplex(const Contender& best) const {
        return !is_wave_ && is_off(best) && !is_worn_out() &&
               (moves_tags(*contender_.trial.candidate) || clears(best, all_but_noise));
    }

    bool is_worth_a_simplex_with_others(const Contender& best) const {
        return is_off(best) && !is_worn_out() && !contender_.coupled.empty() && clears(best, all_but_noise);
    }

    bool clears(const Contender& contender, double share) const {
        return search_.clears_a_signal(base_, contender.trial.fitted, share);
    }
    bool is_off(const Contender& contender) const {
        return meet(search_.off(contender.trial.fitted), contender.teachers());
    }
    bool is_far_off(const Contender& contender) const {
        return meet(search_.far_off(contender.trial.fitted), contender.teachers());
    }
    bool is_worn_out() const { return search_.fitter_.evidence().effort() - effort_at_start_ > most_effort_; }
    Places itself() const { return {base_.of_half[0].size()}; }

    const Search& search_;
    const CrossFit& base_;
    Contender& contender_;
    bool scatters_;
    double most_effort_;
    bool is_wave_, is_in_valleys_;
    double effort_at_start_;
};

void Search::fit_closer(const CrossFit& base, Contender& contender, bool scatters,
                        double share_of_effort) const {
    if (options_.tell) options_.tell(fmt::format("{} closer", contender.trial.candidate->effect->name));
    CloserFit(*this, base, contender, scatters, share_of_effort * options_.most_effort).run();
}

CrossFit Search::closer(const CrossFit& base, CrossFit whole, const Candidate& last) const {
    CrossFit rest = base;
    for (std::size_t side = 0; side < 2; ++side)
        rest.of_half[side].assign(whole.of_half[side].begin(), whole.of_half[side].end() - 1);
    Finding finding;
    Contender contender{{.candidate = &last, .gain = base.loss - whole.loss, .fitted = std::move(whole)},
                        coupled_with(rest.of_half[0], *last.effect),
                        &finding};
    for (std::size_t side = 0; side < 2; ++side)
        finding.fitted[side] = contender.part(contender.trial.fitted.of_half[side]);
    fit_closer(rest, contender, true, half_of_it);
    return std::move(contender.trial.fitted);
}

}  // namespace fidservo::gap

#include "gap/scatter.h"

#include "core/random.h"
#include "gap/balanced_springs.h"
#include "gap/parallel.h"
#include "gap/score.h"
#include "gap/wave.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

using Moves = std::vector<double>;

/// A wave or a spring and what is drawn of it, as moves from where it is.
class Drawn {
  public:
    explicit Drawn(const plant::EffectSetting& start)
        : start_(start), wave_(wave_of(*start.effect)), refinements_(refinements_of(*start.effect)) {}

    /// Of the first generation.
    Moves deviations() const {
        constexpr double size_shares = 0.35, phase_rad = 0.35, waves_per_mm = 0.175 / 200.0,
                         harmonic_shares = 0.105, centre_mm = 20.0, hardening_shares = 0.5,
                         least_hardening = 0.5;
        Moves deviations =
            wave_ ? Moves{size_shares, waves_per_mm, phase_rad} : Moves{size_shares, centre_mm};
        for (const Refinement& refinement : refinements_)
            deviations.push_back(wave_ ? harmonic_shares
                                       : hardening_shares *
                                             std::max(start_.values[refinement.parameter], least_hardening));
        return deviations;
    }

    plant::EffectSetting at(const Moves& moves) const {
        plant::EffectSetting there = start_;
        const auto set = [&](std::size_t k, double value) {
            there.values[k] =
                std::clamp(value, there.effect->parameters[k].low, there.effect->parameters[k].high);
        };
        std::size_t next = 0;
        if (wave_) {
            constexpr double longest_mm = 1e6;
            const auto [amplitude, period, phase, is_force] = *wave_;
            const double before_mm = start_.values[period];
            set(amplitude, start_.values[amplitude] * std::exp(moves[next++]));
            set(period, 1.0 / std::max(1.0 / before_mm + moves[next++], 1.0 / longest_mm));
            there.values[phase] =
                phase_in_step(start_.values[phase] + moves[next++], before_mm, there.values[period]);
        } else {
            constexpr std::size_t stiffness = 0, centre = 1;
            set(stiffness, start_.values[stiffness] * std::exp(moves[next++]));
            set(centre, start_.values[centre] + moves[next++]);
        }
        for (const Refinement& refinement : refinements_)
            set(refinement.parameter, start_.values[refinement.parameter] + moves[next++]);
        return there;
    }

  private:
    const plant::EffectSetting& start_;
    std::optional<WaveParameters> wave_;
    std::vector<Refinement> refinements_;
};

struct Draw {
    Moves moves;
    double loss = 0.0;
};

/// Mean and standard deviations of moves, the best of which count most.
class Elite {
  public:
    explicit Elite(Moves deviations) : mean_(deviations.size(), 0.0), deviations_(std::move(deviations)) {}

    Moves drawn(NoiseStream& noise) const {
        Moves moves = mean_;
        for (std::size_t k = 0; k < moves.size(); ++k) moves[k] += deviations_[k] * noise.normal();
        return moves;
    }

    /// @param best  sorted
    void learn(std::span<const Draw> best) {
        constexpr double wider = 1.2;  // a spread of few is too small, as a rule
        for (std::size_t k = 0; k < mean_.size(); ++k) {
            const auto weighted = [&](const auto& value) {
                double sum = 0.0, weights = 0.0;
                for (std::size_t rank = 0; rank < best.size(); ++rank) {
                    const double weight = std::log((static_cast<double>(best.size()) + 0.5) /
                                                   (static_cast<double>(rank) + 1.0));
                    sum += weight * value(best[rank].moves[k]);
                    weights += weight;
                }
                return sum / weights;
            };
            const double mean = weighted([](double move) { return move; });
            mean_[k] = mean;
            deviations_[k] =
                wider * std::sqrt(weighted([mean](double move) { return (move - mean) * (move - mean); }));
        }
    }

  private:
    Moves mean_, deviations_;
};

}  // namespace

bool has_valleys(const Candidate& candidate) {
    return candidate.wave || is_spring(*candidate.effect);
}

Fit scatter(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
            const Hypothesis& start, std::size_t place) {
    constexpr int generations = 8;
    constexpr std::size_t draws = 30, best_of_all = 8;
    const Drawn drawn(start[place]);
    const auto at = [&](const Moves& moves) {
        Hypothesis there = start;
        there[place] = drawn.at(moves);
        return there;
    };
    Elite elite(drawn.deviations());
    std::vector<Draw> best{
        {Moves(drawn.deviations().size(), 0.0), total_loss(windows, counted, predict(start))}};
    NoiseStream noise(1, "wave");
    for (int generation = 0; generation < generations; ++generation) {
        std::vector<Draw> fresh(draws);
        for (Draw& draw : fresh) draw.moves = elite.drawn(noise);
        parallel_for(draws, [&](std::size_t k) {
            fresh[k].loss = total_loss(windows, counted, predict(at(fresh[k].moves)));
        });
        std::ranges::move(fresh, std::back_inserter(best));
        std::ranges::stable_sort(best, {}, &Draw::loss);
        best.resize(best_of_all);
        elite.learn(best);
    }
    return {at(best.front().moves), best.front().loss, {}};
}

}  // namespace fidservo::gap

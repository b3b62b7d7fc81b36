// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/scatter.h"

#include "core/parallel.h"
#include "core/random.h"
#include "gap/balance/balanced_springs.h"
#include "gap/candidates/wave.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

using Moves = std::vector<double>;

/// The sizes of an effect that is neither a wave nor a spring. Moves are changes of their logarithms.
class DrawnSizes {
  public:
    explicit DrawnSizes(const plant::EffectSetting& start) : start_(start) {
        for (std::size_t k = 0; k < start.values.size(); ++k)
            if (start.effect->parameters[k].is_size()) sizes_.push_back(k);
    }

    Moves deviations() const {
        constexpr double shares = 0.1;
        return Moves(sizes_.size(), shares);
    }

    plant::EffectSetting at(std::span<const double> moves) const {
        plant::EffectSetting there = start_;
        for (std::size_t j = 0; j < sizes_.size(); ++j) {
            const plant::EffectParameter& parameter = start_.effect->parameters[sizes_[j]];
            const double size = start_.values[sizes_[j]] - parameter.vanishing;
            there.values[sizes_[j]] =
                std::clamp(parameter.vanishing + size * std::exp(moves[j]), parameter.low, parameter.high);
        }
        return there;
    }

  private:
    const plant::EffectSetting& start_;
    std::vector<std::size_t> sizes_;
};

/// The parameters that are drawn of a wave or a spring. Moves are changes from the start; that of the first
/// one, amplitude or stiffness, is a change of its logarithm.
class DrawnForce {
  public:
    explicit DrawnForce(const plant::EffectSetting& start)
        : start_(start), wave_(wave_of(*start.effect)), refinements_(refinements_of(*start.effect)) {}

    Moves deviations() const {
        constexpr double move = 0.35, harmonic_shares = 0.105, centre_mm = 20.0, hardening_shares = 0.5,
                         least_hardening = 0.5;
        Moves deviations =
            wave_ ? Moves{move, 0.5 * move / (2.0 * rail_middle_mm), move} : Moves{move, centre_mm};
        for (const Refinement& refinement : refinements_)
            deviations.push_back(wave_ ? harmonic_shares
                                       : hardening_shares *
                                             std::max(start_.values[refinement.parameter], least_hardening));
        return deviations;
    }

    plant::EffectSetting at(std::span<const double> moves) const {
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
            enum : std::size_t { stiffness, centre };
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

/// The settings at some places of a hypothesis, with values that are drawn.
class Drawn {
  public:
    Drawn(const Hypothesis& start, const Places& places) : start_(start) {
        for (const std::size_t place : places)
            if (wave_of(*start[place].effect) || is_spring(*start[place].effect))
                forces_.emplace_back(place, start[place]);
            else
                sizes_.emplace_back(place, start[place]);
    }

    /// Standard deviations of the moves in the first generation.
    Moves deviations() const {
        Moves all;
        for_each([&](std::size_t, const auto& drawn) {
            const Moves deviations = drawn.deviations();
            all.insert(all.end(), deviations.begin(), deviations.end());
        });
        return all;
    }

    Hypothesis at(std::span<const double> moves) const {
        Hypothesis there = start_;
        for_each([&](std::size_t place, const auto& drawn) {
            const std::size_t count = drawn.deviations().size();
            there[place] = drawn.at(moves.first(count));
            moves = moves.subspan(count);
        });
        return there;
    }

  private:
    template <class Do>
    void for_each(const Do& with) const {
        for (const auto& [place, drawn] : forces_) with(place, drawn);
        for (const auto& [place, drawn] : sizes_) with(place, drawn);
    }

    const Hypothesis& start_;
    std::vector<std::pair<std::size_t, DrawnForce>> forces_;
    std::vector<std::pair<std::size_t, DrawnSizes>> sizes_;
};

struct Draw {
    Moves moves;
    double loss = 0.0;
};

/// Mean and standard deviations of the best moves, weighted by their ranks.
class Elite {
  public:
    explicit Elite(Moves deviations) : mean_(deviations.size(), 0.0), deviations_(std::move(deviations)) {}

    Moves drawn(NoiseStream& noise) const {
        Moves moves = mean_;
        for (std::size_t k = 0; k < moves.size(); ++k) moves[k] += deviations_[k] * noise.normal();
        return moves;
    }

    /// @param best  sorted by loss
    void learn(std::span<const Draw> best) {
        constexpr double wider = 1.2;  // the scatter of a few values is usually too small
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
            const Hypothesis& start, const Places& places, double spread) {
    constexpr int generations = 8;
    constexpr std::size_t draws = 30, best_of_all = 8;
    const Drawn drawn(start, places);
    Moves deviations = drawn.deviations();
    for (double& deviation : deviations) deviation *= spread;
    Elite elite(std::move(deviations));
    std::vector<Draw> best{
        {Moves(drawn.deviations().size(), 0.0), total_loss(windows, counted, predict(start))}};
    NoiseStream noise(1, "scatter");
    for (int generation = 0; generation < generations; ++generation) {
        std::vector<Draw> fresh(draws);
        for (Draw& draw : fresh) draw.moves = elite.drawn(noise);
        parallel_for(draws, [&](std::size_t k) {
            fresh[k].loss = total_loss(windows, counted, predict(drawn.at(fresh[k].moves)));
        });
        std::ranges::move(fresh, std::back_inserter(best));
        std::ranges::stable_sort(best, {}, &Draw::loss);
        best.resize(best_of_all);
        elite.learn(best);
    }
    return {drawn.at(best.front().moves), best.front().loss, {}};
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/explanations.h"

#include "core/demand.h"
#include "core/parallel.h"
#include "core/random.h"
#include "gap/candidates/candidate.h"
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"
#include "gap/fit/score.h"
#include "src/design/exchanges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace fidservo::design {
namespace {

/// Loss that is lost two standard deviations away from the best value.
constexpr double two_deviations = 2.0;

gap::Predict predict_all(const gap::Evidence& evidence) {
    return [&evidence, wanted = gap::everything(evidence)](const gap::Hypothesis& hypothesis) {
        return evidence.errors(hypothesis, wanted);
    };
}

double loss_of(const gap::Evidence& evidence, const gap::Hypothesis& hypothesis) {
    const gap::Wanted wanted = gap::everything(evidence);
    return gap::total_loss(evidence.windows(), wanted, evidence.errors(hypothesis, wanted));
}

/// Columns whose squares add up to the covariance, each standard deviation at most that of a value which may
/// be anywhere within its bounds; for values at a bound a column inwards, as far as the recordings allow.
class Spread {
  public:
    Spread(const gap::Evidence& evidence, Explanation& explanation, double least_loss)
        : evidence_(evidence),
          explanation_(explanation),
          least_loss_(least_loss),
          parameters_(explanation.hypothesis) {}

    void find(const Eigen::MatrixXd& covariance) {
        add_regular(covariance);
        for (std::size_t k = 0; k < parameters_.size(); ++k)
            if (parameters_.at_bound(k) && !parameters_.is_level(k)) add_inwards(k);
        const auto rows = static_cast<Eigen::Index>(parameters_.size());
        explanation_.spread.resize(rows, static_cast<Eigen::Index>(columns_.size()));
        for (std::size_t c = 0; c < columns_.size(); ++c)
            explanation_.spread.col(static_cast<Eigen::Index>(c)) = columns_[c];
    }

  private:
    void add_regular(const Eigen::MatrixXd& covariance) {
        const auto size = static_cast<Eigen::Index>(parameters_.size());
        Eigen::VectorXd scale(size), shrunk(size);
        for (Eigen::Index k = 0; k < size; ++k) {
            const auto at = static_cast<std::size_t>(k);
            scale(k) = parameters_.scale(at);
            const double widest = (parameters_.high(at) - parameters_.low(at)) / std::sqrt(12.0);
            const double deviation = std::sqrt(std::max(0.0, covariance(k, k))) / std::abs(scale(k));
            shrunk(k) = deviation > widest ? widest / deviation : 1.0;
        }
        const Eigen::VectorXd by = shrunk.cwiseQuotient(scale.cwiseAbs());
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(by.asDiagonal() * covariance *
                                                                   by.asDiagonal());
        const double largest = parts.eigenvalues().cwiseAbs().maxCoeff();
        constexpr double nothing = 1e-12;
        for (Eigen::Index k = 0; k < size; ++k)
            if (const double variance = parts.eigenvalues()(k); variance > nothing * largest)
                add(scale.cwiseAbs().asDiagonal() * parts.eigenvectors().col(k) * std::sqrt(variance), false);
    }

    void add_inwards(std::size_t k) {
        constexpr double first = 0.01, growth = 1.6;  // of a scale
        const double inwards = parameters_.values[k] <= parameters_.low(k) ? 1.0 : -1.0;
        const double widest = parameters_.high(k) - parameters_.low(k);
        double reach = 0.0;
        for (double step = first; step < widest; step *= growth) {
            ScaledParameters beside = parameters_;
            beside.values[k] += inwards * step;
            if (!(loss_of(evidence_, beside.at(beside.values)) < least_loss_ + two_deviations)) break;
            reach = step;
        }
        if (reach == 0.0) return;
        Eigen::VectorXd column = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters_.size()));
        column(static_cast<Eigen::Index>(k)) = 0.5 * inwards * reach * std::abs(parameters_.scale(k));
        add(column, true);
    }

    void add(Eigen::VectorXd column, bool is_one_sided) {
        columns_.push_back(std::move(column));
        explanation_.is_one_sided.push_back(is_one_sided);
    }

    using ScaledParameters = gap::ScaledParameters;
    const gap::Evidence& evidence_;
    Explanation& explanation_;
    double least_loss_;
    ScaledParameters parameters_;
    std::vector<Eigen::VectorXd> columns_;
};

/// The best values and three draws; a draw that the recordings speak against by more than its distance and
/// two deviations is halved until they do not.
std::vector<gap::Hypothesis> draws_of(const gap::Evidence& evidence, const Explanation& explanation,
                                      double least_loss) {
    constexpr std::size_t count = 3;
    constexpr int most_halvings = 6;
    constexpr std::uint64_t seed = 1;
    std::vector<gap::Hypothesis> draws{explanation.hypothesis};
    if (explanation.spread.cols() == 0) return draws;
    NoiseStream noise(seed, "design/" + explanation.name);
    for (std::size_t draw = 0; draw < count; ++draw) {
        Eigen::VectorXd z(explanation.spread.cols());
        for (Eigen::Index k = 0; k < z.size(); ++k) z(k) = noise.normal();
        for (int halving = 0; halving < most_halvings; ++halving, z *= 0.5) {
            gap::Hypothesis hypothesis = moved(explanation, z);
            if (!(loss_of(evidence, hypothesis) < least_loss + 0.5 * z.squaredNorm() + two_deviations))
                continue;
            draws.push_back(std::move(hypothesis));
            break;
        }
    }
    return draws;
}

Explanation explained(const gap::Evidence& evidence, std::string name, const gap::Hypothesis& start) {
    gap::FitOptions options;
    options.with_covariance = true;
    const gap::Fit fitted =
        gap::fit(predict_all(evidence), evidence.windows(), gap::everything(evidence), start, options);
    Explanation explanation{std::move(name), fitted.hypothesis, {}, {}, {}};
    if (!fitted.hypothesis.empty())
        Spread(evidence, explanation, fitted.loss)
            .find(0.5 * (fitted.covariance + fitted.covariance.transpose()));
    explanation.draws = draws_of(evidence, explanation, fitted.loss);
    return explanation;
}

void add_separated(OpenQuestion& question, const std::string& name) {
    if (std::ranges::find(question.separates, name) == question.separates.end())
        question.separates.push_back(name);
}

/// What is to be compared with the diagnosis's own explanation.
struct Other {
    std::string name, against;
    gap::Hypothesis hypothesis;
    bool own_is_plainer = false, own_is_richer = false;
};

std::vector<Other> others_of(const gap::Diagnosis& diagnosis) {
    std::vector<Other> others;
    for (Exchange& exchange : exchanges(diagnosis)) {
        const plant::Effect& own = *diagnosis.hypothesis[exchange.place].effect;
        others.push_back({std::string(exchange.rival->name), diagnosis.effects[exchange.place].effect,
                          std::move(exchange.hypothesis), gap::is_limit_of(own, *exchange.rival),
                          gap::is_limit_of(*exchange.rival, own)});
    }
    if (const gap::Equation* equation = gap::proposed_equation(diagnosis)) {
        gap::Hypothesis with = equation->in_place_of_names ? gap::Hypothesis{} : diagnosis.hypothesis;
        with.push_back(equation->setting);
        others.push_back({"equation", diagnosis.effects.empty() ? "" : diagnosis.effects.front().effect,
                          std::move(with), true, false});
    }
    return others;
}

}  // namespace

gap::Hypothesis moved(const Explanation& explanation, const Eigen::VectorXd& z) {
    FIDSERVO_DEMAND(z.size() == explanation.spread.cols());
    Eigen::VectorXd steps = z;
    for (Eigen::Index k = 0; k < steps.size(); ++k)
        if (explanation.is_one_sided[static_cast<std::size_t>(k)]) steps(k) = std::abs(steps(k));
    const Eigen::VectorXd changes = explanation.spread * steps;
    gap::Hypothesis hypothesis = explanation.hypothesis;
    Eigen::Index at = 0;
    for (plant::EffectSetting& setting : hypothesis)
        for (std::size_t k = 0; k < setting.values.size(); ++k) {
            const plant::EffectParameter& parameter = setting.effect->parameters[k];
            setting.values[k] = std::clamp(setting.values[k] + changes(at++), parameter.low, parameter.high);
        }
    return hypothesis;
}

OpenQuestion open_question(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis) {
    OpenQuestion question;
    const std::vector<Other> others = others_of(diagnosis);
    const std::string own = diagnosis.effects.empty() ? "rig file" : diagnosis.effects.front().effect;
    question.explanations.resize(others.size() + 1);
    question.explanations.front() = {own, diagnosis.hypothesis, {}, {}, {diagnosis.hypothesis}};
    if (!others.empty())
        parallel_for(question.explanations.size(), [&](std::size_t k) {
            question.explanations[k] =
                k == 0 ? explained(evidence, own, diagnosis.hypothesis)
                       : explained(evidence, others[k - 1].name, others[k - 1].hypothesis);
        });
    for (std::size_t k = 0; k < others.size(); ++k) {
        if (!others[k].own_is_plainer) question.duels.push_back({0, k + 1});
        if (!others[k].own_is_richer) question.duels.push_back({k + 1, 0});
        if (!others[k].against.empty()) add_separated(question, others[k].against);
        add_separated(question, others[k].name);
    }
    if (diagnosis.unexplained && gap::proposed_equation(diagnosis) == nullptr)
        question.unknown = unknown_of(diagnosis);
    return question;
}

}  // namespace fidservo::design

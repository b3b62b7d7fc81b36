#include "gap/force_pairs.h"

#include "gap/balance_fit.h"
#include "gap/balanced_springs.h"
#include "gap/parallel.h"
#include "gap/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

constexpr double quarter_turn = 0.5 * std::numbers::pi;

/// An effect of one shape, of which only sizes are unknown; of a wave sine and cosine are.
struct Shape {
    const Candidate* candidate;
    std::vector<double> values;  ///< without the sizes
    std::vector<std::size_t> sizes;
    std::vector<plant::EffectSetting> units;  ///< what the columns are of
    Eigen::Index first = 0;                   ///< of its columns
    Eigen::Index columns() const { return static_cast<Eigen::Index>(units.size()); }
};

/// With some of its sizes, the others vanishing: least squares know no bounds.
Shape shape_of(const Candidate& candidate, const std::vector<double>& values,
               std::vector<std::size_t> sizes) {
    Shape shape{&candidate, values, std::move(sizes), {}};
    for (const std::size_t size : candidate.sizes)
        shape.values[size] = candidate.effect->parameters[size].vanishing;
    for (const std::size_t size : shape.sizes) {
        std::vector<double> unit = shape.values;
        unit[size] = values[size];
        shape.units.push_back({candidate.effect, std::move(unit)});
    }
    return shape;
}

Shape shape_of(const Candidate& candidate, double period_mm) {
    Shape shape{&candidate, candidate.shapes.front(), {candidate.wave->amplitude}, {}};
    shape.values[candidate.wave->period] = period_mm;
    for (const double phase_rad : {0.0, quarter_turn}) {
        std::vector<double> unit = shape.values;
        unit[candidate.wave->phase] = phase_rad;
        shape.units.push_back({candidate.effect, std::move(unit)});
    }
    return shape;
}

/// At shares of its typical sizes; nothing where a bound forbids that.
std::optional<plant::EffectSetting> pair_setting(const Shape& shape, const Eigen::VectorXd& shares) {
    const Candidate& candidate = *shape.candidate;
    plant::EffectSetting setting{candidate.effect, shape.values};
    if (candidate.wave) {
        setting.values[candidate.wave->amplitude] *= shares.norm();
        setting.values[candidate.wave->phase] = std::atan2(shares(1), shares(0));
    } else {
        for (std::size_t k = 0; k < shape.sizes.size(); ++k) {
            const std::size_t size = shape.sizes[k];
            const double none = setting.values[size];
            setting.values[size] =
                none + shares(static_cast<Eigen::Index>(k)) * (shape.units[k].values[size] - none);
        }
    }
    for (const std::size_t size : shape.sizes) {
        const plant::EffectParameter& parameter = candidate.effect->parameters[size];
        if (setting.values[size] < parameter.low || setting.values[size] > parameter.high) return {};
    }
    return setting;
}

/// Inner products of what shapes do to the balance, and of the excess, the last column.
class Products {
  public:
    Products(const Evidence& evidence, const ForceBalance& balance, const Hypothesis& base,
             std::span<Shape> shapes) {
        Eigen::Index width = 0;
        std::vector<const plant::EffectSetting*> units;
        for (Shape& shape : shapes) {
            shape.first = width;
            width += shape.columns();
            for (const plant::EffectSetting& unit : shape.units) units.push_back(&unit);
        }
        const Errors excess = balance.excess(base);
        const std::vector<double> weights = support_weights(evidence, balance.supports(), excess);
        Eigen::MatrixXd columns(static_cast<Eigen::Index>(weights.size()), width + 1);
        const auto fill = [&](Eigen::Index column, const auto& value_at) {
            for (std::size_t i = 0; i < weights.size(); ++i)
                columns(static_cast<Eigen::Index>(i), column) =
                    weights[i] * value_at(balance.supports()[i].slot);
        };
        fill(width, [&](std::size_t slot) { return -static_cast<double>(excess[slot]); });
        parallel_for(units.size(), [&](std::size_t unit) {
            Hypothesis whole = base;
            whole.push_back(*units[unit]);
            const Errors with = balance.excess(whole);
            fill(static_cast<Eigen::Index>(unit), [&](std::size_t slot) {
                return static_cast<double>(with[slot]) - static_cast<double>(excess[slot]);
            });
        });
        products_ = columns.transpose() * columns;
    }

    double of_excess() const { return products_(products_.rows() - 1, products_.rows() - 1); }

    struct Solution {
        Eigen::VectorXd shares;
        double left;  ///< of the squares
    };

    Solution solve(const Shape& one, const Shape& other) const {
        const Eigen::Index width = one.columns() + other.columns();
        std::vector<Eigen::Index> at;
        for (const Shape* shape : {&one, &other})
            for (Eigen::Index k = 0; k < shape->columns(); ++k) at.push_back(shape->first + k);
        const Eigen::MatrixXd normal = products_(at, at);
        const Eigen::VectorXd right = products_(at, products_.rows() - 1);
        const Eigen::LDLT<Eigen::MatrixXd> solver(normal + 1e-9 * normal.trace() *
                                                               Eigen::MatrixXd::Identity(width, width));
        Solution solution{solver.solve(right), 0.0};
        solution.left = of_excess() - solution.shares.dot(right);
        return solution;
    }

    /// Whether a shape does anything to the balance.
    bool shows(const Shape& shape) const {
        return products_.diagonal().segment(shape.first, shape.columns()).minCoeff() > 1e-6 * of_excess();
    }

  private:
    Eigen::MatrixXd products_;
};

std::vector<Shape> shapes_of_pairs(std::span<const Candidate* const> candidates,
                                   std::span<const PositionPeriod> periods) {
    std::vector<Shape> shapes;
    for (const Candidate* candidate : candidates)
        if (candidate->wave)
            for (const PositionPeriod& period : periods)
                shapes.push_back(shape_of(*candidate, period.period_mm));
        else
            for (const std::vector<double>& values : candidate->shapes) {
                shapes.push_back(shape_of(*candidate, values, candidate->sizes));
                if (candidate->sizes.size() > 1)
                    for (const std::size_t size : candidate->sizes)
                        shapes.push_back(shape_of(*candidate, values, {size}));
            }
    return shapes;
}

/// The pairs that balance best along their shapes, as they are there; their losses are the squares left.
std::vector<ForcePair> best_along_shapes(const Products& products, std::span<const Shape> shapes) {
    std::vector<ForcePair> pairs;
    for (const Shape& one : shapes)
        for (const Shape& other : shapes) {
            if (one.candidate >= other.candidate || one.candidate->class_name == other.candidate->class_name)
                continue;
            const Products::Solution solution = products.solve(one, other);
            const auto known = std::ranges::find_if(pairs, [&](const ForcePair& pair) {
                return pair.first == one.candidate && pair.second == other.candidate;
            });
            if (known != pairs.end() && known->loss <= solution.left) continue;
            const auto first = pair_setting(one, solution.shares.head(one.columns())),
                       second = pair_setting(other, solution.shares.tail(other.columns()));
            if (!first || !second) continue;
            ForcePair pair{.first = one.candidate,
                           .second = other.candidate,
                           .settings = {*first, *second},
                           .loss = solution.left};
            if (known != pairs.end())
                *known = std::move(pair);
            else
                pairs.push_back(std::move(pair));
        }
    std::ranges::sort(pairs, {}, &ForcePair::loss);
    return pairs;
}

void take(Fit fitted, ForcePair& pair) {
    pair.settings = std::move(fitted.hypothesis);
    pair.loss = fitted.loss;
}

/// In those parameters too that an effect may be without.
void refine(const BalanceFit& balanced, ForcePair& pair) {
    const ForcePair plain = pair;
    for (std::size_t place = 0; place < plain.settings.size(); ++place)
        for (plant::EffectSetting& form : richer_forms(plain.settings[place])) {
            Hypothesis start = plain.settings;
            start[place] = std::move(form);
            Fit refined = balanced.fit(start);
            if (refined.loss < pair.loss - least_gain) take(std::move(refined), pair);
        }
}

constexpr double most_left = 0.8;  ///< of a loss, where something takes away a good part of it

/// Says of a pair what each of the two does alone.
/// @param without  loss of the balance without either
void look_at_each(const BalanceFit& balanced, double without, ForcePair& pair) {
    std::array<Fit, 2> alone;
    for (const std::size_t place : {0, 1}) alone[place] = balanced.fit({pair.settings[place]});
    const Fit& better = *std::ranges::min_element(alone, {}, &Fit::loss);
    pair.needs_both = pair.loss < most_left * better.loss;
    if (better.loss < most_left * without) pair.lone = better.hypothesis.front();
}

bool is_same(const Errors& one, const Errors& other) {
    return std::ranges::equal(one, other, [](float left, float right) {
        return left == right || (std::isnan(left) && std::isnan(right));
    });
}

/// With all values of those parameters that the balance does not depend on.
std::vector<Hypothesis> with_unseen(const BalanceFit& balanced, const ForcePair& pair) {
    std::vector<Hypothesis> all{pair.settings};
    const Errors here = balanced.errors(pair.settings);
    for (const std::size_t place : {0, 1}) {
        const Candidate& candidate = place == 0 ? *pair.first : *pair.second;
        for (std::size_t k = 0; k < candidate.effect->parameters.size(); ++k) {
            std::vector<double> values{pair.settings[place].values[k]};
            for (const std::vector<double>& shape : candidate.shapes) {
                Hypothesis other = pair.settings;
                other[place].values[k] = shape[k];
                if (std::ranges::find(values, shape[k]) == values.end() &&
                    is_same(here, balanced.errors(other)))
                    values.push_back(shape[k]);
            }
            std::vector<Hypothesis> more;
            for (const Hypothesis& start : all)
                for (const double value : values) {
                    more.push_back(start);
                    more.back()[place].values[k] = value;
                }
            all = std::move(more);
        }
    }
    return all;
}

/// Whether a pair takes away as good as nothing, or leaves so much more than the best one that what the
/// balance does not see of it cannot matter.
bool is_hopeless(double loss, double best, double without) {
    return loss > most_left * without || loss > 2.0 * best + 4.0;
}

}  // namespace

std::vector<ForcePair> strongest_force_pairs(const Evidence& evidence, const Wanted& wanted,
                                             const Hypothesis& base,
                                             std::span<const Candidate* const> candidates,
                                             std::span<const PositionPeriod> periods) {
    constexpr std::size_t most_fitted = 8, most_pairs = 4;
    if (candidates.size() < 2) return {};
    const ForceBalance balance(evidence, wanted);
    if (balance.supports().empty()) return {};
    std::vector<Shape> shapes = shapes_of_pairs(candidates, periods);
    const std::vector<Window>& windows = evidence.windows();
    const Products products(evidence, balance, base, shapes);
    std::erase_if(shapes, [&](const Shape& shape) { return !products.shows(shape); });
    std::vector<ForcePair> pairs = best_along_shapes(products, shapes);
    const BalanceFit balanced(balance, windows, wanted, base);
    const auto keep_best = [&](std::size_t most) {
        std::ranges::sort(pairs, {}, &ForcePair::loss);
        if (pairs.size() > most) pairs.resize(most);
    };
    keep_best(most_fitted);
    parallel_for(pairs.size(), [&](std::size_t k) { take(balanced.fit(pairs[k].settings), pairs[k]); });
    keep_best(most_pairs);
    parallel_for(pairs.size(), [&](std::size_t k) { refine(balanced, pairs[k]); });
    keep_best(most_pairs);
    if (pairs.empty()) return pairs;
    const double best = pairs.front().loss, without = total_loss(windows, wanted, balanced.errors({}));
    std::erase_if(pairs, [&](const ForcePair& pair) { return is_hopeless(pair.loss, best, without); });
    parallel_for(pairs.size(), [&](std::size_t k) {
        look_at_each(balanced, without, pairs[k]);
        pairs[k].starts = with_unseen(balanced, pairs[k]);
    });
    return pairs;
}

}  // namespace fidservo::gap

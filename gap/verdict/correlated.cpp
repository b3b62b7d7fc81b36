// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/correlated.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include <fmt/format.h>

namespace fidservo::gap {
namespace {

struct Named {
    std::size_t effect;
    std::string_view effect_name, name;
};

std::vector<Named> parameters_of(const Hypothesis& hypothesis) {
    std::vector<Named> all;
    for (std::size_t k = 0; k < hypothesis.size(); ++k)
        for (const plant::EffectParameter& parameter : hypothesis[k].effect->parameters)
            all.push_back({k, hypothesis[k].effect->name, parameter.name});
    return all;
}

}  // namespace

std::vector<std::string> correlated_parameters(const Fit& fitted) {
    constexpr double strong = 0.95;
    struct Pair {
        double correlation;
        Named one, other;
    };
    const std::vector<Named> parameters = parameters_of(fitted.hypothesis);
    std::vector<Pair> pairs;
    for (Eigen::Index row = 0; row < fitted.covariance.rows(); ++row)
        for (Eigen::Index column = 0; column < row; ++column) {
            const Named &one = parameters[static_cast<std::size_t>(column)],
                        &other = parameters[static_cast<std::size_t>(row)];
            const double scale = std::sqrt(fitted.covariance(row, row) * fitted.covariance(column, column));
            const double correlation = scale > 0.0 ? fitted.covariance(row, column) / scale : 0.0;
            if (one.effect != other.effect && std::abs(correlation) >= strong)
                pairs.push_back({correlation, one, other});
        }
    std::ranges::stable_sort(pairs, std::greater{},
                             [](const Pair& pair) { return std::abs(pair.correlation); });
    std::vector<std::string> lines;
    lines.reserve(pairs.size());
    for (const Pair& pair : pairs)
        lines.push_back(
            fmt::format("{} {} and {} {} are known only together (correlation {:.3f}): more of the one is "
                        "made up for by {} of "
                        "the other",
                        pair.one.effect_name, pair.one.name, pair.other.effect_name, pair.other.name,
                        pair.correlation, pair.correlation > 0.0 ? "more" : "less"));
    return lines;
}

}  // namespace fidservo::gap

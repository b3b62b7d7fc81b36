// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/parameters.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {

std::vector<FittedParameter> parameters_of(const plant::EffectSetting& setting,
                                           const std::array<plant::EffectSetting, 2>& halves,
                                           const Eigen::MatrixXd& covariance, Eigen::Index first) {
    std::vector<FittedParameter> parameters;
    for (std::size_t k = 0; k < setting.values.size(); ++k) {
        const plant::EffectParameter& parameter = setting.effect->parameters[k];
        const Eigen::Index at = first + static_cast<Eigen::Index>(k);
        if (parameter.is_negligible(setting.values[k]) ||
            (parameter.is_choice() && !parameter.is_unusual(setting.values[k])))
            continue;
        const double apart = 0.5 * (halves[0].values[k] - halves[1].values[k]);
        parameters.push_back({std::string(parameter.name), std::string(parameter.unit), setting.values[k],
                              std::hypot(std::sqrt(std::max(0.0, covariance(at, at))), apart)});
    }
    return parameters;
}

}  // namespace fidservo::gap

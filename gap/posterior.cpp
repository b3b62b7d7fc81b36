#include "gap/posterior.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {

std::vector<double> probabilities(std::span<const double> losses) {
    std::vector<double> shares(losses.begin(), losses.end());
    if (shares.empty()) return shares;
    const double least = *std::ranges::min_element(shares);
    double sum = 0.0;
    for (double& share : shares) sum += share = std::exp(-values_per_window * (share - least));
    for (double& share : shares) share /= sum;
    return shares;
}

double trust_in(double floors_left) {
    constexpr double at_floor = 1.1;
    return 1.0 / (1.0 + 4.0 * std::log10(std::max(at_floor, floors_left) / at_floor));
}

double worth_of_names(double trust) {
    return 0.99 * std::pow(trust, 3);
}

}  // namespace fidservo::gap

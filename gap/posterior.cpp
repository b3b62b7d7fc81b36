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
    return std::pow(at_floor / std::max(at_floor, floors_left), 2);
}

}  // namespace fidservo::gap

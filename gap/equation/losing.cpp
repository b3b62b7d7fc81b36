// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/losing.h"

#include "gap/candidates/coupling.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

namespace fidservo::gap {

Wanted where_most_is_lost(const Evidence& evidence, Signal signal, std::span<const double> mean_squares,
                          double share, std::size_t least, std::size_t most) {
    std::vector<double> losses(evidence.recordings().size(), 0.0);
    for (std::size_t w = 0; w < mean_squares.size(); ++w)
        if (evidence.windows()[w].signal == signal && std::isfinite(mean_squares[w]))
            losses[evidence.windows()[w].run] += window_loss(mean_squares[w]);
    std::vector<std::size_t> order(losses.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t run) { return losses[run]; });
    const double enough = share * std::accumulate(losses.begin(), losses.end(), 0.0);
    std::vector<bool> is_taken(losses.size(), false);
    double taken = 0.0;
    for (std::size_t k = 0; k < std::min(most, order.size()) && (k < least || taken < enough); ++k) {
        is_taken[order[k]] = true;
        taken += losses[order[k]];
    }
    Wanted wanted = only_of(evidence.windows(), everything(evidence), only(signal));
    for (std::size_t w = 0; w < wanted.size(); ++w)
        if (!is_taken[evidence.windows()[w].run]) wanted[w] = 0;
    return wanted;
}

}  // namespace fidservo::gap

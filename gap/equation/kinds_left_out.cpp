// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/kinds_left_out.h"

#include "core/parallel.h"
#include "gap/candidates/coupling.h"
#include "gap/evidence/halves.h"
#include "gap/fit/incremental_prediction.h"
#include "gap/search/search.h"

#include <cmath>
#include <set>
#include <string>

namespace fidservo::gap {

std::vector<double> predicted_from_other_kinds(const Evidence& evidence, const CrossFit& cross) {
    const Hypothesis& start = cross.of_half[0];
    const Places last{start.size() - 1};
    const SignalFlags taught = taught_by(part_of(start, last)), reached = reached_by(part_of(start, last));
    std::set<std::string> found;
    for (const Window& window : evidence.windows())
        if (taught[index_of(window.signal)]) found.insert(evidence.recordings()[window.run].experiment);
    if (found.size() < 2) return {};
    const std::vector<std::string> kinds(found.begin(), found.end());
    const auto windows_of = [&](const std::string& kind, bool is_of_kind) {
        Wanted wanted = everything(evidence);
        for (std::size_t w = 0; w < wanted.size(); ++w)
            if ((evidence.recordings()[evidence.windows()[w].run].experiment == kind) != is_of_kind)
                wanted[w] = 0;
        return wanted;
    };
    std::vector<std::vector<double>> squares(kinds.size());
    parallel_for(kinds.size(), [&](std::size_t k) {
        const Wanted others =
            instructive(evidence.windows(), only_of(evidence.windows(), windows_of(kinds[k], false), taught),
                        cross.mean_squares, SearchOptions{}.windows);
        IncrementalPrediction whole(evidence, {}, others);
        const Predict predict = [&](const Hypothesis& part) { return whole(with_part(start, last, part)); };
        const Fit fitted = fit(predict, evidence.windows(), others, part_of(start, last));
        const Wanted own = only_of(evidence.windows(), windows_of(kinds[k], true), reached);
        squares[k] =
            mean_squares(evidence.windows(), evidence.errors(with_part(start, last, fitted.hypothesis), own));
    });
    std::vector<double> all = cross.mean_squares;
    for (std::size_t k = 0; k < kinds.size(); ++k)
        for (std::size_t w = 0; w < squares[k].size(); ++w)
            if (std::isfinite(squares[k][w]) && std::isfinite(all[w])) all[w] = squares[k][w];
    return all;
}

}  // namespace fidservo::gap

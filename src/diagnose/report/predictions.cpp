// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/predictions.h"

#include <cmath>
#include <limits>

namespace fidservo::diagnose {

Predictions predict(const gap::Evidence& evidence, const gap::Hypothesis& hypothesis) {
    const gap::Wanted wanted = gap::everything(evidence);
    Predictions predictions{evidence.errors({}, wanted), {}, false};
    if (!hypothesis.empty()) predictions.explained = evidence.errors(hypothesis, wanted);
    predictions.is_explained = !predictions.explained.empty();
    if (!predictions.is_explained) predictions.explained = predictions.nominal;
    return predictions;
}

std::vector<RunGaps> gaps_by_run(const gap::Evidence& evidence, const Predictions& predictions) {
    const std::size_t runs = evidence.recordings().size();
    using Sums = std::array<RootMeanSquare, gap::signal_count>;
    std::vector<Sums> before(runs), after(runs);
    for (const gap::Window& window : evidence.windows()) {
        before[window.run][gap::index_of(window.signal)].add(predictions.nominal, window);
        after[window.run][gap::index_of(window.signal)].add(predictions.explained, window);
    }
    std::vector<RunGaps> gaps(runs);
    for (std::size_t run = 0; run < runs; ++run)
        for (std::size_t s = 0; s < gap::signal_count; ++s)
            gaps[run][s] = {before[run][s].value(), after[run][s].value()};
    return gaps;
}

void RootMeanSquare::add(const gap::Errors& errors, const gap::Window& window) {
    for (std::size_t k = window.begin; k < window.end; ++k) {
        if (std::isnan(errors[k])) continue;
        sum_ += static_cast<double>(errors[k]) * static_cast<double>(errors[k]);
        ++count_;
    }
}

double RootMeanSquare::value() const {
    return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_))
                      : std::numeric_limits<double>::quiet_NaN();
}

const gap::Window* worst_window(const gap::Evidence& evidence, const gap::Errors& errors, std::size_t run,
                                gap::Signal signal) {
    const gap::Window* worst = nullptr;
    double largest = -1.0;
    for (const gap::Window& window : evidence.windows()) {
        if (window.run != run || window.signal != signal) continue;
        RootMeanSquare size;
        size.add(errors, window);
        if (!(size.value() > largest)) continue;
        largest = size.value();
        worst = &window;
    }
    return worst;
}

}  // namespace fidservo::diagnose

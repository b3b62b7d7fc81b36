// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/unpredictable.h"

#include "core/parallel.h"
#include "gap/evidence/halves.h"
#include "gap/evidence/windows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fidservo::gap {
namespace {

constexpr std::array offsets_count{0.0, -0.45, -0.25, -0.1, 0.1, 0.25, 0.45};

/// The largest mean square by which predictions differ from the first.
double spread_of(const Window& window, const std::array<Errors, offsets_count.size()>& errors) {
    double largest = 0.0;
    for (std::size_t k = 1; k < errors.size(); ++k) {
        double sum = 0.0, count = 0.0;
        for (std::size_t i = window.begin; i < window.end; ++i) {
            const double change = errors[k][i] - errors[0][i];
            if (std::isnan(change)) continue;
            sum += change * change;
            count += 1.0;
        }
        if (count > 0.0) largest = std::max(largest, sum / count);
    }
    return largest;
}

/// Whether tags are seen while a window of the encoder lasts.
bool are_at_once(const Window& encoder, const Window& tags) {
    return encoder.run == tags.run && seconds(std::abs(encoder.start_ns - tags.start_ns)) < window_s;
}

}  // namespace

std::vector<bool> unpredictable_windows(const Evidence& evidence, const CrossFit& fitted) {
    constexpr double least_spread = off_square, as_large = 4.0;
    const std::vector<Window>& windows = evidence.windows();
    const std::vector<std::uint8_t> half = halves(evidence);
    std::vector<bool> found(windows.size(), false);
    for (std::size_t side = 0; side < 2; ++side) {
        Wanted wanted = only_of(windows, everything(evidence), only(Signal::encoder));
        for (std::size_t w = 0; w < windows.size(); ++w)
            if (half[w] == side) wanted[w] = 0;
        std::array<Errors, offsets_count.size()> errors;
        parallel_for(errors.size(), [&](std::size_t k) {
            errors[k] = evidence.errors(fitted.of_half[side], wanted, offsets_count[k]);
        });
        if (std::ranges::any_of(errors, &Errors::empty)) continue;
        for (std::size_t w = 0; w < windows.size(); ++w) {
            const double square = fitted.mean_squares[w];
            if (wanted[w] == 0 || !(square > floor_square)) continue;
            const double by_start = spread_of(windows[w], errors);
            found[w] = by_start > least_spread && square < as_large * by_start;
        }
    }
    const std::vector<bool> of_encoder = found;
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (windows[w].signal == Signal::tag)
            for (std::size_t other = 0; other < windows.size() && !found[w]; ++other)
                found[w] = of_encoder[other] && are_at_once(windows[other], windows[w]);
    return found;
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "gap/evidence.h"

#include <cmath>
#include <optional>
#include <span>

namespace fidservo::testing {

/// R.m.s. over the values of a signal that count, of all recordings or one; NaN without any.
inline double rms(std::span<const gap::Window> windows, const gap::Errors& errors, gap::Signal signal,
                  std::optional<std::size_t> run = std::nullopt) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const gap::Window& window : windows) {
        if (window.signal != signal || (run && window.run != *run)) continue;
        for (std::size_t k = window.begin; k < window.end; ++k) {
            if (!std::isfinite(errors[k])) continue;
            sum += static_cast<double>(errors[k]) * static_cast<double>(errors[k]);
            ++count;
        }
    }
    return std::sqrt(sum / static_cast<double>(count));
}

inline double rms(const gap::Evidence& evidence, const gap::Errors& errors, gap::Signal signal,
                  std::optional<std::size_t> run = std::nullopt) {
    return rms(evidence.windows(), errors, signal, run);
}

}  // namespace fidservo::testing

// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/halves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace fidservo::gap {

namespace {

using RunOfSignal = std::pair<Signal, std::size_t>;

/// @param half_of  the half of a run; runs that are missing here are divided into stretches
std::vector<std::uint8_t> halves(const Evidence& evidence,
                                 const std::map<RunOfSignal, std::uint8_t>& half_of) {
    const std::vector<Window>& windows = evidence.windows();
    std::vector<std::uint8_t> half(windows.size());
    std::size_t in_run = 0;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const bool begins =
            w == 0 || windows[w].run != windows[w - 1].run || windows[w].signal != windows[w - 1].signal;
        in_run = begins ? 0 : in_run + 1;
        const auto of_run = half_of.find({windows[w].signal, windows[w].run});
        half[w] = of_run != half_of.end() ? of_run->second
                                          : static_cast<std::uint8_t>(in_run / windows_in_stretch % 2);
    }
    return half;
}

}  // namespace

std::vector<std::uint8_t> halves(const Evidence& evidence) {
    std::map<std::pair<Signal, std::string>, std::set<std::size_t>> runs_of;
    for (const Window& window : evidence.windows())
        runs_of[{window.signal, evidence.recordings()[window.run].experiment}].insert(window.run);
    std::map<RunOfSignal, std::uint8_t> half_of;
    for (const auto& [kind, runs] : runs_of) {
        if (runs.size() < 2) continue;
        std::uint8_t side = 0;
        for (const std::size_t run : runs) {
            half_of[{kind.first, run}] = side;
            side = 1 - side;
        }
    }
    return halves(evidence, half_of);
}

std::vector<std::uint8_t> halves_of_each_run(const Evidence& evidence) {
    return halves(evidence, std::map<RunOfSignal, std::uint8_t>{});
}

Wanted instructive(std::span<const Window> windows, const Wanted& eligible,
                   std::span<const double> mean_squares, std::size_t most) {
    Wanted chosen(windows.size(), 0);
    for (std::size_t signal = 0; signal < signal_count; ++signal) {
        std::vector<std::size_t> open;
        for (std::size_t w = 0; w < windows.size(); ++w)
            if (eligible[w] != 0 && windows[w].signal == static_cast<Signal>(signal) &&
                !std::isnan(mean_squares[w]))
                open.push_back(w);
        const auto choose_evenly = [&](std::size_t among, std::size_t number) {
            number = std::min(among, number);
            for (std::size_t k = 0; k < number; ++k) chosen[open[k * among / number]] = 1;
            std::erase_if(open, [&](std::size_t w) { return chosen[w] != 0; });
        };
        std::ranges::stable_sort(open, std::greater{}, [&](std::size_t w) { return mean_squares[w]; });
        choose_evenly(std::max(open.size() / 2, std::min(open.size(), most / 2)), most / 2);
        std::ranges::sort(open);
        choose_evenly(open.size(), most - most / 2);
    }
    return chosen;
}

}  // namespace fidservo::gap

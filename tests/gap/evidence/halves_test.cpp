// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/halves.h"

#include "tests/gap/simulated_campaign.h"

#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

TEST(InstructiveWindows, AreSomeOfLargeErrorAndAnEvenSpreadOfTheRest_OfEachSignal) {
    std::vector<Window> windows(60);
    std::vector<double> squares(60);
    Wanted eligible(60, 1);
    for (std::size_t w = 0; w < 60; ++w) {
        windows[w].signal = w < 40 ? Signal::encoder : Signal::hall;
        squares[w] = w == 7 || w == 31 || w == 44 ? 100.0 : 1.0;
    }
    eligible[5] = 0;
    squares[6] = std::numeric_limits<double>::quiet_NaN();
    const Wanted chosen = instructive(windows, eligible, squares, 8);
    EXPECT_EQ(std::accumulate(chosen.begin(), chosen.begin() + 40, 0), 8);
    EXPECT_EQ(std::accumulate(chosen.begin() + 40, chosen.end(), 0), 8);
    for (const std::size_t worst : {7, 44}) EXPECT_EQ(chosen[worst], 1);
    EXPECT_EQ(chosen[5], 0);
    EXPECT_EQ(chosen[6], 0);
    for (const std::size_t tenth : {10, 20, 30})
        EXPECT_GT(std::accumulate(chosen.begin() + static_cast<long>(tenth),
                                  chosen.begin() + static_cast<long>(tenth) + 10, 0),
                  0);
}

TEST(InstructiveWindows, FewerThanAskedFor_AreAllOfThem) {
    const std::vector<Window> windows(5);
    EXPECT_EQ(instructive(windows, Wanted(5, 1), std::vector(5, 1.0), 8), Wanted(5, 1));
}

/// Where one of two runs says nothing of a signal, stretches of the other one are fitted and judged.
TEST(Halves, OfASignalThatOneRunShows_AreItsStretches) {
    std::vector<Recording> recordings = testing::campaign({}, {"integrated"}).recordings();
    recordings.front().detections.clear();
    const Evidence evidence(reference_rig(), std::move(recordings));
    const std::vector<std::uint8_t> half = halves(evidence);
    std::map<Signal, std::set<std::uint8_t>> of_signal;
    for (std::size_t w = 0; w < half.size(); ++w) of_signal[evidence.windows()[w].signal].insert(half[w]);
    for (const Signal signal : {Signal::encoder, Signal::hall, Signal::tag})
        EXPECT_EQ(of_signal[signal].size(), 2U) << name_of(signal);
}

}  // namespace

}  // namespace fidservo

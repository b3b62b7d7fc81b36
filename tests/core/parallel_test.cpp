// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

TEST(ParallelFor, Nested_DoesEachOnce) {
    constexpr std::size_t outer = 7, inner = 11;
    std::vector<std::atomic<int>> done(outer * inner);
    parallel_for(outer,
                 [&](std::size_t i) { parallel_for(inner, [&](std::size_t k) { ++done[i * inner + k]; }); });
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
}

TEST(ParallelFor, Nothing_CallsNothing) {
    parallel_for(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, OneCore_WorksOnTheCallersThread) {
    use_cores(1);
    const std::thread::id caller = std::this_thread::get_id();
    parallel_for(20, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
    use_cores(std::max(1U, std::thread::hardware_concurrency()));
}

TEST(ParallelFor, Nested_WorksOnNoMoreThreadsThanThereAreCores) {
    std::atomic<int> working = 0, most = 0;
    parallel_for(8, [&](std::size_t) {
        parallel_for(4, [&](std::size_t) {
            const int now = ++working;
            int known = most;
            while (known < now && !most.compare_exchange_weak(known, now)) continue;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            --working;
        });
    });
    EXPECT_LE(most, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

TEST(ParallelFor, WorkThatFails_ThrowsOnceAllHaveEnded_AndGivesItsCoresBack) {
    std::atomic<int> done = 0;
    const auto fail_once = [&](std::size_t k) {
        ++done;
        if (k == 3) throw std::runtime_error("third");
    };
    for (int time = 0; time < 100; ++time) EXPECT_THROW(parallel_for(8, fail_once), std::runtime_error);
    EXPECT_EQ(done, 800);
    if (std::thread::hardware_concurrency() < 2) return;
    std::atomic<int> there = 0;
    parallel_for(2, [&](std::size_t) {
        ++there;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
        while (there < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        EXPECT_EQ(there, 2);
    });
}

}  // namespace
}  // namespace fidservo

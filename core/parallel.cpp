// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace fidservo {
namespace {

std::atomic<std::size_t> idle_cores = std::max(1U, std::thread::hardware_concurrency()) - 1;

/// @return how many idle cores it has taken, at most `wanted`
std::size_t take_cores(std::size_t wanted) {
    std::size_t idle = idle_cores, taken = 0;
    do taken = std::min(wanted, idle);
    while (!idle_cores.compare_exchange_weak(idle, idle - taken));
    return taken;
}

}  // namespace

void use_cores(std::size_t count) {
    idle_cores = std::max<std::size_t>(1, count) - 1;
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failed;
    std::mutex guard;
    const auto run = [&] {
        for (std::size_t k = next++; k < count; k = next++) {
            try {
                work(k);
            } catch (...) {
                const std::lock_guard lock(guard);
                if (!failed) failed = std::current_exception();
            }
        }
    };
    std::vector<std::jthread> others;
    for (std::size_t k = take_cores(count > 0 ? count - 1 : 0); k > 0; --k)
        others.emplace_back([&] {
            run();
            ++idle_cores;
        });
    run();
    others.clear();
    if (failed) std::rethrow_exception(failed);
}

}  // namespace fidservo

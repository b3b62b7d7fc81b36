// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Parallel work on all cores with results in order.
#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace fidservo {

/// Calls next() until it is empty, work(item) on the items in parallel, and take(result) on the results in
/// the order of the items. next() is never called twice at a time, and nobody but those who want the next
/// item waits for it; take() runs on the calling thread. At most four items a thread are under way, so memory
/// is bounded however long the run.
/// @param make_worker  called once in each thread; gives that thread's work(item)
/// The first exception of any of them, in the order of the items, is thrown here after all threads have
/// ended.
template <class Next, class MakeWorker, class Take>
void run_in_order(Next next, MakeWorker make_worker, Take take, unsigned threads) {
    using Item = typename decltype(next())::value_type;
    using Result = decltype(make_worker()(std::declval<Item>()));
    struct Slot {
        std::optional<Result> result;
        std::exception_ptr error;
        bool is_end = false;
    };
    const std::size_t window = 4 * std::max(1u, threads);
    std::vector<Slot> slots(window);
    std::mutex source;  // guards next() and the items' numbers; locked before `mutex`
    std::mutex mutex;   // guards everything below
    std::condition_variable slot_filled, slot_free;
    std::size_t started = 0, taken = 0;
    bool ended = false;

    const auto fill = [&](std::size_t index, Slot filled) {
        {
            const std::lock_guard lock(mutex);
            slots[index % window] = std::move(filled);
        }
        slot_filled.notify_one();
    };
    /// The number of the slot for the next item; empty after the end.
    const auto claim_slot = [&]() -> std::optional<std::size_t> {
        std::unique_lock lock(mutex);
        slot_free.wait(lock, [&] { return ended || started < taken + window; });
        if (ended) return std::nullopt;
        return started++;
    };
    const auto end = [&] {
        {
            const std::lock_guard lock(mutex);
            ended = true;
        }
        slot_free.notify_all();
    };

    const auto run_worker = [&] {
        auto work = make_worker();
        while (true) {
            Slot filled;
            std::unique_lock turn(source);
            const auto index = claim_slot();
            if (!index) return;
            try {
                auto item = next();
                filled.is_end = !item.has_value();
                if (filled.is_end) end();
                turn.unlock();
                if (item) filled.result.emplace(work(*std::move(item)));
            } catch (...) {
                filled.error = std::current_exception();
                if (turn.owns_lock()) end();
            }
            fill(*index, std::move(filled));
        }
    };

    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < std::max(1u, threads); ++i) workers.emplace_back(run_worker);
    std::exception_ptr error;
    while (!error) {
        std::unique_lock lock(mutex);
        Slot& slot = slots[taken % window];
        slot_filled.wait(lock, [&] { return slot.result || slot.error || slot.is_end; });
        if (slot.is_end) break;
        const Slot ready = std::exchange(slot, Slot{});
        ++taken;
        lock.unlock();
        slot_free.notify_one();
        error = ready.error;
        if (error) break;
        try {
            take(*ready.result);
        } catch (...) {
            error = std::current_exception();
        }
    }
    end();
    workers.clear();
    if (error) std::rethrow_exception(error);
}

}  // namespace fidservo

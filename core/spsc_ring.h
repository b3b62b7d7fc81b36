// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A ring between exactly one producing and one consuming thread. All memory is taken at construction; neither
// side ever waits for the other.
#include <atomic>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace fidservo {

template <class T>
class SpscRing {
  public:
    /// Room for at least `capacity` values.
    explicit SpscRing(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {}

    /// Producer: false if the ring is full; then the value is untouched.
    bool push(T&& value) {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (tail - head_.load(std::memory_order_acquire) == slots_.size()) return false;
        slots_[tail & mask_] = std::move(value);
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    /// Consumer: false if the ring is empty.
    bool pop(T& value) {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head == tail_.load(std::memory_order_acquire)) return false;
        value = std::move(slots_[head & mask_]);
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    std::size_t capacity() const { return slots_.size(); }

  private:
    std::vector<T> slots_;
    std::size_t mask_;
    alignas(64) std::atomic<std::size_t> head_ = 0;
    alignas(64) std::atomic<std::size_t> tail_ = 0;
};

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <memory>

namespace fidservo {

/// Passes the newest value from one thread to another. Neither side ever waits; a value that is not taken in
/// time is replaced by the next.
template <class T>
class Mailbox {
  public:
    Mailbox() = default;
    ~Mailbox() { delete slot_.load(std::memory_order_acquire); }
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

    void put(std::unique_ptr<T> value) { delete slot_.exchange(value.release(), std::memory_order_acq_rel); }
    /// Empty if nothing was put since the last call.
    std::unique_ptr<T> take() {
        return std::unique_ptr<T>(slot_.exchange(nullptr, std::memory_order_acq_rel));
    }
    bool is_empty() const { return slot_.load(std::memory_order_relaxed) == nullptr; }

  private:
    std::atomic<T*> slot_ = nullptr;
};

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The memory that the program and its guardian process share.
#include "control/stage.h"

#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>

namespace fidservo::control {

/// Why the outputs were set to zero before the run's end.
enum class Trip : std::uint32_t { none, stalled, board_refused, guardian_lost };

/// Both outputs in one 64-bit word, so that a reader never sees half a command.
inline std::uint64_t packed(const StageCommand& command) noexcept {
    const auto macro = std::bit_cast<std::uint32_t>(static_cast<float>(command.macro_V));
    const auto micro = std::bit_cast<std::uint32_t>(static_cast<float>(command.micro_V));
    return (static_cast<std::uint64_t>(macro) << 32) | micro;
}

inline StageCommand unpacked(std::uint64_t word) noexcept {
    return {std::bit_cast<float>(static_cast<std::uint32_t>(word >> 32)),
            std::bit_cast<float>(static_cast<std::uint32_t>(word))};
}

struct GuardianMemory {
    // Written by the program.
    alignas(64) std::atomic<std::uint64_t> command{packed({})};
    std::atomic<std::uint64_t> beats{0};
    std::atomic<bool> finish{false};
    // Written by the guardian.
    alignas(64) std::atomic<std::uint64_t> looks{0};
    std::atomic<Trip> trip{Trip::none};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<Trip>::is_always_lock_free);

/// Period at which the program and the guardian each check that the other is alive.
inline constexpr std::chrono::milliseconds look_period{4};

/// Detects that a counter has stopped. Besides the time, a number of checks must have passed: an observer
/// that was itself not scheduled for the time cannot say anything about the other.
class Standstill {
  public:
    explicit Standstill(std::chrono::nanoseconds timeout) : timeout_(timeout) {}

    /// Checks the counter once. True if it has not changed for the timeout.
    bool look(std::uint64_t count) noexcept {
        const auto now = std::chrono::steady_clock::now();
        if (count != count_) {
            count_ = count;
            since_ = now;
            looks_ = 0;
            return false;
        }
        return ++looks_ >= min_looks && now - since_ >= timeout_;
    }

  private:
    static constexpr int min_looks = 4;

    std::chrono::nanoseconds timeout_;
    std::uint64_t count_ = 0;
    std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
    int looks_ = 0;
};

}  // namespace fidservo::control

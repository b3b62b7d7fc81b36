// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The driver's 32-bit frame numbers as a 64-bit count, and the number of missing frames.
#include <cstdint>
#include <optional>

namespace fidservo::vision::v4l2 {

class SequenceCounter {
  public:
    /// Takes the number of the next frame. A number that is not ahead of the last one (by less than half the
    /// range) means that the driver has restarted its count; the 64-bit count then increases by one.
    /// @return frames that the driver numbered between the last and this one, and did not deliver
    std::uint64_t take(std::uint32_t number) {
        const std::uint32_t ahead = last_ ? number - *last_ : 1U;
        const bool goes_on = ahead >= 1 && ahead < (1U << 31U);
        last_ = number;
        const std::uint64_t step = goes_on ? ahead : 1U;
        count_ += step;
        return step - 1;
    }

    /// To be called when the driver restarts its count with the next frame.
    void restart() { last_.reset(); }

    /// The last frame's number in the 64-bit count; the first frame has 0.
    std::uint64_t sequence() const { return count_ - 1; }

  private:
    std::optional<std::uint32_t> last_;
    std::uint64_t count_ = 0;
};

}  // namespace fidservo::vision::v4l2

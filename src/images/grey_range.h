// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Determines which bits of a sequence's samples are used: cameras of 10, 12 and 14 bits are saved with 16.
#include "vision/images/image_file.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fidservo {

/// The grey levels seen in a sequence whose samples have more than 8 bits.
class GreyLevels {
  public:
    GreyLevels() : count_(std::size_t{1} << 16U) {}

    void add(const vision::StoredImage& image);
    void add(const GreyLevels& other);
    bool is_empty() const { return pixels_ == 0; }

    /// The number of bits, 8 to 16, with 2^bits - 1 as full scale: the largest that any file states or that
    /// any value needs.
    int bits() const;

    /// What was decided, in one line; and a hint where the central 99 % of the pixels are spread over fewer
    /// than 32 of the 256 grey levels that are left, since tags are found and measured worse then.
    std::string text() const;

  private:
    std::vector<std::uint64_t> count_;  ///< number of pixels for each value
    std::uint64_t pixels_ = 0;
    int stated_bits_ = 0;
    bool white_is_zero_ = false;
};

/// An image, or a page of a stack, whose samples may have more than 8 bits.
struct DeepImage {
    std::filesystem::path file;
    std::uint64_t page = 0;
};

/// Decodes all of them once, on all cores: the time is that of reading them, and the result is exact.
/// Unreadable images are ignored.
GreyLevels levels_of(std::span<const DeepImage> images);

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/grey_range.h"

#include "src/images/ordered_work.h"
#include "src/process/progress.h"

#include <algorithm>
#include <optional>
#include <thread>

#include <fmt/format.h>

namespace fidservo {

void GreyLevels::add(const vision::StoredImage& image) {
    if (image.grey.depth() != CV_16U) return;
    for (int row = 0; row < image.grey.rows; ++row) {
        const auto* samples = image.grey.ptr<std::uint16_t>(row);
        for (int column = 0; column < image.grey.cols; ++column) ++count_[samples[column]];
    }
    pixels_ += image.grey.total();
    stated_bits_ = std::max(stated_bits_, image.stated_bits);
    white_is_zero_ = white_is_zero_ || image.white_is_zero;
}

void GreyLevels::add(const GreyLevels& other) {
    for (std::size_t value = 0; value < count_.size(); ++value) count_[value] += other.count_[value];
    pixels_ += other.pixels_;
    stated_bits_ = std::max(stated_bits_, other.stated_bits_);
    white_is_zero_ = white_is_zero_ || other.white_is_zero_;
}

int GreyLevels::bits() const {
    if (is_empty()) return 16;
    const auto used = std::find_if(count_.rbegin(), count_.rend(), [](std::uint64_t n) { return n > 0; });
    return std::max(stated_bits_, vision::bits_for(static_cast<unsigned>(count_.rend() - used - 1)));
}

std::string GreyLevels::text() const {
    constexpr double central = 0.99;
    constexpr int few_levels = 32;
    const int full_scale = (1 << bits()) - 1;
    std::string line = fmt::format("{} of 16 bits are used: {} is {}", bits(), full_scale,
                                   white_is_zero_ ? "black" : "white");
    const double outside = (1.0 - central) / 2.0 * static_cast<double>(pixels_);
    const auto value_above = [&](double pixels) {
        double below = 0.0;
        std::size_t value = 0;
        for (; value + 1 < count_.size(); ++value)
            if ((below += static_cast<double>(count_[value])) > pixels) break;
        return static_cast<int>(value);
    };
    const int low = value_above(outside), high = value_above(static_cast<double>(pixels_) - outside - 1.0);
    const double levels = 255.0 * (high - low) / full_scale + 1.0;
    if (levels < few_levels)
        line += fmt::format(
            "; 99 % of the pixels lie from {} to {}, on {:.0f} of 256 grey levels: tags have little contrast",
            low, high, levels);
    return line;
}

GreyLevels levels_of(std::span<const DeepImage> images) {
    GreyLevels all;
    if (images.empty()) return all;
    Progress progress("images looked through for their range", images.size());
    std::size_t next = 0;
    const auto next_image = [&]() -> std::optional<DeepImage> {
        if (next == images.size()) return std::nullopt;
        return images[next++];
    };
    const auto make_worker = [] {
        return [](const DeepImage& image) {
            GreyLevels levels;
            if (const auto stored = vision::read_stored(image.file, image.page)) levels.add(*stored);
            return levels;
        };
    };
    run_in_order(
        next_image, make_worker,
        [&](const GreyLevels& levels) {
            all.add(levels);
            progress.advance();
        },
        std::max(1u, std::thread::hardware_concurrency()));
    progress.finish();
    return all;
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_tally.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

std::string first_names(std::span<const std::string> names) {
    constexpr std::size_t most = 5;
    std::vector<std::string> first;
    for (const std::string& name : names.first(std::min(most, names.size())))
        first.push_back(std::filesystem::path(name).filename().string());
    return fmt::format("{}{}", fmt::join(first, ", "), names.size() > most ? ", ..." : "");
}

void ImageTally::add(const ImageFrame& frame) {
    if (!frame.damage.empty()) {
        if (damaged_.empty()) first_damage_ = frame.damage;
        damaged_.push_back(frame.name);
        return;
    }
    ++read_;
    if (frame.orientation != 1) turned_.push_back(frame.name);
    if (frame.has_more_pictures) with_more_.push_back(frame.name);
}

std::string ImageTally::text() const {
    if (read_ == all()) return fmt::format("{} image{}", read_, read_ == 1 ? "" : "s");
    std::string text = fmt::format("{} of {} images", read_, all());
    if (!damaged_.empty()) text += fmt::format("; {} damaged: {}", damaged_.size(), first_names(damaged_));
    if (!missing_.empty())
        text += fmt::format("; {} listed and not there: {}", missing_.size(), first_names(missing_));
    return text;
}

std::string ImageTally::first_reason() const {
    if (!first_damage_.empty()) return first_damage_;
    return missing_.empty() ? "" : fmt::format("{}: there is no such file", missing_.front());
}

std::vector<std::string> ImageTally::notes() const {
    std::vector<std::string> notes;
    if (!turned_.empty())
        notes.push_back(
            fmt::format("{} of {} images have an orientation tag by which other programs turn them; "
                        "here pixels are where the file has them: {}",
                        turned_.size(), read_, first_names(turned_)));
    if (!with_more_.empty())
        notes.push_back(fmt::format("only the first picture is read of files that hold several: {}",
                                    first_names(with_more_)));
    return notes;
}

}  // namespace fidservo

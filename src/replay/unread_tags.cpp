// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/replay/unread_tags.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr std::size_t most_sampled = 4;

}  // namespace

void FrameSample::offer(const cv::Mat& grey, std::size_t tags, bool is_thorough) {
    if (offered_++ % every_ != 0) return;
    images_.push_back({grey, tags, is_thorough});
    if (images_.size() <= most_sampled) return;
    std::vector<Image> fewer;
    for (std::size_t k = 0; k < images_.size(); k += 2) fewer.push_back(images_[k]);
    images_ = std::move(fewer);
    every_ *= 2;
}

std::vector<cv::Mat> FrameSample::greys() const {
    std::vector<cv::Mat> greys;
    for (const Image& image : images_) greys.push_back(image.grey);
    return greys;
}

std::optional<std::size_t> FrameSample::tags_by_thorough_search() const {
    std::size_t tags = 0;
    for (const Image& image : images_) {
        if (!image.is_thorough) return std::nullopt;
        tags += image.tags;
    }
    return tags;
}

std::string options_for(const vision::TagReading& reading, const vision::TagReading& tried) {
    std::string options;
    const auto add = [&](const std::string& option) { options += (options.empty() ? "" : " ") + option; };
    const bool another = reading.print.family != tried.print.family;
    if (another) add(fmt::format("--family {}", reading.print.family->name));
    // Another family begins with a border of one cell.
    if (reading.print.border_cells != (another ? 1 : tried.print.border_cells))
        add(fmt::format("--border-cells {}", reading.print.border_cells));
    if (reading.print.inverted) add("--inverted");
    if (reading.mirrored) add("--mirrored");
    if (!reading.print.inverted && tried.print.inverted) add("without --inverted");
    if (!reading.mirrored && tried.mirrored) add("without --mirrored");
    return options;
}

std::string what_was_seen_text(const vision::OtherReadings& others, const vision::TagReading& tried) {
    return fmt::format(
        "seen: {}; tags of other families, with borders of one and two cells, inverted and "
        "mirrored ones were looked for too",
        vision::text_of(others.seen, tried));
}

std::string tags_text(const vision::TriedReading& found) {
    return fmt::format("{} {} of {}{}", found.tags, found.tags == 1 ? "tag" : "tags",
                       found.reading.mirrored ? "mirrored " : "", text_of(found.reading.print));
}

std::vector<std::string> unread_tags_text(const FrameSample& sample, std::size_t tags_in_all,
                                          const vision::TagReading& tried) {
    const bool looks_unread =
        tags_in_all == 0 || std::ranges::any_of(sample.images(), [](const FrameSample::Image& image) {
            return vision::looks_unread(image.grey, image.tags);
        });
    if (!looks_unread || sample.images().empty()) return {};
    const vision::OtherReadings others =
        vision::try_other_readings(sample.greys(), tried, sample.tags_by_thorough_search());
    std::vector<std::string> lines;
    for (const vision::TriedReading& better : others.better)
        lines.push_back(
            fmt::format("{} would be found{}: {}", tags_text(better),
                        others.images == 1 ? "" : fmt::format(" in a sample of {} images", others.images),
                        options_for(better.reading, tried)));
    if (lines.empty() && tags_in_all == 0) lines.push_back(what_was_seen_text(others, tried));
    return lines;
}

}  // namespace fidservo

#include "src/replay/unread_tags.h"

#include "vision/other_readings.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr std::size_t most_sampled = 4;

/// "a tag of tag16h5" or "36 tags of tag36h11 with a border of two cells".
std::string tags_text(const vision::TriedReading& found) {
    return fmt::format("{} {}{}", found.tags,
                       found.tags == 1 ? "tag of " : "tags of ",
                       (found.reading.mirrored ? "mirrored " : "") + text_of(found.reading.print));
}

}  // namespace

void FrameSample::offer(const cv::Mat& grey, std::size_t tags) {
    if (offered_++ % every_ != 0) return;
    images_.push_back({grey, tags});
    if (images_.size() <= most_sampled) return;
    std::vector<Image> fewer;
    for (std::size_t k = 0; k < images_.size(); k += 2) fewer.push_back(images_[k]);
    images_ = std::move(fewer);
    every_ *= 2;
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

std::vector<std::string> unread_tags_text(const FrameSample& sample, std::size_t tags_in_all,
                                          const vision::TagReading& tried) {
    const bool looks_unread =
        tags_in_all == 0 || std::ranges::any_of(sample.images(), [](const FrameSample::Image& image) {
            return vision::looks_unread(image.grey, image.tags);
        });
    if (!looks_unread || sample.images().empty()) return {};
    std::vector<cv::Mat> images;
    for (const FrameSample::Image& image : sample.images()) images.push_back(image.grey);
    const vision::OtherReadings others = vision::try_other_readings(images, tried);
    std::vector<std::string> lines;
    for (const vision::TriedReading& better : others.better)
        lines.push_back(fmt::format("{}{} would be found{}: {}", lines.empty() ? "" : "or ", tags_text(better),
                                    others.images == 1 ? "" : fmt::format(" in {} of the images", others.images),
                                    options_for(better.reading, tried)));
    if (lines.empty() && tags_in_all == 0) {
        lines.push_back("in the images: " + vision::text_of(others.seen, tried));
        lines.push_back(
            "not as tags of any other family either, nor with borders of one or two cells, inverted or mirrored");
    }
    return lines;
}

}  // namespace fidservo

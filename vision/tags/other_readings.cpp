// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/other_readings.h"

#include "core/detection.h"
#include "core/median.h"
#include "vision/tags/quad.h"
#include "vision/tags/readings_screen.h"
#include "vision/tags/square_outlines.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

/// Whether a family contains all codes of a smaller one: each of ArUco's dictionaries begins with the codes
/// of the smaller dictionaries with the same number of cells.
bool contains(const TagFamily& larger, const TagFamily& family) {
    return larger.layout == family.layout && larger.size() > family.size() &&
           std::ranges::equal(larger.codes.first(family.codes.size()), family.codes);
}

/// Everything that a tag can be read as, without books that others contain.
std::vector<TagReading> all_readings() {
    std::vector<TagReading> readings;
    for (const TagFamily& family : tag_families()) {
        const auto contains_it = [&](const TagFamily& other) { return contains(other, family); };
        if (std::ranges::any_of(tag_families(), contains_it)) continue;
        for (int border = 1; border <= (family.has_plain_border() ? 2 : 1); ++border)
            for (const bool inverted : {false, true})
                for (const bool mirrored : {false, true})
                    readings.push_back({{&family, border, inverted}, mirrored});
    }
    return readings;
}

std::vector<cv::Mat> of_bearable_size(std::span<const cv::Mat> images) {
    constexpr double most_px = 3e6;
    std::vector<cv::Mat> smaller;
    for (const cv::Mat& image : images) {
        const double scale = std::sqrt(most_px / std::max<double>(1.0, static_cast<double>(image.total())));
        smaller.push_back(image);
        if (scale < 1.0) cv::resize(image, smaller.back(), {}, scale, scale, cv::INTER_AREA);
    }
    return smaller;
}

/// How likely a random pattern is one of the book.
double chance_of(const TagFamily& family) {
    return family.size() / std::exp2(static_cast<double>(std::ranges::count(family.layout, 'd')));
}

/// By how much a tag's pattern is likelier than chance, as a logarithm: what the pattern leaves of the
/// variance of n cells, 1 - R^2, is of chance's with a probability that falls as its power (n - 4)/2, and 4 N
/// patterns of the family were tried (least_explained()).
double support_of(const cv::Mat& image, const TagDetection& tag) {
    constexpr double least_left = 1e-6;
    const TagPattern pattern = tag_pattern(tag.print, tag.tag_id);
    const double left = std::max(least_left, 1.0 - explained_contrast(image, tag.corners_px, pattern));
    const double cells = pattern.cells * pattern.cells;
    return -0.5 * (cells - 4.0) * std::log(left) - std::log(4.0 * tag.print.family->size());
}

struct Found {
    std::vector<std::vector<TagDetection>> of_image;
    std::size_t tags = 0;
    int last_id = 0;
    double support = 0.0;  ///< of all tags together
};

/// Whether each tag of one reading is one of the other's, too.
bool sees_the_same(const Found& found, const Found& other) {
    for (std::size_t k = 0; k < found.of_image.size(); ++k)
        for (const TagDetection& tag : found.of_image[k])
            if (std::ranges::none_of(other.of_image[k], [&](const TagDetection& of_other) {
                    return same_place(tag.corners_px, of_other.corners_px);
                }))
                return false;
    return true;
}

Found found_as(const std::vector<cv::Mat>& images, const TagReading& reading) {
    TagDetector detector(thorough_options(reading));
    Found found;
    for (const cv::Mat& image : images) {
        found.of_image.push_back(detector.detect(image, 0));
        found.tags += found.of_image.back().size();
        for (const TagDetection& tag : found.of_image.back()) {
            found.last_id = std::max(found.last_id, tag.tag_id);
            found.support += support_of(image, tag);
        }
    }
    return found;
}

/// The smallest book that has all ids up to one.
const TagFamily& smallest_with(const TagFamily& family, int last_id) {
    const TagFamily* smallest = &family;
    for (const TagFamily& other : tag_families())
        if (contains(family, other) && other.size() > last_id && other.size() < smallest->size())
            smallest = &other;
    return *smallest;
}

struct LikelyReading {
    TagReading reading;
    std::size_t tags;  ///< all of whose bits are right
};

/// Readings that see something in the images, the most first; of those that see as much, the one that could
/// least be chance.
std::vector<LikelyReading> likely_readings(const std::vector<cv::Mat>& images) {
    const std::vector<TagReading> readings = all_readings();
    std::vector<std::size_t> tags(readings.size(), 0);
    ReadingsScreen screen(readings);
    for (const cv::Mat& image : images)
        for (const std::size_t k : screen.seen_in(image)) ++tags[k];
    std::vector<std::size_t> order(readings.size());
    std::iota(order.begin(), order.end(), 0);
    std::erase_if(order, [&](std::size_t k) { return tags[k] == 0; });
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
        return std::pair(tags[b], chance_of(*readings[a].print.family)) <
               std::pair(tags[a], chance_of(*readings[b].print.family));
    });
    constexpr std::size_t most = 4;
    std::vector<LikelyReading> likely;
    for (std::size_t k = 0; k < std::min(most, order.size()); ++k)
        likely.push_back({readings[order[k]], tags[order[k]]});
    return likely;
}

ImagesSeen look_at(const std::vector<cv::Mat>& images) {
    ImagesSeen seen;
    std::array<double, 256> histogram{};
    double pixels = 0.0;
    std::vector<SquareOutline> outlines;
    for (const cv::Mat& image : images) {
        for (int row = 0; row < image.rows; ++row)
            for (int column = 0; column < image.cols; ++column)
                histogram[image.at<unsigned char>(row, column)] += 1.0;
        pixels += static_cast<double>(image.total());
        const auto found = square_outlines(image);
        outlines.insert(outlines.end(), found.begin(), found.end());
    }
    if (pixels == 0.0) return seen;
    const auto level_below_which = [&](double share) {
        double sum = 0.0;
        for (std::size_t level = 0; level < histogram.size(); ++level)
            if ((sum += histogram[level]) > share * pixels) return static_cast<double>(level);
        return 255.0;
    };
    seen.darkest_grey = level_below_which(0.01);
    seen.brightest_grey = level_below_which(0.99);
    seen.saturated_share = histogram[255] / pixels;
    seen.squares = outlines.size();
    seen.patterned =
        static_cast<std::size_t>(std::ranges::count(outlines, true, &SquareOutline::has_pattern));
    if (seen.patterned > 0)
        std::erase_if(outlines, [](const SquareOutline& outline) { return !outline.has_pattern; });
    if (outlines.empty()) return seen;
    const auto median_by = [&](auto value) {
        std::vector<double> values(outlines.size());
        std::ranges::transform(outlines, values.begin(), value);
        return median_of(std::move(values));
    };
    seen.side_px = median_by([](const SquareOutline& outline) { return outline.side_px; });
    seen.contrast_grey = median_by([](const SquareOutline& o) { return std::abs(o.contrast_grey); });
    seen.blur_px = median_by([](const SquareOutline& outline) { return outline.blur_px; });
    return seen;
}

}  // namespace

bool looks_unread(const cv::Mat& image, std::size_t tags_found) {
    const std::vector<SquareOutline> outlines = square_outlines(image);
    const auto patterned =
        static_cast<std::size_t>(std::ranges::count(outlines, true, &SquareOutline::has_pattern));
    return patterned > 0 && patterned >= 2 * tags_found;
}

OtherReadings try_other_readings(std::span<const cv::Mat> images, const TagReading& tried,
                                 std::optional<std::size_t> tags) {
    const std::vector<cv::Mat> bearable = of_bearable_size(images);
    const auto is_as_large = [](const cv::Mat& a, const cv::Mat& b) { return a.size() == b.size(); };
    if (!std::ranges::equal(images, bearable, is_as_large)) tags.reset();
    OtherReadings others{.images = images.size(),
                         .tags = tags ? *tags : found_as(bearable, tried).tags,
                         .better = {},
                         .seen = look_at(bearable)};
    std::vector<Found> found_better;  // as others.better
    for (const LikelyReading& likely : likely_readings(bearable)) {
        // Where most tags can be read at all, more than a few are without wrong bits.
        constexpr std::size_t most_for_one_without_errors = 8;
        const std::size_t to_beat = others.better.empty() ? others.tags + 1 : others.better.front().tags;
        TagReading reading = likely.reading;
        if (reading == tried || most_for_one_without_errors * likely.tags < to_beat) continue;
        Found found = found_as(bearable, reading);
        const TagFamily& smallest = smallest_with(*reading.print.family, found.last_id);
        if (&smallest != reading.print.family) {
            reading.print.family = &smallest;
            if (reading == tried) continue;
            found = found_as(bearable, reading);
        }
        if (found.tags < to_beat) continue;
        if (!others.better.empty() && found.tags > to_beat) {
            others.better.clear();
            found_better.clear();
        }
        // Of readings of the same squares one alone is right.
        const auto same = std::ranges::find_if(
            found_better, [&](const Found& other) { return sees_the_same(found, other); });
        if (same == found_better.end()) {
            others.better.push_back({reading, found.tags});
            found_better.push_back(std::move(found));
        } else if (found.support > same->support) {
            others.better[static_cast<std::size_t>(same - found_better.begin())] = {reading, found.tags};
            *same = std::move(found);
        }
    }
    return others;
}

std::string text_of(const ImagesSeen& seen, const TagReading& tried) {
    constexpr double uniform_grey = 10.0, dark_grey = 32.0, most_saturated = 0.5;
    constexpr double least_cell_px = 1.5, most_blur_cells = 0.5, faint_grey = 20.0;
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
    if (seen.brightest_grey - seen.darkest_grey < uniform_grey)
        add(fmt::format("the images are uniform, grey levels {:.0f} to {:.0f}", seen.darkest_grey,
                        seen.brightest_grey));
    else if (seen.brightest_grey < dark_grey)
        add(
            fmt::format("the images are dark, 99 % of the pixels at grey level {:.0f} of 255 or below: more "
                        "light, or a longer exposure",
                        seen.brightest_grey));
    if (seen.saturated_share > most_saturated)
        add(fmt::format("{:.0f} % of the pixels are saturated: a shorter exposure",
                        100.0 * seen.saturated_share));
    if (seen.squares == 0) {
        add("no square with four straight sides, 8 px long or more, is to be seen");
        return text;
    }
    add(
        fmt::format("{} square{} with four straight sides, {} of them with something inside; typically "
                    "{:.0f} px a side, contrast {:.0f} grey levels, edges blurred by {:.1f} px",
                    seen.squares, seen.squares == 1 ? "" : "s", seen.patterned, seen.side_px,
                    seen.contrast_grey, seen.blur_px));
    const double cell_px = seen.side_px / tried.print.outline_cells();
    if (cell_px < least_cell_px)
        add(fmt::format("a cell of {} would be {:.1f} px there, and {:.1f} are needed: come nearer",
                        tried.print.family->name, cell_px, least_cell_px));
    else if (seen.blur_px > most_blur_cells * cell_px)
        add(
            fmt::format("a cell of {} would be {:.1f} px there, no more than the blur: focus, or expose for "
                        "less long",
                        tried.print.family->name, cell_px));
    if (seen.contrast_grey < faint_grey) add("the contrast is faint: more light");
    return text;
}

}  // namespace fidservo::vision

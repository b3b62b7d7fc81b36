// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/contrast_regions.h"

#include "core/demand.h"

#include <algorithm>
#include <array>
#include <tuple>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

constexpr int tile_px = 4;
constexpr double quiet_zone_share = 0.2;  ///< room around a box, as a share of its longer side
constexpr int least_room_tiles = 2;

/// Lowest and highest grey level of every tile; pixels beyond the last whole tile belong to that one.
struct TileLevels {
    cv::Mat1b low, high;
};

TileLevels tile_levels(const cv::Mat& image) {
    const cv::Size tiles(std::max(1, image.cols / tile_px), std::max(1, image.rows / tile_px));
    TileLevels levels{cv::Mat1b(tiles, 255), cv::Mat1b(tiles, 0)};
    std::vector<unsigned char> low(image.cols), high(image.cols);
    for (int tile_row = 0; tile_row < tiles.height; ++tile_row) {
        const int first = tile_row * tile_px;
        const int end = tile_row + 1 == tiles.height ? image.rows : first + tile_px;
        std::copy_n(image.ptr<unsigned char>(first), image.cols, low.begin());
        high = low;
        for (int row = first + 1; row < end; ++row) {
            const auto* pixels = image.ptr<unsigned char>(row);
            for (int u = 0; u < image.cols; ++u) {
                low[u] = std::min(low[u], pixels[u]);
                high[u] = std::max(high[u], pixels[u]);
            }
        }
        for (int u = 0; u < image.cols; ++u) {
            const int tile = std::min(u / tile_px, tiles.width - 1);
            levels.low(tile_row, tile) = std::min(levels.low(tile_row, tile), low[u]);
            levels.high(tile_row, tile) = std::max(levels.high(tile_row, tile), high[u]);
        }
    }
    return levels;
}

/// The tiles whose neighbourhoods have the contrast.
cv::Mat busy_tiles(const cv::Mat& image, int min_contrast) {
    TileLevels levels = tile_levels(image);
    cv::erode(levels.low, levels.low, cv::Mat());
    cv::dilate(levels.high, levels.high, cv::Mat());
    return (levels.high - levels.low) >= min_contrast;
}

/// A box of tiles in pixels.
cv::Rect in_px(const cv::Rect& box, const cv::Size& tiles, const cv::Size& image) {
    const cv::Point end(box.br().x == tiles.width ? image.width : box.br().x * tile_px,
                        box.br().y == tiles.height ? image.height : box.br().y * tile_px);
    return {box.tl() * tile_px, end};
}

/// The box in tiles with room around it, within `all`.
cv::Rect with_room(const cv::Rect& box, const cv::Size& all) {
    const int room =
        std::max(least_room_tiles, static_cast<int>(quiet_zone_share * std::max(box.width, box.height)) + 1);
    return cv::Rect(box.x - room, box.y - room, box.width + 2 * room, box.height + 2 * room) &
           cv::Rect({0, 0}, all);
}

/// Joins boxes that overlap, until none do.
void make_disjoint(std::vector<cv::Rect>& boxes) {
    for (std::size_t i = 0; i < boxes.size();) {
        const auto other = std::find_if(boxes.begin() + i + 1, boxes.end(),
                                        [&](const cv::Rect& box) { return !(box & boxes[i]).empty(); });
        if (other == boxes.end()) {
            ++i;
            continue;
        }
        boxes[i] |= *other;
        boxes.erase(other);
        i = 0;
    }
}

}  // namespace

std::vector<cv::Rect> contrast_regions(const cv::Mat& image, int min_contrast) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    if (image.empty()) return {};
    const cv::Mat busy = busy_tiles(image, min_contrast);
    const cv::Size tiles = busy.size();
    cv::Mat1i labels, stats;
    cv::Mat1d centres;
    const int count = cv::connectedComponentsWithStats(busy, labels, stats, centres);
    std::vector<cv::Rect> boxes;
    for (int k = 1; k < count; ++k)
        boxes.push_back(with_room({stats(k, cv::CC_STAT_LEFT), stats(k, cv::CC_STAT_TOP),
                                   stats(k, cv::CC_STAT_WIDTH), stats(k, cv::CC_STAT_HEIGHT)},
                                  tiles));
    make_disjoint(boxes);
    std::sort(boxes.begin(), boxes.end(),
              [](const cv::Rect& a, const cv::Rect& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); });
    for (cv::Rect& box : boxes) box = in_px(box, tiles, image.size());
    return boxes;
}

cv::Rect contrast_box(const cv::Mat& image, int min_contrast) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    if (image.empty()) return {};
    const cv::Mat busy = busy_tiles(image, min_contrast);
    const cv::Rect box = cv::boundingRect(busy);
    return box.empty() ? cv::Rect() : in_px(with_room(box, busy.size()), busy.size(), image.size());
}

}  // namespace fidservo::vision

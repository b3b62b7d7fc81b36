// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/module/picture_samples.h"

#include "core/failure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

constexpr std::array luma_weights{0.299, 0.587, 0.114};  // of red, green and blue: ITU-R BT.601

bool is_coloured(const AVPixFmtDescriptor& kind) {
    return (kind.flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
}

/// Has it luma whose range is that of television?
bool is_limited(const AVFrame& frame, const AVPixFmtDescriptor& kind) {
    if (is_coloured(kind)) return false;
    if (frame.color_range != AVCOL_RANGE_UNSPECIFIED) return frame.color_range == AVCOL_RANGE_MPEG;
    const bool has_chroma = kind.nb_components >= 3;
    return has_chroma && !std::string_view(kind.name).starts_with("yuvj");
}

/// What a sample becomes, 0 to 1 times `white`.
std::vector<std::uint16_t> levels_of(int bits, bool limited, double white) {
    constexpr double black_of_255 = 16.0, white_of_255 = 235.0;
    const auto count = std::size_t{1} << bits;
    const double unit = static_cast<double>(count) / 256.0;  // a level of 8 bits
    const auto largest = static_cast<double>(count - 1);
    std::vector<std::uint16_t> levels(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto sample = static_cast<double>(k);
        const double share =
            limited ? (sample / unit - black_of_255) / (white_of_255 - black_of_255) : sample / largest;
        levels[k] = static_cast<std::uint16_t>(std::lround(white * std::clamp(share, 0.0, 1.0)));
    }
    return levels;
}

/// Pixels that are indices of colours, 0xAARRGGBB each.
cv::Mat grey_by_palette(const AVFrame& frame) {
    const auto* colours = reinterpret_cast<const std::uint32_t*>(frame.data[1]);
    std::array<unsigned char, 256> greys{};
    for (std::size_t k = 0; k < greys.size(); ++k) {
        double grey = 0.0;
        for (std::size_t c = 0; c < luma_weights.size(); ++c)
            grey += luma_weights[c] * (colours[k] >> (8 * (2 - c)) & 0xffU);
        greys[k] = cv::saturate_cast<unsigned char>(grey);
    }
    cv::Mat image(frame.height, frame.width, CV_8UC1);
    for (int row = 0; row < frame.height; ++row) {
        const std::uint8_t* indices = frame.data[0] + std::ptrdiff_t{row} * frame.linesize[0];
        for (int column = 0; column < frame.width; ++column)
            image.at<unsigned char>(row, column) = greys[indices[column]];
    }
    return image;
}

/// Samples of luma, or the luma of samples of red, green and blue, each scaled to `white`.
template <class Sample>
cv::Mat luma_of(const AVFrame& frame, const AVPixFmtDescriptor& kind, int type, double white) {
    const std::size_t components = is_coloured(kind) ? 3 : 1;
    std::array<std::vector<std::uint16_t>, 3> levels, rows;
    for (std::size_t k = 0; k < components; ++k) {
        levels[k] = levels_of(kind.comp[k].depth, is_limited(frame, kind), white);
        rows[k].resize(static_cast<std::size_t>(frame.width));
    }
    const auto level = [&](std::size_t k, int column) {
        return levels[k][rows[k][static_cast<std::size_t>(column)] & (levels[k].size() - 1)];
    };
    std::array<const std::uint8_t*, 4> planes{};
    std::copy_n(frame.data, planes.size(), planes.begin());
    cv::Mat image(frame.height, frame.width, type);
    for (int row = 0; row < frame.height; ++row) {
        for (std::size_t k = 0; k < components; ++k)
            av_read_image_line2(rows[k].data(), planes.data(), frame.linesize, &kind, 0, row,
                                static_cast<int>(k), frame.width, 0, sizeof(std::uint16_t));
        auto* to = image.ptr<Sample>(row);
        for (int column = 0; column < frame.width; ++column)
            to[column] = components == 1 ? static_cast<Sample>(level(0, column))
                                         : cv::saturate_cast<Sample>(luma_weights[0] * level(0, column) +
                                                                     luma_weights[1] * level(1, column) +
                                                                     luma_weights[2] * level(2, column));
    }
    return image;
}

}  // namespace

bool has_open_range_of(const AVPixFmtDescriptor& kind, int stated_bits) {
    const bool states_its_own = stated_bits > 8 && stated_bits < 16;
    const bool luma_beside_chroma = !is_coloured(kind) && kind.nb_components >= 3;
    return kind.comp[0].depth == 16 && !states_its_own && !luma_beside_chroma;
}

Result<StoredImage> grey_samples(const AVFrame& frame, int stated_bits) {
    const auto* kind = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
    if (kind == nullptr || frame.width <= 0 || frame.height <= 0)
        return failure(Reason::device, "its pixels are of no known kind");
    const int depth = kind->comp[0].depth;
    const bool is_known =
        (kind->flags & (AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT)) == 0 &&
        depth <= 16 && frame.format != AV_PIX_FMT_MONOWHITE;
    if (!is_known)
        return failure(Reason::device, std::string("pixels of the kind ") + kind->name + " are not read");
    StoredImage image;
    if ((kind->flags & AV_PIX_FMT_FLAG_PAL) != 0) {
        image.grey = grey_by_palette(frame);
    } else if (depth <= 8) {
        image.grey = luma_of<std::uint8_t>(frame, *kind, CV_8UC1, 255.0);
    } else {
        image.grey = luma_of<std::uint16_t>(frame, *kind, CV_16UC1, (1 << depth) - 1);
        const bool stated = stated_bits > 8 && stated_bits < depth;
        if (!has_open_range_of(*kind, stated_bits)) image.stated_bits = stated ? stated_bits : depth;
    }
    return image;
}

}  // namespace fidservo::vision

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/jpeg_decoder.h"

#include "core/demand.h"
#include "core/failure.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <turbojpeg.h>

namespace fidservo::vision {
namespace {

/// Ink is stored inverted: 255 is none. What the colours leave of the light, black takes its share of.
cv::Mat luma_of_print(const cv::Mat& inks) {
    constexpr double red = 0.299, green = 0.587, blue = 0.114, none = 255.0;
    cv::Mat grey(inks.size(), CV_8UC1);
    for (int row = 0; row < inks.rows; ++row)
        for (int column = 0; column < inks.cols; ++column) {
            const auto& ink = inks.at<cv::Vec4b>(row, column);
            const double colours = red * ink[0] + green * ink[1] + blue * ink[2];
            grey.at<unsigned char>(row, column) = cv::saturate_cast<unsigned char>(colours * ink[3] / none);
        }
    return grey;
}

}  // namespace

struct JpegDecoder::Impl {
    tjhandle turbo = tjInitDecompress();

    /// A new instance then: the old one would go on to complain about the frames after it.
    tl::unexpected<Failure> damaged() {
        const std::string why = tjGetErrorStr2(turbo);
        tjDestroy(turbo);
        turbo = tjInitDecompress();
        return failure(Reason::device, fmt::format("damaged JPEG: {}", why));
    }
};

bool is_jpeg(std::span<const std::byte> bytes) {
    constexpr std::byte signature[] = {std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}};
    return bytes.size() >= std::size(signature) &&
           std::equal(std::begin(signature), std::end(signature), bytes.begin());
}

JpegDecoder::JpegDecoder() : impl_(std::make_unique<Impl>()) {
    FIDSERVO_DEMAND(impl_->turbo != nullptr);
}

JpegDecoder::~JpegDecoder() {
    tjDestroy(impl_->turbo);
}

Result<cv::Mat> JpegDecoder::decode(std::span<const std::byte> jpeg) {
    const auto* data = reinterpret_cast<const unsigned char*>(jpeg.data());
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int colours = 0;
    if (tjDecompressHeader3(impl_->turbo, data, jpeg.size(), &width, &height, &subsampling, &colours) != 0)
        return impl_->damaged();
    if (const Status readable =
            demand_readable_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
        !readable)
        return tl::make_unexpected(readable.error());
    const bool for_print = colours == TJCS_CMYK || colours == TJCS_YCCK;
    cv::Mat pixels(height, width, for_print ? CV_8UC4 : CV_8UC1);
    // Not TJFLAG_STOPONWARNING: what is wrong at the end of the data is said as well without it.
    if (tjDecompress2(impl_->turbo, data, jpeg.size(), pixels.data, width, static_cast<int>(pixels.step[0]),
                      height, for_print ? TJPF_CMYK : TJPF_GRAY, TJFLAG_ACCURATEDCT) != 0)
        return impl_->damaged();
    return for_print ? luma_of_print(pixels) : pixels;
}

}  // namespace fidservo::vision

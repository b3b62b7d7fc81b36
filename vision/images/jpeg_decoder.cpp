#include "vision/images/jpeg_decoder.h"

#include "core/demand.h"
#include "core/failure.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <turbojpeg.h>

namespace fidservo::vision {

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

bool is_jpeg_of_luma(std::span<const std::byte> bytes) {
    constexpr std::byte signature[] = {std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}};
    if (bytes.size() < std::size(signature) ||
        !std::equal(std::begin(signature), std::end(signature), bytes.begin()))
        return false;
    const std::unique_ptr<void, int (*)(tjhandle)> turbo(tjInitDecompress(), &tjDestroy);
    FIDSERVO_DEMAND(turbo != nullptr);
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int colours = 0;
    const bool header = tjDecompressHeader3(turbo.get(), reinterpret_cast<const unsigned char*>(bytes.data()),
                                            bytes.size(), &width, &height, &subsampling, &colours) == 0;
    return !header || (colours != TJCS_CMYK && colours != TJCS_YCCK);
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
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > most_pixels)
        return failure(Reason::device, fmt::format("damaged JPEG: {} x {} px", width, height));
    cv::Mat grey(height, width, CV_8UC1);
    // Not TJFLAG_STOPONWARNING: what is wrong at the end of the data is said as well without it.
    if (tjDecompress2(impl_->turbo, data, jpeg.size(), grey.data, width, static_cast<int>(grey.step[0]),
                      height, TJPF_GRAY, TJFLAG_ACCURATEDCT) != 0)
        return impl_->damaged();
    return grey;
}

}  // namespace fidservo::vision

#include "vision/images/image_file.h"

#include "core/failure.h"
#include "vision/images/jpeg_decoder.h"
#include "vision/images/media.h"
#include "vision/images/png.h"

#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>

namespace fidservo::vision {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes;
    if (!in) return bytes;
    in.seekg(0, std::ios::end);
    if (const auto size = in.tellg(); size > 0) bytes.resize(static_cast<std::size_t>(size));
    in.seekg(0);
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

}  // namespace

Result<cv::Mat> read_grey(const std::filesystem::path& file) {
    const std::string content = bytes_of(file);
    const auto bytes = std::as_bytes(std::span(content));
    const bool png = is_png(bytes);
    if (!png && !is_jpeg_of_luma(bytes)) return read_grey_with_opencv(file);
    Result<cv::Mat> image = png ? decode_png(bytes) : JpegDecoder().decode(bytes);
    if (!image)
        return failure(Reason::device,
                       fmt::format("{}: cannot be read as an image: {}", file.string(), image.error().text));
    return image;
}

}  // namespace fidservo::vision

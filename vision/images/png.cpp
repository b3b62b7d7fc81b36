// SPDX-License-Identifier: GPL-3.0-or-later
// libpng ends on an error by a long jump to the last setjmp, over which no destructor runs: the functions
// with a setjmp here, and what they call, hold no object that has one.
#include "vision/images/png.h"

#include "core/demand.h"
#include "core/failure.h"
#include "vision/images/exif.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <png.h>

namespace fidservo::vision {
namespace {

constexpr std::size_t signature_bytes = 8;

void note_error(png_structp png, png_const_charp what) {
    auto& why = *static_cast<std::string*>(png_get_error_ptr(png));
    why = what;
    png_longjmp(png, 1);
}

void pass_over_warning(png_structp /*png*/, png_const_charp /*what*/) {}

struct Unread {
    std::span<const std::byte> bytes;
};

void take_bytes(png_structp png, png_bytep to, std::size_t count) {
    auto& unread = *static_cast<Unread*>(png_get_io_ptr(png));
    if (count > unread.bytes.size()) png_error(png, "cut short");
    std::memcpy(to, unread.bytes.data(), count);
    unread.bytes = unread.bytes.subspan(count);
}

void put_bytes(png_structp png, png_bytep from, std::size_t count) {
    auto& written = *static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
    written.insert(written.end(), from, from + count);
}

void flush_nothing(png_structp /*png*/) {}

class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes)
        : unread_{bytes},
          png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &why_, &note_error, &pass_over_warning)) {
        FIDSERVO_DEMAND(png_ != nullptr);
        info_ = png_create_info_struct(png_);
        FIDSERVO_DEMAND(info_ != nullptr);
        png_set_read_fn(png_, &unread_, &take_bytes);
    }
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    bool read_header() {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_read_info(png_, info_);
        return true;
    }

    /// Asks libpng for one sample of grey a pixel, whatever is stored: of 16 bits where these are stored,
    /// else of 8.
    bool ask_for_grey() {
        constexpr double red_weight = 0.299, green_weight = 0.587;
        constexpr int without_warning = 1;
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        if (is_deep() && std::endian::native == std::endian::little) png_set_swap(png_);
        png_set_strip_alpha(png_);
        const auto stored = png_get_color_type(png_, info_);
        if (stored == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
        if ((stored & PNG_COLOR_MASK_COLOR) == 0) png_set_expand_gray_1_2_4_to_8(png_);
        png_set_rgb_to_gray(png_, without_warning, red_weight, green_weight);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    bool read_rows(png_bytep* rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_read_image(png_, rows);
        png_read_end(png_, info_);
        return true;
    }

    bool is_deep() const { return png_get_bit_depth(png_, info_) == 16; }

    /// As the chunk sBIT states them: the most of any channel; 0 without the chunk.
    int stated_bits() const {
        png_color_8p significant = nullptr;
        if (png_get_sBIT(png_, info_, &significant) == 0) return 0;
        const bool colour = (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) != 0;
        return colour ? std::max({significant->red, significant->green, significant->blue})
                      : significant->gray;
    }

    int orientation() const {
        png_uint_32 count = 0;
        png_bytep exif = nullptr;
        if (png_get_eXIf_1(png_, info_, &count, &exif) == 0) return 1;
        return orientation_of_exif(std::as_bytes(std::span(exif, count)));
    }

    std::uint32_t width() const { return png_get_image_width(png_, info_); }
    std::uint32_t height() const { return png_get_image_height(png_, info_); }
    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    const std::string& why() const { return why_; }

  private:
    std::string why_;
    Unread unread_;
    png_structp png_;
    png_infop info_ = nullptr;
};

bool write_rows(png_structp png, png_infop info, const cv::Mat& grey, png_bytep* rows, int compression) {
    constexpr int bits = 8;
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_compression_level(png, compression);
    png_set_IHDR(png, info, static_cast<png_uint_32>(grey.cols), static_cast<png_uint_32>(grey.rows), bits,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    return true;
}

std::vector<png_bytep> rows_of(const cv::Mat& grey) {
    std::vector<png_bytep> rows;
    rows.reserve(static_cast<std::size_t>(grey.rows));
    for (int row = 0; row < grey.rows; ++row)
        rows.push_back(const_cast<png_bytep>(grey.ptr<unsigned char>(row)));
    return rows;
}

/// Has it a chunk acTL? That stands before the pixels.
bool is_animated(std::span<const std::byte> png) {
    constexpr std::size_t length_bytes = 4, name_bytes = 4, sum_bytes = 4;
    const std::string_view text(reinterpret_cast<const char*>(png.data()), png.size());
    for (std::size_t at = signature_bytes; at + length_bytes + name_bytes <= text.size();) {
        const std::string_view name = text.substr(at + length_bytes, name_bytes);
        if (name == "acTL" || name == "IDAT") return name == "acTL";
        std::size_t length = 0;
        for (const char byte : text.substr(at, length_bytes))
            length = length << 8U | static_cast<unsigned char>(byte);
        at += length_bytes + name_bytes + length + sum_bytes;
    }
    return false;
}

tl::unexpected<Failure> damaged(const std::string& why) {
    return failure(Reason::device, fmt::format("damaged PNG: {}", why));
}

}  // namespace

bool is_png(std::span<const std::byte> bytes) {
    return bytes.size() >= signature_bytes &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, signature_bytes) == 0;
}

bool is_deep_png(std::span<const std::byte> beginning) {
    constexpr std::size_t depth_at = 24;
    return beginning.size() > depth_at && beginning[depth_at] == std::byte{16};
}

Result<StoredImage> decode_png(std::span<const std::byte> png) {
    constexpr std::size_t most_out_of_a_byte = 1032;  // of zlib's compression: 258 bytes out of two bits
    Reader reader(png);
    if (!reader.read_header()) return damaged(reader.why());
    const std::string size = fmt::format("{} x {} px", reader.width(), reader.height());
    if (const Status readable = demand_readable_size(reader.width(), reader.height()); !readable)
        return tl::make_unexpected(readable.error());
    if (std::size_t{reader.height()} * reader.row_bytes() / most_out_of_a_byte > png.size())
        return damaged(fmt::format("{} are not in {} bytes", size, png.size()));
    if (!reader.ask_for_grey()) return damaged(reader.why());
    const bool deep = reader.is_deep();
    FIDSERVO_DEMAND(reader.row_bytes() == std::size_t{reader.width()} * (deep ? 2 : 1));
    StoredImage image;
    image.grey.create(static_cast<int>(reader.height()), static_cast<int>(reader.width()),
                      deep ? CV_16UC1 : CV_8UC1);
    std::vector<png_bytep> rows = rows_of(image.grey);
    if (!reader.read_rows(rows.data())) return damaged(reader.why());
    image.stated_bits = deep ? reader.stated_bits() : 0;
    image.orientation = reader.orientation();
    image.has_more_pictures = is_animated(png);
    return image;
}

std::vector<unsigned char> encode_png(const cv::Mat& grey, int compression) {
    FIDSERVO_DEMAND(grey.type() == CV_8UC1 && !grey.empty());
    std::vector<unsigned char> written;
    std::string why;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &why, &note_error, &pass_over_warning);
    FIDSERVO_DEMAND(png != nullptr);
    png_infop info = png_create_info_struct(png);
    FIDSERVO_DEMAND(info != nullptr);
    png_set_write_fn(png, &written, &put_bytes, &flush_nothing);
    std::vector<png_bytep> rows = rows_of(grey);
    const bool whole = write_rows(png, info, grey, rows.data(), compression);
    png_destroy_write_struct(&png, &info);
    FIDSERVO_DEMAND(whole);
    return written;
}

}  // namespace fidservo::vision

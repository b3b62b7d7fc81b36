// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/failure.h"
#include "vision/images/module/parts.h"
#include "vision/images/module/tiff_deflate.h"
#include "vision/images/module/tiff_file.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

tl::unexpected<Failure> damaged(const Tiff& tiff) {
    return failure(Reason::device, "damaged TIFF: " + tiff.why());
}

struct Layout {
    std::uint32_t width = 0, height = 0;
    int bits = 1, samples = 1;
    std::uint16_t photometric = 0, format = 0, compression = 0;
    bool is_planar = false, is_tiled = false;

    bool is_colour() const { return photometric == PHOTOMETRIC_RGB; }
    bool is_palette() const { return photometric == PHOTOMETRIC_PALETTE; }
    int wanted_samples() const { return is_colour() ? 3 : 1; }

    /// What is unpacked here; anything else that is known is left to libtiff's colours.
    bool is_plain() const {
        const bool whole_numbers =
            format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID || format == SAMPLEFORMAT_INT;
        const bool known_bits = bits == 1 || bits == 2 || bits == 4 || (bits >= 8 && bits <= 16);
        const bool grey = photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
        return whole_numbers && known_bits && samples >= wanted_samples() &&
               (grey || is_colour() || (is_palette() && bits <= 8));
    }
};

Layout layout_of(const Tiff& tiff) {
    Layout layout;
    layout.width = tiff.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    layout.height = tiff.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    layout.bits = tiff.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    layout.samples = tiff.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    layout.photometric = tiff.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    layout.format = tiff.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    layout.compression = tiff.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    layout.is_planar =
        tiff.field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE &&
        layout.samples > 1;
    layout.is_tiled = TIFFIsTiled(tiff.get()) != 0;
    if (layout.photometric == PHOTOMETRIC_YCBCR && layout.compression == COMPRESSION_JPEG) {
        TIFFSetField(tiff.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        layout.photometric = PHOTOMETRIC_RGB;
    }
    return layout;
}

/// How many bytes a compression makes of one at most; 0: no such limit is known.
std::uint64_t most_out_of_a_byte(std::uint16_t compression) {
    switch (compression) {
        case COMPRESSION_NONE:
            return 1;
        case COMPRESSION_PACKBITS:
            return 64;
        case COMPRESSION_DEFLATE:
        case COMPRESSION_ADOBE_DEFLATE:
            return 1032;
        case COMPRESSION_LZW:
            return 4096;  // the longest string of its table, out of a code of nine bits or more
        default:
            return 0;
    }
}

Status demand_reasonable(const Tiff& tiff, const Layout& layout) {
    const std::uint64_t pixels = std::uint64_t{layout.width} * layout.height;
    const std::string size = fmt::format("{} x {} px", layout.width, layout.height);
    if (pixels == 0) return failure(Reason::device, "damaged TIFF: it has no pixels");
    if (const Status readable = demand_readable_size(layout.width, layout.height); !readable) return readable;
    if (layout.format == SAMPLEFORMAT_IEEEFP || layout.bits > 16)
        return failure(
            Reason::device,
            fmt::format("samples of {} bits{} have no white that is known: save it with 8 or 16 bits",
                        layout.bits, layout.format == SAMPLEFORMAT_IEEEFP ? ", floating-point," : ""));
    const std::uint64_t most = most_out_of_a_byte(layout.compression);
    const auto bits = static_cast<std::uint64_t>(layout.bits) * static_cast<std::uint64_t>(layout.samples);
    if (most > 0 && pixels / 8 * bits / most > tiff.file_bytes())
        return failure(Reason::device,
                       fmt::format("damaged TIFF: {} are not in {} bytes", size, tiff.file_bytes()));
    return {};
}

/// Samples of a row, packed without gaps, the first in the highest bits; of 8 and 16 bits as memory has them.
void unpack(const unsigned char* row, std::size_t count, int bits, std::uint16_t* samples) {
    if (bits == 8) {
        std::copy_n(row, count, samples);
    } else if (bits == 16) {
        std::memcpy(samples, row, 2 * count);
    } else {
        std::uint32_t held = 0;
        int held_bits = 0;
        for (std::size_t k = 0; k < count; ++k) {
            for (; held_bits < bits; held_bits += 8) held = held << 8U | *row++;
            held_bits -= bits;
            samples[k] = static_cast<std::uint16_t>(held >> held_bits & ((1U << bits) - 1));
        }
    }
}

/// A page's samples, from its strips or its tiles: of each pixel those that are wanted, CV_16UC1 or CV_16UC3.
class PageSamples {
  public:
    PageSamples(const Tiff& tiff, const Layout& layout)
        : tiff_(tiff),
          layout_(layout),
          samples_(static_cast<int>(layout.height), static_cast<int>(layout.width),
                   CV_16UC(layout.wanted_samples())) {}

    bool read() {
        const int planes = layout_.is_planar ? layout_.wanted_samples() : 1;
        for (int plane = 0; plane < planes; ++plane)
            if (!(layout_.is_tiled ? read_tiles(plane) : read_rows(plane))) return false;
        return !tiff_.has_failed();
    }

    const cv::Mat& samples() const { return samples_; }

  private:
    int samples_in_a_plane() const { return layout_.is_planar ? 1 : layout_.samples; }

    /// Of the pixels from `column` on.
    void put_row(const unsigned char* row, std::uint32_t line, std::uint32_t column, std::uint32_t count,
                 int plane) {
        const auto held = static_cast<std::size_t>(samples_in_a_plane());
        unpacked_.resize(count * held);
        unpack(row, unpacked_.size(), layout_.bits, unpacked_.data());
        const auto wanted = static_cast<std::size_t>(layout_.wanted_samples());
        std::uint16_t* to = samples_.ptr<std::uint16_t>(static_cast<int>(line)) + column * wanted;
        for (std::size_t k = 0; k < count; ++k) {
            if (layout_.is_planar)
                to[k * wanted + static_cast<std::size_t>(plane)] = unpacked_[k];
            else
                std::copy_n(unpacked_.data() + k * held, wanted, to + k * wanted);
        }
    }

    /// Whether rows of so many pixels are in so many bytes, as they would be if no tag contradicts another.
    bool holds(tmsize_t bytes, std::uint64_t pixels) const {
        const auto bits =
            static_cast<std::uint64_t>(layout_.bits) * static_cast<std::uint64_t>(samples_in_a_plane());
        return bytes > 0 && static_cast<std::uint64_t>(bytes) >= (pixels * bits + 7) / 8;
    }

    bool read_rows(int plane) {
        const tmsize_t bytes = TIFFScanlineSize(tiff_.get());
        if (!holds(bytes, layout_.width)) return false;
        std::vector<unsigned char> row(static_cast<std::size_t>(bytes));
        for (std::uint32_t line = 0; line < layout_.height; ++line) {
            if (TIFFReadScanline(tiff_.get(), row.data(), line, static_cast<std::uint16_t>(plane)) != 1)
                return false;
            put_row(row.data(), line, 0, layout_.width, plane);
        }
        return true;
    }

    bool read_tiles(int plane) {
        const auto width = tiff_.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
        const auto height = tiff_.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
        const tmsize_t bytes = TIFFTileSize(tiff_.get()), row_bytes = TIFFTileRowSize(tiff_.get());
        if (width == 0 || height == 0 || !holds(row_bytes, width)) return false;
        if (bytes / row_bytes < height || static_cast<std::size_t>(bytes) > most_file_bytes) return false;
        std::vector<unsigned char> tile(static_cast<std::size_t>(bytes));
        for (std::uint32_t top = 0; top < layout_.height; top += height)
            for (std::uint32_t left = 0; left < layout_.width; left += width) {
                if (TIFFReadTile(tiff_.get(), tile.data(), left, top, 0, static_cast<std::uint16_t>(plane)) <
                    0)
                    return false;
                const std::uint32_t lines = std::min(height, layout_.height - top);
                for (std::uint32_t line = 0; line < lines; ++line)
                    put_row(tile.data() + line * row_bytes, top + line, left,
                            std::min(width, layout_.width - left), plane);
            }
        return true;
    }

    const Tiff& tiff_;
    const Layout& layout_;
    cv::Mat samples_;
    std::vector<std::uint16_t> unpacked_;
};

/// The grey of each index of a palette, 0 to 255. Some programs write its colours with 8 bits.
std::vector<unsigned char> palette_of(const Tiff& tiff, int bits) {
    std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
    if (TIFFGetField(tiff.get(), TIFFTAG_COLORMAP, &red, &green, &blue) != 1) return {};
    const auto count = std::size_t{1} << bits;
    std::uint16_t largest = 0;
    for (std::size_t k = 0; k < count; ++k) largest = std::max({largest, red[k], green[k], blue[k]});
    const double scale = largest < 256 ? 1.0 : 1.0 / 257.0;
    std::vector<unsigned char> greys(count);
    for (std::size_t k = 0; k < count; ++k)
        greys[k] =
            cv::saturate_cast<unsigned char>(scale * (0.299 * red[k] + 0.587 * green[k] + 0.114 * blue[k]));
    return greys;
}

/// Samples of at most 8 bits, as CV_8UC1 of which 255 is white.
cv::Mat as_8_bits(const cv::Mat& grey, const Layout& layout, std::span<const unsigned char> palette) {
    const double scale = 255.0 / ((1 << layout.bits) - 1);
    cv::Mat result;
    if (!layout.is_palette()) {
        const bool inverted = layout.photometric == PHOTOMETRIC_MINISWHITE;
        grey.convertTo(result, CV_8U, inverted ? -scale : scale, inverted ? 255.0 : 0.0);
        return result;
    }
    result.create(grey.size(), CV_8UC1);
    for (int row = 0; row < grey.rows; ++row)
        for (int column = 0; column < grey.cols; ++column)
            result.at<unsigned char>(row, column) = palette[grey.at<std::uint16_t>(row, column)];
    return result;
}

/// Of red, green and blue: CV_16UC1 of samples of more than 8 bits; else CV_8UC1 of which 255 is white.
cv::Mat luma_of(const cv::Mat& samples, int bits) {
    cv::Mat grey, colours = samples;
    if (bits <= 8) samples.convertTo(colours, CV_8U, 255.0 / ((1 << bits) - 1));
    cv::cvtColor(colours, grey, cv::COLOR_RGB2GRAY);
    return grey;
}

bool has_negative(const cv::Mat& samples, int bits) {
    double largest = 0.0;
    cv::minMaxLoc(samples.reshape(1), nullptr, &largest);
    return largest >= 1 << (bits - 1);
}

int stated_bits_of(const Tiff& tiff, int bits) {
    if (bits < 16) return bits;
    std::uint16_t largest = 0;
    if (TIFFGetField(tiff.get(), TIFFTAG_MAXSAMPLEVALUE, &largest) != 1) return 0;
    constexpr std::uint16_t of_16_bits = 65535;  // which libtiff answers where the file says nothing
    return largest == of_16_bits ? 0 : bits_for(largest);
}

Result<StoredImage> read_plain(const Tiff& tiff, const Layout& layout) {
    const std::vector<unsigned char> palette =
        layout.is_palette() ? palette_of(tiff, layout.bits) : std::vector<unsigned char>();
    if (layout.is_palette() && palette.empty())
        return failure(Reason::device, "damaged TIFF: it has no colour map");
    PageSamples page(tiff, layout);
    if (!page.read()) return damaged(tiff);
    if (layout.format == SAMPLEFORMAT_INT && has_negative(page.samples(), layout.bits))
        return failure(Reason::device, "it has negative samples: what is black is not known");
    StoredImage image;
    const cv::Mat grey = layout.is_colour() ? luma_of(page.samples(), layout.bits) : page.samples();
    image.grey = grey;
    if (layout.bits <= 8) {
        if (!layout.is_colour()) image.grey = as_8_bits(grey, layout, palette);
        return image;
    }
    image.stated_bits = stated_bits_of(tiff, layout.bits);
    image.white_is_zero = layout.photometric == PHOTOMETRIC_MINISWHITE;
    return image;
}

/// Any other colours, as libtiff turns them into red, green and blue of 8 bits.
Result<StoredImage> read_colours(const Tiff& tiff, const Layout& layout) {
    char why[1024] = "";
    if (TIFFRGBAImageOK(tiff.get(), why) == 0)
        return failure(Reason::device, fmt::format("a TIFF of a kind that is not read: {}", why));
    cv::Mat raster(static_cast<int>(layout.height), static_cast<int>(layout.width), CV_8UC4);
    const int as_stored = tiff.field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    constexpr int stop_on_error = 1;
    if (TIFFReadRGBAImageOriented(tiff.get(), layout.width, layout.height, raster.ptr<std::uint32_t>(),
                                  as_stored, stop_on_error) == 0 ||
        tiff.has_failed())
        return damaged(tiff);
    StoredImage image;
    cv::cvtColor(raster, image.grey, cv::COLOR_RGBA2GRAY);
    return image;
}

}  // namespace

Result<StoredImage> tiff_page(const char* file, std::uint64_t page) {
    const Tiff tiff(file, page);
    if (!tiff.is_open()) return damaged(tiff);
    const Layout layout = layout_of(tiff);
    if (auto reasonable = demand_reasonable(tiff, layout); !reasonable)
        return tl::make_unexpected(reasonable.error());
    try {
        Result<StoredImage> image = layout.is_plain() ? read_plain(tiff, layout) : read_colours(tiff, layout);
        if (!image) return image;
        if (layout.compression == COMPRESSION_DEFLATE || layout.compression == COMPRESSION_ADOBE_DEFLATE)
            if (const Status whole = verify_deflate(tiff); !whole) return tl::make_unexpected(whole.error());
        const int orientation = tiff.field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
        image->orientation = orientation >= 1 && orientation <= 8 ? orientation : 1;
        return image;
    } catch (const cv::Exception&) {
        return failure(Reason::device, "there is not enough memory for it");
    }
}

}  // namespace fidservo::vision

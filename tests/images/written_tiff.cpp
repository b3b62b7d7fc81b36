// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/images/written_tiff.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <tiffio.h>

namespace fidservo::testing {
namespace {

constexpr std::uint32_t metamorph_tag = 33629;

/// `count` pixels of a row from a column on, as a TIFF has them; 0 beyond the image.
std::vector<unsigned char> packed(const TiffPage& page, int row, int column, int count, int plane) {
    const int channels = page.samples.channels();
    const int first = page.is_planar ? plane : 0, last = page.is_planar ? plane : channels - 1;
    std::vector<unsigned char> bytes;
    unsigned held = 0;
    int held_bits = 0;
    for (int at = column; at < column + count; ++at)
        for (int c = first; c <= last; ++c) {
            const bool inside = row < page.samples.rows && at < page.samples.cols;
            const unsigned value = inside ? page.samples.ptr<std::uint16_t>(row)[at * channels + c] : 0U;
            if (page.bits == 16) {
                const auto sample = static_cast<std::uint16_t>(value);
                bytes.resize(bytes.size() + 2);
                std::memcpy(bytes.data() + bytes.size() - 2, &sample, 2);
                continue;
            }
            held = held << static_cast<unsigned>(page.bits) | value;
            for (held_bits += page.bits; held_bits >= 8; held_bits -= 8)
                bytes.push_back(static_cast<unsigned char>(held >> static_cast<unsigned>(held_bits - 8)));
        }
    if (held_bits > 0)
        bytes.push_back(static_cast<unsigned char>(held << static_cast<unsigned>(8 - held_bits)));
    return bytes;
}

void write_pixels(TIFF* tiff, const TiffPage& page) {
    constexpr int tile = 32;
    const int planes = page.is_planar ? page.samples.channels() : 1;
    for (int plane = 0; plane < planes; ++plane) {
        const auto sample = static_cast<std::uint16_t>(plane);
        for (int row = 0; row < page.samples.rows && !page.is_tiled; ++row) {
            auto bytes = packed(page, row, 0, page.samples.cols, plane);
            TIFFWriteScanline(tiff, bytes.data(), static_cast<std::uint32_t>(row), sample);
        }
        for (int top = 0; top < page.samples.rows && page.is_tiled; top += tile)
            for (int left = 0; left < page.samples.cols; left += tile) {
                std::vector<unsigned char> bytes;
                for (int row = top; row < top + tile; ++row) {
                    const auto more = packed(page, row, left, tile, plane);
                    bytes.insert(bytes.end(), more.begin(), more.end());
                }
                TIFFWriteTile(tiff, bytes.data(), static_cast<std::uint32_t>(left),
                              static_cast<std::uint32_t>(top), 0, sample);
            }
    }
}

void write_page(TIFF* tiff, const TiffPage& page) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, page.samples.cols);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, page.samples.rows);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, page.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, page.samples.channels());
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, page.photometric);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, page.compression);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, page.is_planar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    if (page.photometric == PHOTOMETRIC_YCBCR) TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (page.orientation != 1) TIFFSetField(tiff, TIFFTAG_ORIENTATION, page.orientation);
    if (page.is_reduced) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
    if (!page.description.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, page.description.c_str());
    if (page.depth != 1) TIFFSetField(tiff, TIFFTAG_IMAGEDEPTH, page.depth);
    if (page.metamorph_planes > 0) {
        const std::vector<float> planes(static_cast<std::size_t>(page.metamorph_planes), 1.0F);
        TIFFSetField(tiff, metamorph_tag, page.metamorph_planes, planes.data());
    }
    const std::uint64_t place_to_be_filled = 0;
    if (page.has_subdirectory) TIFFSetField(tiff, TIFFTAG_SUBIFD, 1, &place_to_be_filled);
    if (page.is_tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 32);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, 32);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, page.rows_per_strip);
    }
    if (page.photometric == PHOTOMETRIC_PALETTE) {  // greys that fall as the index rises
        std::vector<std::uint16_t> greys(std::size_t{1} << static_cast<unsigned>(page.bits));
        for (std::size_t k = 0; k < greys.size(); ++k)
            greys[k] = static_cast<std::uint16_t>(65535 - 65535 * k / (greys.size() - 1));
        TIFFSetField(tiff, TIFFTAG_COLORMAP, greys.data(), greys.data(), greys.data());
    }
    write_pixels(tiff, page);
    TIFFWriteDirectory(tiff);
}

}  // namespace

void write_tiff(const std::filesystem::path& file, const std::string& mode,
                const std::vector<TiffPage>& pages) {
    TIFF* tiff = TIFFOpen(file.c_str(), mode.c_str());
    if (tiff == nullptr) throw std::runtime_error(file.string() + ": cannot be written");
    std::string name = "UIC2";
    const TIFFFieldInfo metamorph{
        metamorph_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_RATIONAL, FIELD_CUSTOM, 1, 1, name.data()};
    TIFFMergeFieldInfo(tiff, &metamorph, 1);
    for (const TiffPage& page : pages) write_page(tiff, page);
    TIFFClose(tiff);
}

}  // namespace fidservo::testing

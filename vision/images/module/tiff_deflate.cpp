// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/module/tiff_deflate.h"

#include "core/failure.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

namespace fidservo::vision {
namespace {

/// What is wrong with a zlib stream that is to become `most` bytes at most; empty if nothing is.
std::string fault_of_stream(std::vector<unsigned char>& stream, std::uint64_t most) {
    z_stream inflation{};
    if (inflateInit(&inflation) != Z_OK) return "there is no memory for it";
    inflation.next_in = stream.data();
    inflation.avail_in = static_cast<uInt>(stream.size());
    std::array<unsigned char, 65536> passed_over;
    int state = Z_OK;
    while (state == Z_OK && inflation.total_out <= most) {
        inflation.next_out = passed_over.data();
        inflation.avail_out = static_cast<uInt>(passed_over.size());
        state = inflate(&inflation, Z_NO_FLUSH);  // compares the checksum at the end
    }
    std::string fault;
    if (state == Z_DATA_ERROR)
        fault = inflation.msg != nullptr ? inflation.msg : "damaged";
    else if (inflation.total_out > most)
        fault = "it holds more than its rows";
    else if (state != Z_STREAM_END)
        fault = "its compressed data do not end";
    inflateEnd(&inflation);
    return fault;
}

}  // namespace

Status verify_deflate(const Tiff& tiff) {
    const bool tiled = TIFFIsTiled(tiff.get()) != 0;
    const std::uint32_t count = tiled ? TIFFNumberOfTiles(tiff.get()) : TIFFNumberOfStrips(tiff.get());
    const std::uint64_t most = tiled ? TIFFTileSize64(tiff.get()) : TIFFStripSize64(tiff.get());
    const bool reversed =
        tiff.field<std::uint16_t>(TIFFTAG_FILLORDER, FILLORDER_MSB2LSB) == FILLORDER_LSB2MSB;
    std::vector<unsigned char> stream;
    for (std::uint32_t k = 0; k < count; ++k) {
        const auto wrong = [&](const std::string& why) {
            return failure(Reason::device,
                           fmt::format("damaged TIFF: {} {}: {}", tiled ? "tile" : "strip", k, why));
        };
        const std::uint64_t bytes = TIFFGetStrileByteCount(tiff.get(), k);
        if (bytes == 0 || bytes > tiff.file_bytes() || bytes > UINT32_MAX) return wrong("cut short");
        stream.resize(bytes);
        const auto size = static_cast<tmsize_t>(bytes);
        const tmsize_t read = tiled ? TIFFReadRawTile(tiff.get(), k, stream.data(), size)
                                    : TIFFReadRawStrip(tiff.get(), k, stream.data(), size);
        if (read != size) return wrong("cut short");
        if (reversed) TIFFReverseBits(stream.data(), size);
        if (const std::string fault = fault_of_stream(stream, most); !fault.empty()) return wrong(fault);
    }
    return {};
}

}  // namespace fidservo::vision

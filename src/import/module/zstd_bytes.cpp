// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/zstd_bytes.h"

#include <memory>

#include <fmt/format.h>
#include <zstd.h>

namespace fidservo::imports {
namespace {

struct FreeZstdStream {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

}  // namespace

bool is_zstd(std::string_view bytes) {
    return bytes.starts_with("(\xB5/\xFD");
}

tl::expected<std::string, std::string> decompressed(std::string_view bytes, std::size_t most_bytes,
                                                    bool (*is_interrupted)()) {
    const std::unique_ptr<ZSTD_DStream, FreeZstdStream> stream(ZSTD_createDStream());
    std::string piece(ZSTD_DStreamOutSize(), '\0'), all;
    ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
    for (;;) {
        if (is_interrupted())
            return tl::make_unexpected(std::string("is no longer decompressed: interrupted"));
        ZSTD_outBuffer out{piece.data(), piece.size(), 0};
        const std::size_t left = ZSTD_decompressStream(stream.get(), &out, &in);
        if (ZSTD_isError(left) != 0)
            return tl::make_unexpected(fmt::format("its zstd data are damaged: {}", ZSTD_getErrorName(left)));
        all.append(piece, 0, out.pos);
        if (all.size() > most_bytes)
            return tl::make_unexpected(
                fmt::format("its zstd data are more than {} bytes when decompressed", most_bytes));
        if (in.pos == in.size && left == 0) return all;
        if (in.pos == in.size && out.pos < out.size)
            return tl::make_unexpected(std::string("its zstd data break off"));
    }
}

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Decompression of zstd (RFC 8878), by which ROS 2 compresses bags.
#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace fidservo::imports {

/// Whether bytes begin with the magic number of a zstd frame.
bool is_zstd(std::string_view bytes);

/// The decompressed bytes. The error is a part of a sentence: damaged, truncated, larger than most_bytes, or
/// interrupted.
/// @param is_interrupted  asked between pieces
tl::expected<std::string, std::string> decompressed(std::string_view bytes, std::size_t most_bytes,
                                                    bool (*is_interrupted)());

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/result.h"
#include "vision/images/image_file.h"

#include <cstddef>
#include <span>

namespace fidservo::vision {

bool is_png(std::span<const std::byte> bytes);

/// Whether the beginning of a PNG states 16-bit samples.
bool is_deep_png(std::span<const std::byte> beginning);

/// Decodes a PNG as described at read_stored(); its chunk sBIT states the bits in use. Fails with
/// Reason::device for data that are damaged or truncated, or with a side beyond most_side_px.
Result<StoredImage> decode_png(std::span<const std::byte> png);

}  // namespace fidservo::vision

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/result.h"
#include "vision/images/image_file.h"

#include <cstddef>
#include <span>

namespace fidservo::vision {

bool is_png(std::span<const std::byte> bytes);

/// Does the beginning of a PNG say that its samples have 16 bits?
bool is_deep_png(std::span<const std::byte> beginning);

/// A PNG as read_stored() says; its chunk sBIT states the bits that are used. Fails with Reason::device for
/// data that are damaged anywhere or cut short, or with a side beyond most_side_px.
Result<StoredImage> decode_png(std::span<const std::byte> png);

}  // namespace fidservo::vision

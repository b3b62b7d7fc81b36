// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// EXIF data of an image: the rotation by which it is to be displayed.
#include <cstddef>
#include <span>

namespace fidservo::vision {

/// The orientation in EXIF data (given from their byte order mark on), 1 to 8; 1, upright, where there is
/// none or where they are damaged. Source: EXIF 2.32, tag 0x0112 of the first directory.
int orientation_of_exif(std::span<const std::byte> exif);

/// The orientation that a JPEG states in its APP1 segment; 1 where it states none.
int orientation_of_jpeg(std::span<const std::byte> jpeg);

/// Whether this is a JPEG with further pictures in it (CIPA DC-007, "multi-picture format").
bool has_more_pictures(std::span<const std::byte> jpeg);

}  // namespace fidservo::vision

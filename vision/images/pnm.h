// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The formats of netpbm: PBM, PGM and PPM as text and as bytes (P1 to P6), and PAM (P7).
#include "core/result.h"
#include "vision/images/image_file.h"

#include <cstddef>
#include <span>

namespace fidservo::vision {

bool is_pnm(std::span<const std::byte> beginning);

/// Whether the samples may have more than 8 bits: by the header, or because the beginning has not all of it.
bool is_deep_pnm(std::span<const std::byte> beginning);

/// Decodes the first picture of a file: white is the largest number that its header states, of PBM 0. Of a
/// PAM the tuple types BLACKANDWHITE, GRAYSCALE and RGB are read, each also with _ALPHA, which is dropped, as
/// are planes beyond those of its type; one without a tuple type is grey with a depth of 1, RGB with one
/// of 3. Fails with Reason::device for any other tuple type, a header that is damaged, a sample above the
/// largest number, data that are truncated or that are followed by something else than another picture, or a
/// side beyond most_side_px. Source: the manual pages pbm(5), pgm(5), ppm(5) and pam(5) of netpbm.
Result<StoredImage> decode_pnm(std::span<const std::byte> file);

}  // namespace fidservo::vision

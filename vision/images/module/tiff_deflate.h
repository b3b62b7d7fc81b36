// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/result.h"
#include "vision/images/module/tiff_file.h"

namespace fidservo::vision {

/// Compares the checksums (Adler-32) of a page's strips or tiles, which are compressed by deflate, with what
/// they hold: libtiff decodes them without doing so. Fails with Reason::device, naming the first that is
/// wrong, does not end or holds more than its rows.
Status verify_deflate(const Tiff& tiff);

}  // namespace fidservo::vision

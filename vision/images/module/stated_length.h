// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace fidservo::vision {

/// The length in bytes of a Matroska (WebM) or AVI file by the lengths that its outermost elements state; 0
/// if it is of another kind or does not state them.
std::uint64_t stated_length(const char* file);

}  // namespace fidservo::vision

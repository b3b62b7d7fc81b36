// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A log's signals, texts and notes as bytes, from one process of this program to another.
#include "src/import/log.h"

#include <string>
#include <string_view>

namespace fidservo::imports {

std::string to_bytes(const Log& log);

/// Of bytes that to_bytes() made, whole.
Log from_bytes(std::string_view bytes);

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Serialises a log's signals, texts and notes, to pass them between processes of this program.
#include "src/import/log.h"

#include <string>
#include <string_view>

namespace fidservo::imports {

std::string to_bytes(const Log& log);

/// The log from the bytes that to_bytes() returned.
Log from_bytes(std::string_view bytes);

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "control/comedi/board_link.h"

#include <filesystem>
#include <memory>

namespace fidservo::control::comedi {

/// A board by Linux's Comedi drivers. Throws RunFault if the node cannot be opened or no board is configured
/// on it.
std::unique_ptr<BoardLink> open_board(const std::filesystem::path& node);

}  // namespace fidservo::control::comedi

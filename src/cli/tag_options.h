// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The options of commands that look for tags in existing images.
#include "src/replay/tag_options.h"

#include <CLI/App.hpp>

namespace fidservo {

/// --name-times, --family, --border-cells, --inverted, --mirrored.
void add_tag_options(CLI::App& command, TagOptions& options);

}  // namespace fidservo

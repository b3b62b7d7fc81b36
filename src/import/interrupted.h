// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An import that the user ends with Ctrl-C or a signal.
#include "core/input_error.h"
#include "src/process/interrupt.h"

#include <fmt/format.h>

namespace fidservo::imports {

/// Throws InputError once an interrupt was requested.
inline void end_if_interrupted() {
    if (interrupt_requested())
        throw InputError(fmt::format("interrupted ({}): nothing was written", interrupt_name()));
}

}  // namespace fidservo::imports

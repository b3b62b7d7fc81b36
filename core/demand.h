// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo {

[[noreturn]] void abort_on_broken_demand(const char* condition, const char* file, int line);

}  // namespace fidservo

/// A condition that only a mistake in this program can break.
#define FIDSERVO_DEMAND(condition) \
    ((condition) ? void() : ::fidservo::abort_on_broken_demand(#condition, __FILE__, __LINE__))

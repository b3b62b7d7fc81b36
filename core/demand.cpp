// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/demand.h"

#include <cstdio>
#include <cstdlib>

namespace fidservo {

void abort_on_broken_demand(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "fidservo: broken demand: %s (%s:%d)\n", condition, file, line);
    std::abort();
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo::plant {

/// How often this test program has allocated so far.
long allocation_count();

}  // namespace fidservo::plant

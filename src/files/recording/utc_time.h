// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The date and time at which recordings are made.
#include <string>
#include <string_view>

namespace fidservo {

/// Whether a text is a time in UTC by ISO 8601, to the second: 2026-11-02T08:15:00Z.
bool is_utc_time(std::string_view text);

/// The present time in that form. For information only: this clock may be set at any moment, so nothing is
/// measured with it.
std::string utc_now();

}  // namespace fidservo

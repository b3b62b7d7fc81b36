// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The time of an image in an index, exactly.
#include "core/time.h"

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace fidservo {

/// The unit that a title of a column of times names: ns, us, ms or s; "" if it names none.
std::string index_unit_of(std::string_view title);

/// A written time in ns. Without unit, only numbers that can be nothing else are times: 19 digits, ns since
/// 1970; 10 digits and decimals, seconds since 1970. The error says what is wrong and what is allowed.
tl::expected<TimeNs, std::string> index_time_ns(std::string_view field, std::string_view unit);

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Exact parsing of an image's time in an index.
#include "core/time.h"

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace fidservo {

/// The unit that a title of a column of times names: ns, us, ms or s; "" if it names none.
std::string index_unit_of(std::string_view title);

/// Parses a time to ns. Without a unit, only unambiguous numbers are times: 19 digits, ns since 1970; 10
/// digits and decimals, seconds since 1970. The error says what is wrong and what is allowed.
tl::expected<TimeNs, std::string> index_time_ns(std::string_view field, std::string_view unit);

}  // namespace fidservo

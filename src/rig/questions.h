// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/rig/draft.h"

#include <functional>
#include <istream>
#include <ostream>
#include <string_view>

namespace fidservo {

/// Asks for the few numbers in which stages always differ. An empty line or the end of the input takes the
/// default in brackets; an invalid answer is asked for again.
/// @param is_given  whether an option, such as "--travel-mm", was given: then it is not asked for
void ask(RigDraft& draft, const std::function<bool(std::string_view option)>& is_given, std::istream& answers,
         std::ostream& questions);

}  // namespace fidservo

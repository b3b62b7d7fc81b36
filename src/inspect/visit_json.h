// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A visit as JSON, exactly: what is read back equals what was written, to the last bit.
#include "src/inspect/measure/results.h"

#include <nlohmann/json_fwd.hpp>

namespace fidservo::inspect {

nlohmann::json json_of(const Visit& visit);
/// Throws nlohmann::json::exception if the text is not a visit.
Visit visit_from(const nlohmann::json& json);

}  // namespace fidservo::inspect

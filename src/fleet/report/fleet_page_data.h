// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/findings.h"

#include <string>
#include <vector>

namespace fidservo::fleet {

/// What the page's plots draw (src/web/fleet.js), as JSON that may stand in a script element. Numbers travel
/// as base64 of little-endian float32 and float64.
std::string plot_data(const std::vector<FleetResult>& results, const FleetFindings& findings);

}  // namespace fidservo::fleet

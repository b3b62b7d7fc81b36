// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/findings.h"

#include <string>
#include <vector>

namespace fidservo::fleet {

/// The data of the page's plots (src/web/fleet.js), as JSON that is safe in a script element. Numbers are
/// encoded as base64 of little-endian float32 and float64.
std::string plot_data(const std::vector<FleetResult>& results, const FleetFindings& findings);

}  // namespace fidservo::fleet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The identifications behind the commands identify and calibrate. Each throws InputError where the input
// lacks what it needs; what the data do not determine is listed in the result.
#include "src/identify/identified.h"
#include "src/identify/input.h"

#include <span>
#include <string_view>

namespace fidservo {

/// Dead zone, gain, time constant and friction of the macro stage.
Identified identify_macro(const IdentifyInput& input);
/// The wire's table of first-order descending curves.
Identified identify_hysteresis(const IdentifyInput& input);
/// Onset, gain and time constants of the wire's heater.
Identified identify_heater(const IdentifyInput& input);
/// The Hall sensor's curve.
Identified calibrate_hall(const IdentifyInput& input);

/// An identification and the roles that its table's columns may have; the first `required` roles must be
/// given.
struct Identification {
    std::string_view name;
    std::string_view help;
    Identified (*run)(const IdentifyInput&);
    std::span<const std::string_view> roles;
    std::size_t required;
};

}  // namespace fidservo

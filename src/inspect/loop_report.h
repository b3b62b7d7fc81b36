#pragma once
// How punctual the control loop was, for people.
#include "control/loop_statistics.h"

#include <string>

namespace fidservo::inspect {

/// Table and histogram.
std::string loop_html(const control::LoopStatistics& loop);

}  // namespace fidservo::inspect

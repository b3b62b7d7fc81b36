#pragma once
// How punctual the control loop was, for people and for scripts.
#include "control/loop_statistics.h"

#include <string>

namespace fidservo::inspect {

/// Table and histogram.
std::string loop_html(const control::LoopStatistics& loop);

/// The same as JSON text: ticks, overruns, held ticks, quantiles in us, the histogram as pairs [up to us,
/// ticks] without its empty bins, and whether real-time priority and locked memory were permitted.
std::string loop_json(const control::LoopStatistics& loop);

}  // namespace fidservo::inspect

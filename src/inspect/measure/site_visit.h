// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One visit to a site: go to each view, take its picture at rest, measure.
#include "src/inspect/measure/schedule.h"
#include "src/inspect/measure/site_measurement.h"
#include "src/session/session.h"

namespace fidservo::inspect {

/// The common data of all visits in a run.
struct VisitContext {
    Measuring measuring;
    Session& session;
};

/// Views that fail are tried again as the recipe says; those that succeeded stay. A site that is given up has
/// `not_measured` rows for what is missing. Images and the recording are on the disk when this returns.
/// Throws RunFault if a device or the disk fails or the user stops the run.
Visit visit_site(const VisitContext& context, const NextVisit& next);

}  // namespace fidservo::inspect

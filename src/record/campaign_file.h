// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/record/plan.h"

namespace fidservo {

/// Notes in OUT/campaign.json what a campaign's excitation depends on: format fidservo-campaign/1,
/// rig_sha256, seed; and the stage and the camera that it is recorded with. Throws RunFault if the disk does
/// not take it.
void begin_campaign(const ExperimentOptions& options);

/// Demands that OUT holds a campaign that was begun with these options. Throws InputError.
void demand_same_campaign(const ExperimentOptions& options);

}  // namespace fidservo

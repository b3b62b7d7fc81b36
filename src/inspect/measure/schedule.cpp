// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/schedule.h"

#include "core/demand.h"

#include <algorithm>

namespace fidservo::inspect {

std::optional<NextVisit> next_visit(const std::vector<Site>& sites, const std::vector<Visit>& visits) {
    if (visits.size() < sites.size()) return NextVisit{&sites[visits.size()], false};
    const auto second_visits = static_cast<std::size_t>(std::ranges::count_if(visits, &Visit::again));
    std::size_t deferred = 0;
    for (const Visit& visit : visits) {
        if (visit.end != Visit::End::deferred || deferred++ < second_visits) continue;
        const auto site = std::ranges::find(sites, visit.site, &Site::tag_id);
        FIDSERVO_DEMAND(site != sites.end());
        return NextVisit{&*site, true};
    }
    return std::nullopt;
}

Remedy remedy_for(const OnFailure& rule, int failures, bool again) {
    if (failures <= rule.retries) return Remedy::retry;
    return rule.defer && !again ? Remedy::defer : Remedy::skip;
}

}  // namespace fidservo::inspect

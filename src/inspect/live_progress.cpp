// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/live_progress.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::inspect {

LiveProgress::LiveProgress(std::shared_ptr<LiveFeed> feed, const Recipe& recipe) : feed_(std::move(feed)) {
    state_.run = recipe.name;
    for (const Site& site : recipe.sites)
        state_.sites.push_back({site.tag_id, site.fiducial_mm.x(), "waiting"});
}

void LiveProgress::show() {
    if (feed_) feed_->is_at(state_);
}

void LiveProgress::is_at(const std::string& activity, const std::string& reason) {
    state_.activity = activity;
    state_.reason = reason;
    show();
}

void LiveProgress::goes_to(const NextVisit& next) {
    for (LiveSite& site : state_.sites)
        if (site.id == next.site->tag_id) site.state = "under_way";
    is_at(fmt::format("site {}{}", next.site->tag_id, next.again ? ", once more" : ""));
}

void LiveProgress::has_visited(const std::vector<Visit>& visits) {
    for (const Visit& visit : visits)
        for (LiveSite& site : state_.sites)
            if (site.id == visit.site)
                site.state =
                    visit.end == Visit::End::measured ? name_of(outcome_of(visit)) : name_of(visit.end);
    show();
}

}  // namespace fidservo::inspect

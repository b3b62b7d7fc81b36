// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Reports an inspection's progress to the live page.
#include "src/inspect/measure/results.h"
#include "src/inspect/measure/schedule.h"
#include "src/inspect/recipe/recipe.h"
#include "src/live/live_feed.h"

#include <memory>
#include <string>

namespace fidservo::inspect {

/// Without a feed it does nothing.
class LiveProgress {
  public:
    LiveProgress(std::shared_ptr<LiveFeed> feed, const Recipe& recipe);

    void is_at(const std::string& activity, const std::string& reason = {});
    void goes_to(const NextVisit& next);
    void has_visited(const std::vector<Visit>& visits);
    /// The run waits between sites while this is true.
    bool pause_is_asked() const { return feed_ && feed_->pause_is_asked(); }

    const std::shared_ptr<LiveFeed>& feed() const { return feed_; }

  private:
    void show();

    std::shared_ptr<LiveFeed> feed_;
    LiveState state_;
};

}  // namespace fidservo::inspect

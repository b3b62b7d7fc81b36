// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the live page is told of an inspection.
#include "src/inspect/measure/results.h"
#include "src/inspect/measure/schedule.h"
#include "src/inspect/recipe/recipe.h"
#include "src/live/live_feed.h"

#include <memory>
#include <string>

namespace fidservo::inspect {

/// Does nothing without a feed.
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

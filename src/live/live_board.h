// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The live page's data, collected from the feed by one thread and sent to browsers by others.
#include "core/micro_model.h"
#include "src/live/live_feed.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

class LiveBoard {
  public:
    /// What a browser has already received.
    struct Told {
        std::uint64_t points = 0, picture = 0, state = 0;
    };

    LiveBoard(std::shared_ptr<LiveFeed> feed, const Rig& rig);

    /// Empties the feed once.
    void collect();
    /// Waits until there is something that this browser has not received, or for the time limit. JSON in one
    /// line; empty if there is nothing new.
    std::string news(Told& told, double longest_s) const;
    /// The newest picture as JPEG; empty if there is none yet.
    std::shared_ptr<const std::string> picture() const;

  private:
    std::string points_json(Told& told) const;
    std::string point_json(const StageRow& row) const;

    std::shared_ptr<LiveFeed> feed_;
    double count_mm_;
    std::optional<MicroModel> micro_;

    mutable std::mutex mutex_;
    mutable std::condition_variable has_news_;
    std::deque<std::string> points_;  ///< as JSON
    std::uint64_t points_so_far_ = 0;
    std::shared_ptr<const std::string> jpeg_;
    std::string tags_json_, state_json_;
    std::uint64_t pictures_ = 0, states_ = 0;
};

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a run shows of itself while it is under way, and what it is asked. The run's thread puts things here
// and never waits for whoever looks at them: there is no lock between the two. What nobody takes in time is
// lost.
#include "core/detection.h"
#include "core/recording.h"
#include "core/spsc_ring.h"
#include "src/live/mailbox.h"
#include "vision/camera.h"

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

/// A frame and what was found in it.
struct LivePicture {
    vision::Frame frame;
    std::vector<TagDetection> tags;
};

/// A site as the map shows it.
struct LiveSite {
    int id;
    double x_mm;
    std::string state;  ///< waiting, under_way, deferred, skipped, or the outcome's name
};

/// How far the run is.
struct LiveState {
    std::string run;       ///< the recipe's name
    std::string activity;  ///< "homing", "site 12", "paused", "ended"
    std::string reason;    ///< why something is not as it should be; empty: nothing is
    std::vector<LiveSite> sites;
};

class LiveFeed {
  public:
    // The run's side: one thread.

    /// Every tick may be given: one of `ticks_per_point` is kept.
    void tick(const StageRow& row);
    /// What was found belongs to the last frame.
    void saw(const vision::Frame& frame) { frame_ = frame; }
    void found(const std::vector<TagDetection>& tags);
    void is_at(LiveState state) { state_.put(std::make_unique<LiveState>(std::move(state))); }
    bool pause_is_asked() const { return pause_.load(std::memory_order_relaxed); }

    // The page's side: one thread, but for ask_pause().

    /// Adds what has come since.
    void take_points(std::vector<StageRow>& points);
    std::unique_ptr<LivePicture> take_picture() { return picture_.take(); }
    std::unique_ptr<LiveState> take_state() { return state_.take(); }
    void ask_pause(bool pause) { pause_.store(pause, std::memory_order_relaxed); }

    static constexpr int ticks_per_point = 10;

  private:
    static constexpr std::size_t most_points = 1 << 14;

    SpscRing<StageRow> points_{most_points};
    Mailbox<LivePicture> picture_;
    Mailbox<LiveState> state_;
    std::atomic<bool> pause_ = false;
    int ticks_ = 0;
    std::optional<vision::Frame> frame_;
};

}  // namespace fidservo

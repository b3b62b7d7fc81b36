// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hand-over between a run and its live page. The run's thread puts data here and never waits for the
// page, as there is no lock between them; data that the page does not fetch in time are lost.
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
    std::string run;       ///< present activity: "homing", "site 12", "paused", "ended"
    std::string activity;  ///< "homing", "site 12", "paused", "ended"
    std::string reason;    ///< why something is wrong; empty: nothing is
    std::vector<LiveSite> sites;
};

class LiveFeed {
  public:
    // For the run's thread only.

    /// Called at every tick; one of `ticks_per_point` is kept.
    void tick(const StageRow& row);
    /// Sets the last frame, to which the detections that follow belong.
    void saw(const vision::Frame& frame) { frame_ = frame; }
    void found(const std::vector<TagDetection>& tags);
    void is_at(LiveState state) { state_.put(std::make_unique<LiveState>(std::move(state))); }
    bool pause_is_asked() const { return pause_.load(std::memory_order_relaxed); }

    // For the page's thread only, except ask_pause().

    /// Appends the points that are new since the last call.
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

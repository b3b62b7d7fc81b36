// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The live page: a small web server on this machine's loopback interface that shows a run and can pause and
// stop it.
//
// The run's thread only fills the feed (live_feed.h); threads of the server's own empty it, encode the
// picture and serve the page, so that a slow or a dead browser costs the run nothing. Requests that were not
// made by this page in a browser on this machine, by their Host and Origin, are refused: no other site can
// stop a run, nor look at it.
#include "src/live/live_feed.h"

#include <functional>
#include <memory>
#include <string>

namespace fidservo {

struct Rig;

class LiveServer {
  public:
    /// Listens at 127.0.0.1. Throws RunFault if the port is not available.
    /// @param port  0: any free one
    /// @param stop  called at once, by a thread of the server, when the page asks to stop
    LiveServer(int port, std::shared_ptr<LiveFeed> feed, const Rig& rig, std::function<void()> stop);
    /// Sends what the feed still holds and ends.
    ~LiveServer();
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    int port() const;
    /// "http://127.0.0.1:8731/".
    std::string url() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo

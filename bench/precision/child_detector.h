// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A detector that must live in a process of its own: ViSP's libraries export C symbols of libapriltag's
// names.
#include <array>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <sys/types.h>

namespace fidservo::bench {

/// Frames go to the program's standard input, raw; each is answered by one line: "none", or eight
/// coordinates.
class ChildDetector {
  public:
    /// Throws RunFault if the program cannot be started.
    ChildDetector(const std::string& program, cv::Size size_px, int tag_id);
    ChildDetector(const ChildDetector&) = delete;
    ChildDetector& operator=(const ChildDetector&) = delete;
    ~ChildDetector();

    struct Answer {
        double took_ms;
        std::vector<cv::Point2f> corners;  ///< px, pixel centres at integers; empty: no tag
    };

    /// Throws RunFault if the program has ended.
    Answer ask(const cv::Mat1b& frame);

  private:
    pid_t child_ = -1;
    int to_child_ = -1;
    FILE* from_child_ = nullptr;
};

}  // namespace fidservo::bench

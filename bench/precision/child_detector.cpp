// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/precision/child_detector.h"

#include "core/input_error.h"

#include <cstdio>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::bench {

ChildDetector::ChildDetector(const std::string& program, cv::Size size_px, int tag_id) {
    std::array<int, 2> down{}, up{};
    if (pipe(down.data()) != 0 || pipe(up.data()) != 0) throw RunFault("no pipe for " + program);
    const std::string width = std::to_string(size_px.width), height = std::to_string(size_px.height),
                      id = std::to_string(tag_id);
    child_ = fork();
    if (child_ < 0) throw RunFault("cannot start " + program);
    if (child_ == 0) {
        dup2(down[0], STDIN_FILENO);
        dup2(up[1], STDOUT_FILENO);
        for (const int end : {down[0], down[1], up[0], up[1]}) close(end);
        execl(program.c_str(), program.c_str(), width.c_str(), height.c_str(), id.c_str(), nullptr);
        _exit(127);
    }
    close(down[0]);
    close(up[1]);
    to_child_ = down[1];
    from_child_ = fdopen(up[0], "r");
}

ChildDetector::~ChildDetector() {
    close(to_child_);
    std::fclose(from_child_);
    waitpid(child_, nullptr, 0);
}

ChildDetector::Answer ChildDetector::ask(const cv::Mat1b& frame) {
    const cv::Mat1b whole = frame.isContinuous() ? frame : frame.clone();
    for (std::size_t sent = 0; sent < whole.total();) {
        const ssize_t now = write(to_child_, whole.data + sent, whole.total() - sent);
        if (now <= 0) throw RunFault("the child detector does not listen");
        sent += static_cast<std::size_t>(now);
    }
    std::array<char, 512> line{};
    if (std::fgets(line.data(), line.size(), from_child_) == nullptr)
        throw RunFault("the child detector does not answer");
    std::istringstream text(line.data());
    Answer answer{};
    if (!(text >> answer.took_ms)) throw RunFault("the child detector does not tell its time");
    for (cv::Point2f corner; text >> corner.x >> corner.y;) answer.corners.push_back(corner);
    return answer;
}

}  // namespace fidservo::bench

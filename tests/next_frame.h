// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Waiting for a camera in a test. The limit, which a test program's CMake file states, is for the case that
// what is waited for never comes.
#include "core/monotonic_clock.h"
#include "core/result.h"
#include "vision/camera.h"

#include <chrono>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

namespace fidservo::vision {

inline bool wait_until(const std::function<bool()>& condition,
                       std::chrono::seconds at_most = std::chrono::seconds(FIDSERVO_WAIT_LIMIT_S)) {
    const auto end = std::chrono::steady_clock::now() + at_most;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

/// The next frame or failure; empty if neither came.
inline Result<std::optional<Frame>> next(Camera& camera) {
    Result<std::optional<Frame>> got = std::optional<Frame>();
    wait_until([&] {
        got = camera.poll(monotonic_now_ns());
        return !got || *got;
    });
    return got;
}

/// The next frame; a failure of the test if there is none.
inline Frame next_frame(Camera& camera) {
    auto frame = next(camera);
    EXPECT_TRUE(frame) << frame.error().text;
    EXPECT_TRUE(frame && *frame) << "no frame";
    return frame && *frame ? std::move(**frame) : Frame();
}

/// The next failure, with frames before it skipped; an ordinary result if none came.
inline Result<std::optional<Frame>> failure_of(Camera& camera) {
    Result<std::optional<Frame>> got = std::optional<Frame>();
    wait_until([&] {
        got = camera.poll(monotonic_now_ns());
        return !got;
    });
    return got;
}

}  // namespace fidservo::vision

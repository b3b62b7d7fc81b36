// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/camera_watch.h"

#include "core/failure.h"
#include "core/result.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo {
namespace {

constexpr TimeNs period_ns = 20 * ns_per_ms;

/// A camera polled every millisecond that gives a frame every 20 ms, exposed 30 ms before.
class WatchedCamera {
  public:
    /// Polls for a while. @return the failure, if there was one
    std::optional<Failure> run(double duration_s, const auto& spoil) {
        for (const TimeNs end = now_ns + nanoseconds(duration_s); now_ns < end; now_ns += ns_per_ms) {
            stage.time_ns = now_ns;
            std::optional<vision::Frame> frame;
            if (now_ns % period_ns == 0)
                frame = vision::Frame{image(), now_ns - 30 * ns_per_ms, now_ns, 0, ""};
            spoil(frame);
            const auto admitted = watch.admit(std::move(frame), stage);
            if (!admitted) return admitted.error();
            frames += admitted->has_value();
        }
        return std::nullopt;
    }

    cv::Mat image() {
        cv::Mat picture(96, 128, CV_8UC1);
        cv::randu(picture, 20, 220);
        return picture;
    }

    CameraWatch watch{{.frame_period_s = seconds(period_ns)}};
    control::StageSample stage;
    TimeNs now_ns = ns_per_s;
    int frames = 0;
};

using MaybeFrame = std::optional<vision::Frame>;

TEST(CameraWatch, SoundFrames_AreAllHandedOn) {
    WatchedCamera camera;
    EXPECT_FALSE(camera.run(5.0, [](MaybeFrame&) {}));
    EXPECT_EQ(camera.frames, 250);
}

TEST(CameraWatch, NoFrame_FailsAfterItsPatience) {
    WatchedCamera camera;
    EXPECT_FALSE(camera.run(1.09, [](MaybeFrame& frame) { frame.reset(); }));
    const auto why = camera.run(0.1, [](MaybeFrame& frame) { frame.reset(); });
    ASSERT_TRUE(why);
    EXPECT_EQ(why->reason, Reason::device);
    EXPECT_EQ(why->text, "no frame from the camera for 1.1 s");
}

TEST(CameraWatch, NobodyPollsForAWhile_IsNoSilence) {
    WatchedCamera camera;
    for (int k = 0; k < 10; ++k) {
        EXPECT_FALSE(camera.run(0.1, [](MaybeFrame& frame) { frame.reset(); }));
        camera.now_ns += 10 * ns_per_s;
    }
}

TEST(CameraWatch, CameraThatMayComeBack_IsSilentForLonger) {
    WatchedCamera camera;
    camera.watch = CameraWatch({.frame_period_s = 0.02, .reconnect_s = 10.0});
    EXPECT_FALSE(camera.run(11.0, [](MaybeFrame& frame) { frame.reset(); }));
    EXPECT_TRUE(camera.run(0.2, [](MaybeFrame& frame) { frame.reset(); }));
}

TEST(CameraWatch, StampsAheadOfTheClock_AreNeverHandedOn) {
    WatchedCamera camera;
    const auto why = camera.run(3.0, [](MaybeFrame& frame) {
        if (frame) frame->time_ns += 2 * ns_per_s;
    });
    ASSERT_TRUE(why);
    EXPECT_EQ(why->text, "the camera's time stamps are 1.970 s ahead of the stage's clock");
    EXPECT_EQ(camera.frames, 0);
}

TEST(CameraWatch, OneOldFrame_IsPassedOver) {
    WatchedCamera camera;
    bool first = true;
    EXPECT_FALSE(camera.run(3.0, [&](MaybeFrame& frame) {
        if (frame && std::exchange(first, false)) frame->time_ns -= 2 * ns_per_s;
    }));
    EXPECT_EQ(camera.frames, 149);
}

TEST(CameraWatch, BlackOrWhiteForLong_FailsWithTheReason) {
    for (const int level : {0, 8, 255}) {
        WatchedCamera camera;
        const auto blind = [&](MaybeFrame& frame) {
            if (frame) frame->image.setTo(level);
        };
        EXPECT_FALSE(camera.run(0.8, blind)) << "a flash is borne";
        EXPECT_FALSE(camera.run(0.1, [](MaybeFrame&) {}));
        const auto why = camera.run(2.0, blind);
        ASSERT_TRUE(why) << level;
        EXPECT_EQ(why->text, level == 255 ? "100 % of the image is saturated: light and exposure?"
                                          : "the image is black: light and exposure?");
    }
}

TEST(CameraWatch, SameImageWhileTheStageMoves_IsFrozen) {
    for (const bool by_encoder : {true, false}) {
        WatchedCamera camera;
        const cv::Mat still = camera.image();
        const auto why = camera.run(4.0, [&](MaybeFrame& frame) {
            if (by_encoder)
                camera.stage.encoder_count = camera.now_ns / (100 * ns_per_ms);
            else
                camera.stage.hall_adc = static_cast<int>(camera.now_ns / (2 * ns_per_ms));
            if (frame) frame->image = still;
        });
        ASSERT_TRUE(why);
        EXPECT_EQ(why->text, "the camera shows the same image although the stage has moved");
    }
}

TEST(CameraWatch, SameImageOfAStageAtRest_IsACameraWithoutNoise) {
    WatchedCamera camera;
    cv::Mat still = camera.image();
    const auto spoil = [&](MaybeFrame& frame) {
        if (frame) frame->image = still;
    };
    for (int k = 0; k < 5; ++k) {
        EXPECT_FALSE(camera.run(3.0, spoil));
        camera.stage.encoder_count += 100;
        EXPECT_FALSE(camera.run(0.030, spoil)) << "what was exposed before the motion is yet to come";
        still = camera.image();
    }
}

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Rendered frames of the moving plate through the kernel (v4l2loopback) and the V4L2 camera: every image
// arrives, every tag is found, and displacements are those that were rendered.
#include "core/camera/camera_parameters.h"
#include "core/failure.h"
#include "core/result.h"
#include "core/units.h"
#include "src/session/sight.h"
#include "tests/next_frame.h"
#include "tests/vm/loopback_feed.h"
#include "tests/vm/plate_on_loopback.h"
#include "vision/v4l2/v4l2_camera.h"

#include <cmath>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::devices {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using vision::v4l2::PixelFormat;
using vision::v4l2::V4l2Camera;

constexpr int places = 25;

vision::v4l2::CaptureSettings settings(PixelFormat pixels) {
    const CameraParameters camera = loopback_camera();
    vision::v4l2::CaptureSettings settings;
    settings.width_px = camera.geometry.width_px;
    settings.height_px = camera.geometry.height_px;
    settings.frame_rate_hz = camera.frame_rate_hz;
    settings.exposure_s = camera.exposure_s;
    settings.latency_s = camera.latency_s;
    settings.pixels = pixels;
    return settings;
}

/// Around a tag, so that one is always wholly in view.
const std::vector<double>& places_mm() {
    static const std::vector<double> all = [] {
        std::vector<double> some;
        for (int k = 0; k < places; ++k) some.push_back(99.52 + 0.037 * k + 0.0011 * std::sin(7.0 * k));
        return some;
    }();
    return all;
}

const std::vector<cv::Mat>& frames() {
    static const std::vector<cv::Mat> rendered = frames_at(places_mm());
    return rendered;
}

/// The next frame that is not the feed's black one.
vision::Frame next_lit_frame(V4l2Camera& camera) {
    for (;;) {
        vision::Frame frame = vision::next_frame(camera);
        if (frame.image.empty() || cv::mean(frame.image)[0] > 20.0) return frame;
    }
}

/// Each frame is shown when the one before it has come out at the other end.
std::vector<vision::Frame> passed_through(PixelFormat pixels) {
    LoopbackFeed feed(loopback_node, pixels, frames().front().size());
    V4l2Camera camera(loopback_node, settings(pixels));
    std::vector<vision::Frame> came;
    for (const cv::Mat& frame : frames()) {
        feed.show(frame);
        came.push_back(next_lit_frame(camera));
        if (came.back().image.empty()) break;
    }
    const vision::FrameCounts counts = camera.counts();
    EXPECT_EQ(counts.lost + counts.damaged, 0U);
    return came;
}

class Loopback : public ::testing::TestWithParam<PixelFormat> {};

TEST_P(Loopback, MovingPlate_AllTagsFoundAndDisplacementsRight) {
    const std::vector<vision::Frame> came = passed_through(GetParam());
    ASSERT_EQ(came.size(), places_mm().size());
    Sight sight(loopback_camera(), row_of_tags());
    int found = 0;
    double origin_mm = 0.0;
    double squares = 0.0;
    double largest_um = 0.0;
    for (std::size_t k = 0; k < came.size(); ++k) {
        if (GetParam() != PixelFormat::mjpeg) {
            EXPECT_EQ(cv::norm(came[k].image, frames()[k], cv::NORM_INF), 0.0) << "frame " << k;
        }
        const auto fit = sight.locate_anywhere(came[k]);
        EXPECT_TRUE(fit) << "frame " << k << ": " << fit.error().text;
        if (!fit) continue;
        ++found;
        if (k == 0) origin_mm = fit->position.s_mm - places_mm()[0];
        const double error_mm = fit->position.s_mm - places_mm()[k] - origin_mm;
        squares += error_mm * error_mm;
        largest_um = std::max(largest_um, um_from_mm(std::abs(error_mm)));
        // Both ends of a displacement have noise. JPEG adds its own, which the detector does not know.
        const double jpeg_mm = GetParam() == PixelFormat::mjpeg ? 5e-5 : 0.0;
        EXPECT_LT(std::abs(error_mm), 5.0 * std::sqrt(2.0) * fit->position.s_std_mm + jpeg_mm)
            << "frame " << k;
    }
    std::cout << name_of(GetParam()) << ": tags found in " << found << " of " << came.size()
              << " frames; displacement error " << um_from_mm(std::sqrt(squares / found)) << " um r.m.s., "
              << largest_um << " um at most\n";
    EXPECT_EQ(found, places);
}

INSTANTIATE_TEST_SUITE_P(Formats, Loopback,
                         ::testing::Values(PixelFormat::grey, PixelFormat::yuyv, PixelFormat::y16,
                                           PixelFormat::mjpeg),
                         [](const auto& with) { return std::string(name_of(with.param)); });

TEST(LoopbackStops, NoMoreFrames_TimeOut) {
    LoopbackFeed feed(loopback_node, PixelFormat::grey, frames().front().size());
    V4l2Camera camera(loopback_node, settings(PixelFormat::grey));
    feed.show(frames().front());
    (void)next_lit_frame(camera);
    const auto got = vision::failure_of(camera);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().reason, Reason::timeout);
}

TEST(LoopbackStops, FeedOfAnotherSize_EndsWithAReason) {
    auto feed = std::make_unique<LoopbackFeed>(loopback_node, PixelFormat::grey, frames().front().size());
    V4l2Camera camera(loopback_node, settings(PixelFormat::grey));
    feed->show(frames().front());
    (void)next_lit_frame(camera);
    feed.reset();
    Failure why{Reason::stopped, ""};
    try {
        feed = std::make_unique<LoopbackFeed>(loopback_node, PixelFormat::grey, cv::Size(320, 240));
        feed->show(cv::Mat(240, 320, CV_8UC1, cv::Scalar(50)));
    } catch (const std::runtime_error& refused) {
        std::cout << "the driver refuses while somebody reads: " << refused.what() << '\n';
    }
    const auto got = vision::failure_of(camera);
    ASSERT_FALSE(got);
    std::cout << got.error().text << '\n';
    EXPECT_THAT(got.error().text,
                AnyOf(HasSubstr("the format changed under way"), HasSubstr("no whole frame")));
}

}  // namespace
}  // namespace fidservo::devices

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/faulty_devices.h"

#include "core/input_error.h"
#include "core/result.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

class StillStage final : public control::Stage {
  public:
    Result<control::StageSample> read() override { return sample; }
    Status write(const control::StageCommand& command) override {
        written = command;
        return {};
    }
    control::StageSample sample{0, 1000, 2000};
    control::StageCommand written;
};

class StillCamera final : public vision::Camera {
  public:
    Result<std::optional<vision::Frame>> poll(TimeNs now_ns) override {
        const cv::Mat image(100, 100, CV_8UC1, cv::Scalar(50.0 + static_cast<double>(sequence % 100)));
        return vision::Frame{image, now_ns - ns_per_ms, now_ns, sequence++, ""};
    }
    std::uint64_t sequence = 0;
};

TEST(Fault, Text_IsReadOrRefusedWithWhatIsAllowed) {
    const Fault fault = parse_fault("hall_stuck:from_s=40,for_s=2.5");
    EXPECT_EQ(fault.kind, FaultKind::hall_stuck);
    EXPECT_FALSE(fault.is_on(nanoseconds(39.999)));
    EXPECT_TRUE(fault.is_on(nanoseconds(40.0)));
    EXPECT_TRUE(fault.is_on(nanoseconds(42.499)));
    EXPECT_FALSE(fault.is_on(nanoseconds(42.5)));
    for (const FaultKind kind : fault_kinds) {
        EXPECT_EQ(parse_fault(std::string(name_of(kind))).kind, kind);
        EXPECT_TRUE(parse_fault(std::string(name_of(kind))).is_on(nanoseconds(1e6)));
    }
    for (const char* wrong :
         {"", "hall", "hall_stuck:", "hall_stuck:from_s", "hall_stuck:from_s=", "hall_stuck:from_s=-1",
          "hall_stuck:from_s=1x", "hall_stuck:at_s=1", "hall_stuck:from_s=nan"})
        EXPECT_THROW(parse_fault(wrong), InputError) << wrong;
}

TEST(FaultyStage, FaultsOfTheStage_ComeAndGo) {
    const auto stage = std::make_shared<StillStage>();
    FaultyStage faulty(stage, {{FaultKind::encoder_jump, 1.0, 1.0},
                               {FaultKind::hall_stuck, 1.0, 1.0},
                               {FaultKind::heater_dead, 1.0, 1.0},
                               {FaultKind::macro_jammed, 2.0, 1.0},
                               {FaultKind::stage_clock_step, 3.0, 1.0}});
    const auto at = [&](double time_s, int adc) {
        stage->sample.time_ns = nanoseconds(time_s);
        stage->sample.hall_adc = adc;
        const control::StageSample sample = faulty.read().value();
        EXPECT_TRUE(faulty.write({2.0, 1.5}));
        return sample;
    };
    EXPECT_EQ(at(0.5, 2000).encoder_count, 1000);
    EXPECT_EQ(stage->written.micro_V, 1.5);
    EXPECT_EQ(at(1.0, 2010).encoder_count, 1400);
    EXPECT_EQ(at(1.5, 2500).hall_adc, 2010);
    EXPECT_EQ(stage->written.micro_V, 0.0);
    EXPECT_EQ(stage->written.macro_V, 2.0);
    EXPECT_EQ(at(2.5, 2500).hall_adc, 2500);
    EXPECT_EQ(stage->written.micro_V, 1.5);
    EXPECT_EQ(stage->written.macro_V, 0.0);
    EXPECT_EQ(at(3.5, 2500).time_ns, nanoseconds(5.5));
}

class FaultyCameraTest : public testing::Test {
  protected:
    /// What comes out of 30 polls, one every 20 ms, under a fault.
    static std::vector<vision::Frame> frames_under(FaultKind kind) {
        FaultyCamera faulty(std::make_shared<StillCamera>(), {{kind}});
        std::vector<vision::Frame> frames;
        for (int k = 0; k < 30; ++k)
            if (auto frame = faulty.poll(k * 20 * ns_per_ms).value()) frames.push_back(*frame);
        return frames;
    }
};

TEST_F(FaultyCameraTest, Frames_AreDroppedLateOrSilent) {
    EXPECT_EQ(frames_under(FaultKind::frames_dropped).size(), 10U);
    EXPECT_EQ(frames_under(FaultKind::camera_silent).size(), 0U);
    const auto late = frames_under(FaultKind::frames_late);
    ASSERT_EQ(late.size(), 25U);
    EXPECT_EQ(late[0].sequence, 0U);
    EXPECT_EQ(late[0].arrival_ns, 100 * ns_per_ms);
    EXPECT_EQ(late[0].time_ns, -ns_per_ms) << "the exposure was when it was";
    EXPECT_EQ(frames_under(FaultKind::camera_clock_step)[0].time_ns, 2 * ns_per_s - ns_per_ms);
}

TEST_F(FaultyCameraTest, Images_AreFrozenDarkBrightOrHidden) {
    const auto grey = [](const vision::Frame& frame, int row) {
        return int(frame.image.at<unsigned char>(row, 50));
    };
    EXPECT_EQ(grey(frames_under(FaultKind::image_frozen)[20], 0), 50);
    EXPECT_EQ(grey(frames_under(FaultKind::image_dark)[20], 0), 1);
    EXPECT_EQ(grey(frames_under(FaultKind::image_bright)[20], 0), 255);
    EXPECT_EQ(grey(frames_under(FaultKind::tag_hidden)[20], 0), 70);
    EXPECT_EQ(grey(frames_under(FaultKind::tag_hidden)[20], 50), 90);
}

}  // namespace
}  // namespace fidservo

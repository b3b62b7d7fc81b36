// SPDX-License-Identifier: GPL-3.0-or-later
// Cases with frames are the same for the same seed, evenly distributed over the image's effects, and filmed
// as drawn.
#include "src/selfcheck/draw/frames_draw.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "reference/tag_picture.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/self_check.h"
#include "vision/tags/tag_appearance.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

const Rig& nominal() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

TEST(FramesDraw, SameSeedAndNumber_IsTheSameCase) {
    for (std::size_t number = 0; number < 30; ++number) {
        const Case a = draw_frames_case(nominal(), 5, number), b = draw_frames_case(nominal(), 5, number);
        EXPECT_EQ(a.campaign_seed, b.campaign_seed);
        ASSERT_EQ(a.label.effects.size(), b.label.effects.size());
        for (std::size_t k = 0; k < a.label.effects.size(); ++k) {
            EXPECT_EQ(a.label.effects[k].effect, b.label.effects[k].effect);
            EXPECT_EQ(a.label.effects[k].size, b.label.effects[k].size);
        }
        EXPECT_EQ(kind_of_frames_case(5, number), a.label.kind);
        EXPECT_TRUE(has_frames(a.label.kind));
    }
}

TEST(FramesDraw, EffectsOfTheImage_AreMetEvenlyNamedOrWithheld) {
    std::map<std::string, int> met, withheld;
    int none = 0;
    for (std::size_t number = 0; number < 80; ++number) {
        const Case drawn = draw_frames_case(nominal(), 9, number);
        if (drawn.label.effects.empty()) {
            ++none;
            continue;
        }
        const std::string& effect = drawn.label.effects.front().effect;
        const bool is_withheld = drawn.label.kind == CaseKind::frames_withheld;
        ++(is_withheld ? withheld : met)[effect];
        EXPECT_EQ(drawn.without, is_withheld ? std::vector{effect} : std::vector<std::string>{});
    }
    EXPECT_EQ(none, 20);
    EXPECT_EQ(met.size(), effects_in_frames().size());
    EXPECT_EQ(withheld.size(), effects_in_frames().size());
    for (const auto& [effect, count] : met) EXPECT_EQ(count, 8) << effect;
    for (const auto& [effect, count] : withheld) EXPECT_EQ(count, 4) << effect;
}

TEST(FramesDraw, KindsWithAndWithoutFrames_DoNotGoTogether) {
    SelfCheckOptions options;
    options.kinds = {CaseKind::one, CaseKind::frames};
    EXPECT_THROW(run_self_check(nominal(), options, [](const SelfCheck&) {}), InputError);
}

/// The independent renderer's tag 3, its centre at (x, y) from the image's centre, a pixel's share off it.
TagAppearance look_of(const reference::ImageDepartures& departures, double s_mm, double speed_mm_per_s) {
    const reference::PictureModel model{*nominal().camera, *nominal().fiducials, departures,
                                        [](int) { return reference::TagCells::Ones().eval(); }};
    NoiseStream noise(4, "frames draw test");
    const reference::Picture picture = picture_of(
        model, [&](double after_s) { return s_mm + speed_mm_per_s * after_s; }, pixel_gains(model, 4), noise);
    TagDetection tag;
    const double u_px = 639.5 + 250.0 * (6.0 - s_mm);
    for (std::size_t k = 0; k < 4; ++k)
        tag.corners_px[k] = Eigen::Vector2d(u_px, 479.5) + 150.0 * tag_corners[k];
    return vision::tag_appearance(picture.image, tag);
}

TEST(ReferencePicture, BlurMotionAndNoise_AreWhatTheCameraIsSaidToHave) {
    for (const double s_mm : {5.9, 6.0, 6.1007}) {
        const TagAppearance still = look_of({}, s_mm, 0.0);
        const TagAppearance gaussian = look_of({.defocus_px = 1.5}, s_mm, 0.0);
        const TagAppearance disc = look_of({.defocus_px = 1.5, .defocus_is_disc = true}, s_mm, 0.0);
        const TagAppearance moving = look_of({.extra_exposure_s = 3e-3}, s_mm, 5.0);  // 6.25 px
        for (std::size_t k = 0; k < 4; ++k) {
            const double nominal_px2 = 0.64 + 1.0 / 12.0, tolerance_px2 = 0.05;
            EXPECT_NEAR(still.sides[k].variance_px2, nominal_px2, tolerance_px2);
            EXPECT_NEAR(gaussian.sides[k].variance_px2, nominal_px2 + 2.25, 2.0 * tolerance_px2);
            EXPECT_NEAR(disc.sides[k].variance_px2, nominal_px2 + 2.25, 2.0 * tolerance_px2);
            const double across = std::abs(moving.sides[k].normal.x());
            EXPECT_NEAR(moving.sides[k].variance_px2, nominal_px2 + across * 6.25 * 6.25 / 12.0,
                        3.0 * tolerance_px2);
        }
        const double per_e = 255.0 / 10000.0;
        const auto expected = [&](double grey, double read_e, double spread) {
            return per_e * grey + std::pow(per_e * read_e, 2) + std::pow(spread * grey, 2) + 1.0 / 12.0;
        };
        const TagAppearance noisy = look_of({.read_noise_e = 60.0, .gain_spread = 0.02}, s_mm, 0.0);
        EXPECT_NEAR(still.white.variance_grey2 / expected(still.white.grey, 5.0, 0.0), 1.0, 0.1);
        EXPECT_NEAR(noisy.white.variance_grey2 / expected(noisy.white.grey, std::hypot(5.0, 60.0), 0.02), 1.0,
                    0.1);
        EXPECT_NEAR(noisy.black.variance_grey2 / expected(noisy.black.grey, std::hypot(5.0, 60.0), 0.02), 1.0,
                    0.1);
    }
}

}  // namespace
}  // namespace fidservo::selfcheck

// SPDX-License-Identifier: GPL-3.0-or-later
// Effects that only images show: frames of the simulated camera against those of the independent renderer.
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/view/plate_view.h"
#include "reference/tag_picture.h"
#include "src/files/rig/plate_file.h"
#include "tests/laws/effect_law.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo {
namespace {

using plant::Effect;

constexpr double speed_mm_per_s = 4.0;

double camera_mm(double after_s) {
    return 50.37 + speed_mm_per_s * after_s;
}

/// Two frames of one tag: of the simulated camera, and of the independent model's.
struct Frames {
    cv::Mat simulated, independent;
};

Frames frames_of(const CameraParameters& camera, const plant::CameraDeviation& deviation,
                 const reference::ImageDepartures& departures) {
    const FiducialParameters& grid = *reference_rig().fiducials;
    const plant::PlateView view(camera, plate_of(grid), {}, deviation);
    const reference::PictureModel model{camera, grid, departures, reference::usual_cells};
    NoiseStream noise(3, "picture laws");
    const reference::Picture picture = picture_of(model, camera_mm, pixel_gains(model, 3), noise);
    Frames frames;
    view.expose(camera_mm, 3)(picture.region_px).convertTo(frames.simulated, CV_64F);
    picture.image(picture.region_px).convertTo(frames.independent, CV_64F);
    return frames;
}

double mean_difference(const cv::Mat& one, const cv::Mat& other) {
    return cv::norm(one, other, cv::NORM_L1) / static_cast<double>(one.total());
}

double rms_difference(const cv::Mat& one, const cv::Mat& other) {
    return cv::norm(one, other, cv::NORM_L2) / std::sqrt(static_cast<double>(one.total()));
}

CameraParameters without_noise(CameraParameters camera) {
    camera.read_noise_e = 0.0;
    camera.full_well_e = 1e12;
    return camera;
}

class PictureLaws : public ::testing::TestWithParam<const Effect*> {};

TEST_P(PictureLaws, Frame_IsThatOfTheIndependentRenderer) {
    const testing::EffectLaw* law = testing::law_of(*GetParam());
    ASSERT_NE(law, nullptr);
    const Rig& rig = reference_rig();
    const plant::PlantParameters parameters = testing::with(plant::parse_effect(law->setting));
    reference::Departures departures;
    law->depart(departures, rig);
    const bool is_noise = departures.image.read_noise_e > 0.0;
    const CameraParameters camera = is_noise ? *rig.camera : without_noise(*rig.camera);
    const Frames nominal = frames_of(camera, {}, {});
    const Frames changed = frames_of(camera, *parameters.camera, departures.image);
    if (!is_noise) {
        const double apart = mean_difference(changed.simulated, changed.independent);
        const double by_effect = mean_difference(changed.simulated, nominal.simulated);
        std::printf("%-16s apart by %.3f grey values, nominal by %.3f, the effect changes %.3f\n",
                    GetParam()->name.data(), apart, mean_difference(nominal.simulated, nominal.independent),
                    by_effect);
        EXPECT_LT(apart, 0.3);
        EXPECT_GT(by_effect, 5.0 * apart);
        return;
    }
    const Frames clean = frames_of(without_noise(*rig.camera), {}, {});
    const double simulated = rms_difference(changed.simulated, clean.simulated);
    const double independent = rms_difference(changed.independent, clean.independent);
    const double by_file = rms_difference(nominal.simulated, clean.simulated);
    std::printf("%-16s noise: %.3f and %.3f grey values, %.3f by the rig file\n", GetParam()->name.data(),
                simulated, independent, by_file);
    EXPECT_NEAR(simulated / independent, 1.0, 0.03);
    EXPECT_GT(simulated, 1.2 * by_file);
}

std::vector<const Effect*> effects_in_images() {
    std::vector<const Effect*> effects;
    for (const Effect* effect : plant::effect_catalogue())
        if (plant::is_of_frames(effect->part)) effects.push_back(effect);
    return effects;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, PictureLaws, ::testing::ValuesIn(effects_in_images()),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
// Which images an inspection measures again, and what it says of those that cannot serve.
#include "src/inspect/saved_images.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/inspect/inspection_run.h"
#include "tests/inspect/small_recipe.h"
#include "tests/src/temporary_folder.h"
#include "vision/images/image_file.h"

#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

using ::testing::HasSubstr;

class SavedImagesOf : public ::testing::Test {
  protected:
    const Rig rig = small_rig();
    const Recipe recipe = parse_recipe(small_recipe, "recipe.yaml", rig);
    const Site& site = recipe.sites.front();
    fidservo::testing::TemporaryFolder folder;

    void save(const std::filesystem::path& file, cv::Size size) const {
        const auto png = vision::encode_png(cv::Mat(size, CV_8UC1, cv::Scalar(100)), 1);
        std::ofstream(folder / file, std::ios::binary)
            .write(reinterpret_cast<const char*>(png.data()), std::ssize(png));
    }
};

std::string complaint(const std::function<void()>& what) {
    try {
        what();
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "nothing was wrong";
}

TEST_F(SavedImagesOf, Run_ItsFolderOfImagesIsFound) {
    std::filesystem::create_directory(folder / "images");
    save("images/site-010-left.png", {1280, 960});
    const SavedImages images(folder.path(), recipe);
    EXPECT_TRUE(images.image_of(site, site.views[0], *rig.camera));
    const auto missing = images.image_of(site, site.views[1], *rig.camera);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().reason, Reason::no_image);
}

TEST_F(SavedImagesOf, SiteVisitedTwice_TheSecondVisitsImageCounts) {
    save("site-010-left.png", {1280, 960});
    save("site-010-again-left.png", {1280, 960});
    const auto image = SavedImages(folder.path(), recipe).image_of(site, site.views[0], *rig.camera);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->source, "site-010-again-left.png");
}

TEST_F(SavedImagesOf, AnotherCamerasImage_IsRefusedByItsSize) {
    save("site-010-left.png", {640, 480});
    const SavedImages images(folder.path(), recipe);
    EXPECT_THAT(complaint([&] { (void)images.image_of(site, site.views[0], *rig.camera); }),
                HasSubstr("site-010-left.png: 640 x 480 px; the rig's camera has 1280 x 960 px"));
}

TEST_F(SavedImagesOf, ImagesOfOtherNames_TheFirstNameIsSaid) {
    save("photo.png", {1280, 960});
    EXPECT_THAT(complaint([&] { SavedImages(folder.path(), recipe); }),
                HasSubstr("the first would be called site-010-left.png"));
    EXPECT_THAT(complaint([&] { SavedImages(folder / "nowhere", recipe); }), HasSubstr("no such folder"));
}

TEST(ImagesMeasuredAgain, WhatMoves_IsRefused) {
    const fidservo::testing::TemporaryFolder folder;
    InspectionOptions options;
    options.recipe = std::filesystem::path(FIDSERVO_ASSETS_DIR) / "demo/recipe.yaml";
    options.session.rig_file = std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml";
    options.session.camera = "images:" + folder.path().string();
    options.out = folder / "out";
    options.resume = true;
    EXPECT_THAT(complaint([&] { run_inspection(options); }), HasSubstr("leave --resume out"));
    options.resume = false;
    options.session.stage = "comedi:/dev/comedi0";
    EXPECT_THAT(complaint([&] { run_inspection(options); }), HasSubstr("leave --stage out"));
    EXPECT_FALSE(std::filesystem::exists(options.out));
}

}  // namespace
}  // namespace fidservo::inspect

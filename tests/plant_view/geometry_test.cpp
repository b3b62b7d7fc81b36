// SPDX-License-Identifier: GPL-3.0-or-later
// Places in rendered images: a motion by 0.01 px is one of 0.01 px, and the detector finds tags where they
// are.
#include "core/camera/camera_geometry.h"
#include "core/camera/camera_parameters.h"
#include "core/input_error.h"
#include "core/random.h"
#include "tests/plant_view/view_fixture.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

struct Centroid {
    double u_px;
    double std_px;  ///< standard deviation from rounding to whole grey levels
};

/// Centre of intensity in u of an image that is black around one thing. A pixel that is neither black nor
/// white carries a rounding error of variance 1/12 (independent ones: the thing must not lie symmetrically to
/// the pixels).
Centroid centroid_of(const cv::Mat& image) {
    double sum = 0.0, moment = 0.0;
    for (int v = 0; v < image.rows; ++v) {
        for (int u = 0; u < image.cols; ++u) {
            sum += image.at<std::uint8_t>(v, u);
            moment += u * static_cast<double>(image.at<std::uint8_t>(v, u));
        }
    }
    const double centre = moment / sum;
    double variance = 0.0;
    for (int v = 0; v < image.rows; ++v) {
        for (int u = 0; u < image.cols; ++u) {
            const int grey = image.at<std::uint8_t>(v, u);
            if (grey > 0 && grey < 255) variance += (u - centre) * (u - centre) / 12.0;
        }
    }
    return {centre, std::sqrt(variance) / sum};
}

/// Compares the centroid with the true place over random shifts, and tests for errors that repeat with the
/// pixel grid.
void expect_no_centroid_error(const Feature& feature) {
    Plate plate = dark_plate();
    plate.features.push_back(feature);
    const CameraParameters camera = small_camera(160, 160);
    const PlateView view(camera, plate, ideal_view());
    NoiseStream shifts(7, "test_shifts");
    double sine = 0.0, cosine = 0.0, std_px = 0.0;
    constexpr int cases = 100;
    for (int k = 0; k < cases; ++k) {
        const double s_mm = 0.04 * (shifts.uniform() - 0.5);
        const double true_u = project(camera.geometry, {0.0, 0.0}, s_mm).x();
        const Centroid centroid = centroid_of(render_at(view, s_mm));
        const double error = centroid.u_px - true_u;
        std_px = centroid.std_px;
        EXPECT_NEAR(error, 0.0, 4.5 * std_px) << feature.name << " at s = " << s_mm << " mm, seed 7";
        sine += error * std::sin(2.0 * M_PI * true_u) * 2.0 / cases;
        cosine += error * std::cos(2.0 * M_PI * true_u) * 2.0 / cases;
    }
    EXPECT_LT(std_px, 5e-4);
    // Rounding errors also repeat with the pixel grid, and part of them is in the first harmonic.
    EXPECT_LT(std::hypot(sine, cosine), std_px) << feature.name << ": harmonic of the pixel grid";
}

TEST(PlateView, Dot_Centroid_IsTheTruePlaceAtAnySubPixelShift) {
    expect_no_centroid_error({"dot", Dot{{0.0, 0.0013}, 0.4}, 1.0});
    expect_no_centroid_error({"small dot", Dot{{0.0, 0.0013}, 0.12}, 1.0});
}

TEST(PlateView, TurnedPad_Centroid_IsTheTruePlaceAtAnySubPixelShift) {
    expect_no_centroid_error({"pad", Pad{{0.0, 0.0}, {0.3, 0.2}, 0.3}, 1.0});
}

/// Least squares of the image difference on the gradient in u (Lucas-Kanade, one step): shift of `moved`
/// against `image` in px. Central differences and the mean of both images make it exact to the third order.
double shift_px(const cv::Mat& image, const cv::Mat& moved) {
    double numerator = 0.0, denominator = 0.0;
    for (int v = 0; v < image.rows; ++v) {
        for (int u = 1; u + 1 < image.cols; ++u) {
            const auto mean = [&](int at) {
                return 0.5 * (image.at<std::uint8_t>(v, at) + moved.at<std::uint8_t>(v, at));
            };
            const double gradient = 0.5 * (mean(u + 1) - mean(u - 1));
            const double difference = moved.at<std::uint8_t>(v, u) - image.at<std::uint8_t>(v, u);
            numerator -= gradient * difference;
            denominator += gradient * gradient;
        }
    }
    return numerator / denominator;
}

TEST(PlateView, Tag_ShiftOfAHundredthPixel_ComesBack) {
    Plate plate;
    plate.tags.push_back({.id = 3, .centre_mm = {0.0, 0.0}, .side_mm = 1.2, .angle_rad = 0.0122});
    const CameraParameters camera = small_camera(360, 360);
    const PlateView view(camera, plate, ideal_view());
    NoiseStream starts(9, "test_starts");
    // For a blur of 0.85 px the central difference underestimates the slope by a sixth. It is calibrated
    // twice by shifts of the same images by exactly a tenth of a pixel.
    const cv::Mat at_zero = render_at(view, 0.0);
    const double scale = 0.1 / shift_px(at_zero, render_at(view, -0.0004));
    EXPECT_NEAR(scale * shift_px(at_zero, render_at(view, 0.0004)), -0.1, 5e-4);
    for (int k = 0; k < 20; ++k) {
        const double s_mm = 0.01 * starts.uniform();
        const double shift = scale * shift_px(render_at(view, s_mm), render_at(view, s_mm - 0.00004));
        EXPECT_NEAR(shift, 0.01, 5e-4) << "s = " << s_mm << " mm, seed 9";
    }
}

/// libapriltag on a rendered image.
class Detector {
  public:
    Detector() : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
        apriltag_detector_add_family(detector_, family_);
        detector_->quad_decimate = 1.0F;
        detector_->nthreads = 1;
    }
    ~Detector() {
        apriltag_detector_destroy(detector_);
        tag36h11_destroy(family_);
    }
    Detector(const Detector&) = delete;
    Detector& operator=(const Detector&) = delete;

    struct Found {
        int id, hamming;
        std::array<Eigen::Vector2d, 4> corners_px;  ///< pixel centres at integers
    };
    std::vector<Found> find(const cv::Mat& image) const {
        image_u8_t view{image.cols, image.rows, static_cast<std::int32_t>(image.step), image.data};
        const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> list(
            apriltag_detector_detect(detector_, &view), &apriltag_detections_destroy);
        std::vector<Found> result;
        for (int k = 0; k < zarray_size(list.get()); ++k) {
            const apriltag_detection_t* detection = nullptr;
            zarray_get(list.get(), k, &detection);
            Found found{detection->id, detection->hamming, {}};
            for (int c = 0; c < 4; ++c) {
                found.corners_px[c] = Eigen::Vector2d(detection->p[c][0], detection->p[c][1]).array() - 0.5;
            }
            result.push_back(found);
        }
        return result;
    }

  private:
    apriltag_family_t* family_;
    apriltag_detector_t* detector_;
};

/// Renders tags that are completely in view, and requires that the library detects each of them in the right
/// place.
void expect_detected(const Detector& detector, const std::vector<PlateTag>& tags,
                     const CameraParameters& camera, double s_mm) {
    Plate plate;
    plate.tags = tags;
    const PlateView view(camera, plate, {});
    const auto found = detector.find(render_at(view, s_mm, static_cast<std::uint64_t>(tags.front().id)));
    EXPECT_EQ(found.size(), tags.size()) << "from id " << tags.front().id;
    for (const PlateTag& tag : tags) {
        const auto seen = std::ranges::find(found, tag.id, &Detector::Found::id);
        ASSERT_NE(seen, found.end()) << "id " << tag.id;
        EXPECT_EQ(seen->hamming, 0) << "id " << tag.id;
        const Eigen::Matrix2d turn = Eigen::Rotation2Dd(tag.angle_rad).toRotationMatrix();
        const double half_mm = 0.5 * tag.side_mm;
        const std::array<Eigen::Vector2d, 4> corners_mm{{{-half_mm, half_mm},
                                                         {half_mm, half_mm},
                                                         {half_mm, -half_mm},
                                                         {-half_mm, -half_mm}}};  // p0..p3 in plate x, y
        for (int c = 0; c < 4; ++c) {
            const Eigen::Vector2d expected =
                project(camera.geometry, tag.centre_mm + turn * corners_mm[c], s_mm);
            EXPECT_LT((seen->corners_px[c] - expected).norm(), 0.1) << "id " << tag.id << ", corner " << c;
        }
    }
}

void expect_detected(const Detector& detector, int id, double angle_rad, double s_mm) {
    expect_detected(detector,
                    {{.id = id, .centre_mm = {0.013, -0.007}, .side_mm = 1.2, .angle_rad = angle_rad}},
                    small_camera(480, 480), s_mm);
}

TEST(PlateView, Tag_IsReadByTheLibrary_UprightAndInPlace) {
    const Detector detector;
    expect_detected(detector, 0, 0.7 * M_PI / 180.0, 0.0);
    expect_detected(detector, 42, 0.7 * M_PI / 180.0, 0.0013);
    expect_detected(detector, 586, -20.0 * M_PI / 180.0, -0.0021);
    expect_detected(detector, 7, 2.0, 0.0);
}

TEST(SlowPlateView, EveryTagOfTheFamily_IsReadByTheLibrary) {
    constexpr int family_size = 587, columns = 5, rows = 4;
    constexpr double side_mm = 0.6, pitch_mm = 0.92;
    const Detector detector;
    NoiseStream random(3, "test_tags");
    for (int first = 0; first < family_size; first += columns * rows) {
        std::vector<PlateTag> tags;
        for (int id = first; id < std::min(first + columns * rows, family_size); ++id) {
            const int k = id - first;
            const Eigen::Vector2d centre_mm(pitch_mm * (k % columns - 0.5 * (columns - 1)),
                                            pitch_mm * (k / columns - 0.5 * (rows - 1)));
            tags.push_back(
                {.id = id, .centre_mm = centre_mm, .side_mm = side_mm, .angle_rad = 0.7 * M_PI / 180.0});
        }
        expect_detected(detector, tags, small_camera(1280, 960), 0.004 * random.uniform());
    }
}

TEST(PlateView, TagOutsideTheCodeBook_IsRefused) {
    Plate plate;
    plate.tags.push_back({.id = 587, .centre_mm = {0.0, 0.0}, .side_mm = 1.2});
    EXPECT_THROW(PlateView(reference_camera(), plate, {}), InputError);
    plate.tags[0] = {
        .id = 30, .centre_mm = {0.0, 0.0}, .side_mm = 1.2, .print = {find_tag_family("tag16h5")}};
    EXPECT_THROW(PlateView(reference_camera(), plate, {}), InputError);
}

TEST(PlateView, ShapeWithoutArea_IsRefused) {
    for (const auto& shape : std::vector<decltype(Feature::shape)>{
             Dot{{0, 0}, 0.0}, Pad{{0, 0}, {0.1, -0.1}}, Line{{1, 1}, {1, 1}, 0.1}, Scratch{{{0, 0}}, 0.1},
             Scratch{{{0, 0}, {1, 0}, {1, 0}}, 0.1}}) {
        Plate plate;
        plate.features.push_back({"nothing", shape, 0.1});
        EXPECT_THROW(PlateView(reference_camera(), plate, {}), InputError);
    }
}

}  // namespace
}  // namespace fidservo::plant

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/plate_view.h"

#include "core/camera/camera_parameters.h"
#include "core/random.h"
#include "plant/actual_camera.h"
#include "plant/view/light_field.h"
#include "plant/view/pixel_map.h"
#include "plant/view/sensor.h"
#include "plant/view/straight_rows.h"
#include "plant/view/warped_rows.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace fidservo::plant {

namespace {

constexpr std::size_t exposure_samples = 9;

/// The options with what the camera adds to them.
ViewOptions seen_through(ViewOptions options, const CameraParameters& camera,
                         const CameraDeviation& deviation) {
    options.blur_px = std::hypot(options.blur_px.value_or(camera.blur_px), deviation.extra_blur_px);
    options.light.gradient += deviation.light_gradient;
    options.light.vignetting += deviation.vignetting;
    options.pixel_gain_spread =
        std::hypot(std::hypot(options.pixel_gain_spread, deviation.gain_spread), camera.gain_spread);
    return options;
}

view::Picture picture_of(const ActualCamera& actual, const Plate& plate, const ViewOptions& options) {
    const CameraGeometry& camera = actual.geometry;
    const view::ImageMap map(camera, actual.foot_mm);
    return {camera.width_px,
            camera.height_px,
            static_cast<float>(plate.paper_reflectance),
            map,
            view::scene_of(plate, options.occluders, options.blur_px.value(), map),
            options.glare};
}

/// The plate as it is, whose tags may lie beside where they should.
Plate plate_as_it_is(Plate plate, const CameraDeviation& deviation) {
    for (PlateTag& tag : plate.tags) tag.centre_mm += tag_offset_mm(deviation, tag.centre_mm);
    return plate;
}

}  // namespace

struct PlateView::Impl {
    Impl(const CameraParameters& camera_parameters, const Plate& nominal_plate,
         const ViewOptions& view_options, const CameraDeviation& camera_deviation)
        : camera(camera_parameters),
          plate(plate_as_it_is(nominal_plate, camera_deviation)),
          deviation(camera_deviation),
          plain_options(view_options),
          options(seen_through(view_options, camera, deviation)),
          actual(actual_camera(camera.geometry, deviation)),
          picture(picture_of(actual, plate, options)),
          pixels(actual.geometry, picture.map),
          white_grey(view::light_field(picture.width, picture.height, options)),
          sensor(camera.full_well_e, std::hypot(camera.read_noise_e, deviation.extra_read_noise_e)) {}

    double exposure_s() const { return camera.exposure_s + deviation.extra_exposure_s; }

    /// @param samples_of  the camera's positions over the exposure of a row
    template <class Rows, class SamplesOf>
    cv::Mat render(Rows rows, SamplesOf samples_of, bool all_rows_at_once, std::uint64_t frame) const {
        const int width = picture.width, height = picture.height;
        cv::Mat image(height, width, CV_8UC1);
        std::vector<float> mean(width), normals(width);
        NoiseStream noise(options.seed, "pixel_noise");
        for (int v = 0; v < height; ++v) {
            if (v == 0 || !all_rows_at_once) rows.expose(samples_of(v));
            rows.paint(v, mean);
            const float* const row_white_grey = white_grey.data() + static_cast<std::size_t>(v) * width;
            for (int u = 0; u < width; ++u) mean[u] *= row_white_grey[u];
            const std::span<std::uint8_t> grey(image.ptr<std::uint8_t>(v), static_cast<std::size_t>(width));
            if (options.noise) {
                noise.seek((frame * height + v) * view::NormalRow::draws_from_stream);
                normal_row.fill(noise, normals);
                sensor.expose(mean, normals, grey);
            } else {
                view::Sensor::expose(mean, grey);
            }
        }
        return image;
    }

    template <class SamplesOf>
    cv::Mat render(SamplesOf samples_of, bool all_rows_at_once, std::uint64_t frame) const {
        const bool smears_along_u =
            picture.map.shifts_along_u() || (all_rows_at_once && view::is_at_rest(picture, samples_of(0)));
        if (pixels.is_identity() && smears_along_u)
            return render(view::StraightRows(picture), samples_of, all_rows_at_once, frame);
        return render(view::WarpedRows(picture, pixels), samples_of, all_rows_at_once, frame);
    }

    /// The same at a moment, as a camera that does not change.
    Impl at(double time_s, double s_mm) const {
        CameraDeviation there = deviation_at(deviation, time_s, s_mm);
        there.formulas = {};
        return {camera, plate, plain_options, there};
    }

    CameraParameters camera;
    Plate plate;
    CameraDeviation deviation;
    ViewOptions plain_options;  ///< without what the camera adds
    ViewOptions options;
    ActualCamera actual;
    view::Picture picture;
    view::PixelMap pixels;
    std::vector<float> white_grey;  ///< light field
    view::Sensor sensor;
    view::NormalRow normal_row;
};

PlateView::PlateView(const CameraParameters& camera, const Plate& plate, const ViewOptions& options,
                     const CameraDeviation& deviation)
    : impl_(std::make_unique<const Impl>(camera, plate, options, deviation)) {}
PlateView::PlateView(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
PlateView::~PlateView() = default;
PlateView::PlateView(PlateView&&) noexcept = default;
PlateView& PlateView::operator=(PlateView&&) noexcept = default;

cv::Mat PlateView::render(std::span<const double> s_mm, std::uint64_t frame) const {
    return impl_->render([&](int) { return s_mm; }, true, frame);
}

cv::Mat PlateView::expose(const Path& path, std::uint64_t frame, double time_s) const {
    if (geometry_changes(impl_->deviation)) {
        return PlateView(std::make_unique<const Impl>(impl_->at(time_s, path(0.0))))
            .expose(path, frame, time_s);
    }
    const Impl& self = *impl_;
    std::array<double, exposure_samples> s_mm{};
    const auto samples_of = [&](int v) -> std::span<const double> {
        const double row_s = row_delay_s(self.camera.geometry, self.deviation, v);
        for (std::size_t i = 0; i < exposure_samples; ++i) {
            const double share = static_cast<double>(i) / (exposure_samples - 1) - 0.5;
            s_mm[i] = path(row_s + share * self.exposure_s());
        }
        return s_mm;
    };
    return self.render(samples_of, self.deviation.readout_s == 0.0, frame);
}

double PlateView::reach_s() const {
    return 0.5 * (impl_->exposure_s() + std::abs(impl_->deviation.readout_s));
}

}  // namespace fidservo::plant

#include "plant/view/plate_view.h"

#include "core/failure.h"
#include "core/random.h"
#include "plant/view/image_map.h"
#include "plant/view/light_field.h"
#include "plant/view/motion_blur.h"
#include "plant/view/scene.h"
#include "plant/view/sensor.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fidservo::plant {

namespace {

using view::Item;

/// Pixels first .. last - 1 of a row.
struct Span {
    int first, last;

    bool contains(int pixel) const { return pixel >= first && pixel < last; }
};

/// Something at its place in one frame, and the pixels it can reach.
struct Placed {
    const view::Shape* shape;
    float reflectance;
    Eigen::Vector2d centre_px;
    Span across, down;
};

/// A reflection at its place in one frame: the product of a profile across and one down.
struct PlacedGlare {
    Span across, down;
    std::vector<float> profile_across, profile_down;
};

Span pixels_within(double centre, double half, Span limits) {
    const int first = std::max(limits.first, static_cast<int>(std::ceil(std::max(centre - half, -1e9))));
    const int last = std::min(limits.last, static_cast<int>(std::floor(std::min(centre + half, 1e9))) + 1);
    return {first, std::max(first, last)};
}

/// One row of reflectance, with a margin at both ends for what motion carries into the image.
class ReflectanceRow {
  public:
    ReflectanceRow(int width, int margin, float paper)
        : margin_(margin), paper_(paper), values_(width + 2 * margin), coverage_(values_.size()) {}

    void clear() {
        std::fill(values_.begin(), values_.end(), paper_);
        painted_ = {static_cast<int>(values_.size()), 0};
    }

    void paint(const Placed& item, int v) {
        const int length = item.across.last - item.across.first;
        const std::span<float> coverage(coverage_.data(), static_cast<std::size_t>(length));
        view::cover(*item.shape, item.across.first - item.centre_px.x(), v - item.centre_px.y(), coverage);
        float* const row = begin_writing(item.across);
        for (int i = 0; i < length; ++i) row[i] += coverage[i] * (item.reflectance - row[i]);
    }

    void add(const PlacedGlare& glare, int v) {
        float* const row = begin_writing(glare.across);
        const float strength = glare.profile_down[v - glare.down.first];
        for (std::size_t i = 0; i < glare.profile_across.size(); ++i) {
            row[i] += strength * glare.profile_across[i];
        }
    }

    /// The row after motion, without the margins.
    void average(const view::MotionKernel& kernel, std::span<float> result) const {
        if (kernel.is_identity()) {
            std::copy_n(values_.begin() + margin_, result.size(), result.begin());
            return;
        }
        const int reach = kernel.reach();
        std::fill(result.begin(), result.end(), paper_);
        const int first = std::max(painted_.first - margin_ - reach, 0);
        const int last = std::min(painted_.last - margin_ + reach, static_cast<int>(result.size()));
        if (first >= last) return;
        const auto length = static_cast<std::size_t>(last - first);
        kernel.apply({values_.data() + first + margin_ - reach, length + 2 * static_cast<std::size_t>(reach)},
                     result.subspan(first, length));
    }

  private:
    float* begin_writing(Span across) {
        painted_.first = std::min(painted_.first, across.first + margin_);
        painted_.last = std::max(painted_.last, across.last + margin_);
        return values_.data() + across.first + margin_;
    }

    int margin_;
    float paper_;
    Span painted_{};
    std::vector<float> values_, coverage_;
};

}  // namespace

struct PlateView::Impl {
    Impl(const CameraParameters& camera, const Plate& plate, const ViewOptions& view_options)
        : options(view_options),
          width(camera.geometry.width_px),
          height(camera.geometry.height_px),
          paper(static_cast<float>(plate.paper_reflectance)),
          map(camera.geometry),
          items(view::scene_of(plate, options.occluders, options.blur_px.value_or(camera.blur_px), map)),
          white_grey(view::light_field(width, height, options)),
          sensor(camera.full_well_e, camera.read_noise_e) {}

    /// What can be seen in some row, with `margin` more pixels at both sides of the image.
    std::vector<Placed> place_items(double s_mm, int margin) const {
        std::vector<Placed> placed;
        for (const Item& item : items) {
            const Eigen::Vector2d centre = map.place(item.centre_mm, s_mm);
            const Eigen::Vector2d half = view::half_extent_px(*item.shape);
            const Span across = pixels_within(centre.x(), half.x(), {-margin, width + margin});
            const Span down = pixels_within(centre.y(), half.y(), {0, height});
            if (across.first == across.last || down.first == down.last) continue;
            placed.push_back({item.shape.get(), item.reflectance, centre, across, down});
        }
        return placed;
    }

    std::vector<PlacedGlare> place_glare(double s_mm, int margin) const {
        const auto profile = [](Span pixels, double centre, double radius, double peak) {
            std::vector<float> values;
            for (int k = pixels.first; k < pixels.last; ++k) {
                const double x = (k - centre) / radius;
                values.push_back(static_cast<float>(peak * std::exp(-0.5 * x * x)));
            }
            return values;
        };
        std::vector<PlacedGlare> placed;
        for (const Glare& spot : options.glare) {
            constexpr double reach_in_radii = 6.0;
            const Eigen::Vector2d centre = map.place(spot.centre_mm, s_mm);
            const double radius = map.length_px(spot.radius_mm), half = reach_in_radii * radius;
            const Span across = pixels_within(centre.x(), half, {-margin, width + margin});
            const Span down = pixels_within(centre.y(), half, {0, height});
            if (across.first == across.last || down.first == down.last) continue;
            placed.push_back({across, down, profile(across, centre.x(), radius, 1.0),
                              profile(down, centre.y(), radius, spot.strength)});
        }
        return placed;
    }

    ViewOptions options;
    int width, height;
    float paper;
    view::ImageMap map;
    std::vector<Item> items;
    std::vector<float> white_grey;  ///< light field
    view::Sensor sensor;
    view::NormalRow normal_row;
};

PlateView::PlateView(const CameraParameters& camera, const Plate& plate, const ViewOptions& options)
    : impl_(std::make_unique<const Impl>(camera, plate, options)) {}
PlateView::~PlateView() = default;
PlateView::PlateView(PlateView&&) noexcept = default;
PlateView& PlateView::operator=(PlateView&&) noexcept = default;

cv::Mat PlateView::render(std::span<const double> s_mm, std::uint64_t frame) const {
    const Impl& self = *impl_;
    const double mean_s_mm = view::mean_position(s_mm);
    std::vector<double> shifts_px;
    for (const double s : s_mm) shifts_px.push_back(self.map.shift_px(s - mean_s_mm));
    const view::MotionKernel motion(shifts_px);
    const int margin = motion.reach();
    const std::vector<Placed> placed = self.place_items(mean_s_mm, margin);
    const std::vector<PlacedGlare> glare = self.place_glare(mean_s_mm, margin);

    cv::Mat image(self.height, self.width, CV_8UC1);
    ReflectanceRow reflectance(self.width, margin, self.paper);
    std::vector<float> mean(self.width), normals(self.width);
    NoiseStream noise(self.options.seed, "pixel_noise");
    for (int v = 0; v < self.height; ++v) {
        reflectance.clear();
        for (const Placed& item : placed) {
            if (item.down.contains(v)) reflectance.paint(item, v);
        }
        for (const PlacedGlare& spot : glare) {
            if (spot.down.contains(v)) reflectance.add(spot, v);
        }
        reflectance.average(motion, mean);
        const float* const white_grey = self.white_grey.data() + static_cast<std::size_t>(v) * self.width;
        for (int u = 0; u < self.width; ++u) mean[u] *= white_grey[u];
        const std::span<std::uint8_t> grey(image.ptr<std::uint8_t>(v), static_cast<std::size_t>(self.width));
        if (self.options.noise) {
            noise.seek((frame * self.height + v) * view::NormalRow::draws_from_stream);
            self.normal_row.fill(noise, normals);
            self.sensor.expose(mean, normals, grey);
        } else {
            view::Sensor::expose(mean, grey);
        }
    }
    return image;
}

}  // namespace fidservo::plant

// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/tag_picture.h"

#include "core/camera/camera_parameters.h"
#include "core/demand.h"
#include "core/fiducial_parameters.h"
#include "core/tag_families.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace fidservo::reference {
namespace {

constexpr int cells = 8;
constexpr double paper = 0.9, ink = 0.1, white = 255.0;
/// The nominal rig's illumination, relative to the image's centre: slopes along u and v from the centre to
/// the edge of the image, and the fraction by which the corners are darker.
constexpr double lamp_u = 0.08, lamp_v = -0.03, lamp_corners = 0.06;

using Shares = Eigen::Matrix<double, Eigen::Dynamic, cells>;

/// Integral of the normal distribution function of deviation s from minus infinity up to z.
double integral_of_edge(double z, double s) {
    const double x = z / s;
    return 0.5 * z * std::erfc(-x / std::numbers::sqrt2) +
           s * std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

/// Mean over the pixel of an edge at a place beyond which there is 1, seen through a lens.
double beyond(double pixel, double edge_px, double lens_px) {
    const double low = pixel - 0.5 - edge_px, high = pixel + 0.5 - edge_px;
    return integral_of_edge(high, lens_px) - integral_of_edge(low, lens_px);
}

/// Share of the light of each of the tag's columns in each pixel's width, of those from `first` on.
void add_shares(Shares& shares, int first, double left_px, double cell_px, double lens_px, double weight) {
    const auto pixels = static_cast<int>(shares.rows());
    const auto edge_px = [&](int edge) { return left_px + edge * cell_px - first; };
    const int reach = static_cast<int>(std::ceil(7.0 * lens_px)) + 1;
    for (int cell = 0; cell < cells; ++cell) {
        const int whole_from = static_cast<int>(std::floor(edge_px(cell))) + reach,
                  whole_to = static_cast<int>(std::ceil(edge_px(cell + 1))) - reach;
        for (int k = std::max(0, whole_from - 2 * reach); k < std::min(pixels, whole_to + 2 * reach); ++k)
            shares(k, cell) +=
                k > whole_from && k < whole_to
                    ? weight
                    : weight * (beyond(k, edge_px(cell), lens_px) - beyond(k, edge_px(cell + 1), lens_px));
    }
}

/// The kernel of a blur by a disc with a given standard deviation along each axis, which is half its radius.
/// Coverages are computed in 8 x 8 parts of each pixel, which adds the variance 1/12 px^2 of a pixel; it is
/// subtracted from that of the disc.
cv::Mat disc(double deviation_px) {
    constexpr int parts = 8;
    constexpr double pixel_px2 = 1.0 / 12.0;
    const double radius_px = 2.0 * std::sqrt(std::max(deviation_px * deviation_px - pixel_px2, pixel_px2));
    const int reach = static_cast<int>(std::ceil(radius_px + 0.5));
    cv::Mat kernel(2 * reach + 1, 2 * reach + 1, CV_32F);
    for (int v = -reach; v <= reach; ++v)
        for (int u = -reach; u <= reach; ++u) {
            int inside = 0;
            for (int k = 0; k < parts * parts; ++k) {
                const int column = k % parts, row = k / parts;
                inside +=
                    std::hypot(u + (column + 0.5) / parts - 0.5, v + (row + 0.5) / parts - 0.5) < radius_px;
            }
            kernel.at<float>(v + reach, u + reach) = static_cast<float>(inside);
        }
    return kernel / cv::sum(kernel)[0];
}

bool is_disc(const ImageDepartures& departures) {
    return departures.defocus_px > 0.0 && departures.defocus_is_disc;
}

double light_at(const CameraGeometry& image, const ImageDepartures& departures, int u, int v) {
    const double x = 2.0 * u / (image.width_px - 1) - 1.0, y = 2.0 * v / (image.height_px - 1) - 1.0;
    const double from_axis = x * x + y * y;
    const double falloff = 1.0 / std::pow(1.0 + 0.25 * departures.light_falloff * from_axis, 2);
    return (1.0 + (lamp_u + departures.light_u) * x + (lamp_v + departures.light_v) * y) *
           (1.0 - 0.5 * lamp_corners * from_axis) * falloff;
}

struct NearestTag {
    int id;
    Eigen::Vector2d centre_px;
};

NearestTag nearest_tag(const PictureModel& model, double s_mm, double px_per_mm) {
    const FiducialParameters& grid = model.fiducials;
    const int column = std::clamp(static_cast<int>(std::lround(s_mm / grid.pitch_x_mm)), 0, grid.columns - 1);
    return {grid.first_id + column, model.camera.geometry.principal_point_px +
                                        Eigen::Vector2d(px_per_mm * (grid.pitch_x_mm * column - s_mm), 0.0)};
}

}  // namespace

TagCells usual_cells(int tag_id) {
    const TagPattern pattern = tag_pattern({}, tag_id);
    TagCells black;
    std::size_t next = 0;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) black(row, column) = pattern[next++] ? 0.0 : 1.0;
    return black;
}

cv::Mat pixel_gains(const PictureModel& model, std::uint64_t seed) {
    const double spread = std::hypot(model.departures.gain_spread, model.camera.gain_spread);
    if (spread == 0.0) return {};
    const CameraGeometry& image = model.camera.geometry;
    NoiseStream draw(seed, "reference/gains");
    cv::Mat gains(image.height_px, image.width_px, CV_32F);
    for (int v = 0; v < gains.rows; ++v)
        for (int u = 0; u < gains.cols; ++u)
            gains.at<float>(v, u) = static_cast<float>(1.0 + spread * draw.normal());
    return gains;
}

Picture picture_of(const PictureModel& model, const CameraWay& s_mm, const cv::Mat& gains,
                   NoiseStream& noise) {
    constexpr double most_sub_steps = 16.0, sub_steps_per_px = 4.0;
    constexpr double margin = 0.18;  // of the tag's side, beyond it
    const CameraParameters& camera = model.camera;
    const CameraGeometry& image = camera.geometry;
    FIDSERVO_DEMAND(image.rotation_rad == 0.0 && image.tilt_rad.isZero(0.0));
    const double px_per_mm = image.focal_px / image.distance_mm;
    const double side_px = px_per_mm * model.fiducials.side_mm, cell_px = side_px / cells;
    const double middle_mm = s_mm(0.0);
    const NearestTag tag = nearest_tag(model, middle_mm, px_per_mm);
    const int reach = static_cast<int>(std::ceil((0.5 + margin) * side_px));
    const cv::Rect whole(0, 0, image.width_px, image.height_px);
    const cv::Rect region = cv::Rect(static_cast<int>(tag.centre_px.x()) - reach,
                                     static_cast<int>(tag.centre_px.y()) - reach, 2 * reach, 2 * reach) &
                            whole;
    Picture picture{
        cv::Mat(image.height_px, image.width_px, CV_8UC1, cv::Scalar(static_cast<int>(paper * white))),
        region};
    if (region.empty()) return picture;

    const double lens_px =
        is_disc(model.departures) ? camera.blur_px : std::hypot(camera.blur_px, model.departures.defocus_px);
    Shares rows = Shares::Zero(region.height, cells);
    add_shares(rows, region.y, tag.centre_px.y() - 0.5 * side_px, cell_px, lens_px, 1.0);
    const Shares black_of_row = rows * model.cells(tag.id);  // by column of the tag
    const double exposure_s = camera.exposure_s + model.departures.extra_exposure_s;
    Shares columns(region.width, cells);
    const auto expose = [&](double row_s) {
        const double way_px =
            px_per_mm * std::abs(s_mm(row_s + 0.5 * exposure_s) - s_mm(row_s - 0.5 * exposure_s));
        const int sub_steps =
            static_cast<int>(std::min(most_sub_steps, 1.0 + std::ceil(sub_steps_per_px * way_px)));
        columns.setZero();
        for (int k = 0; k < sub_steps; ++k) {
            const double after_s = row_s + exposure_s * ((k + 0.5) / sub_steps - 0.5);
            const double centre_px = tag.centre_px.x() - px_per_mm * (s_mm(after_s) - middle_mm);
            add_shares(columns, region.x, centre_px - 0.5 * side_px, cell_px, lens_px, 1.0 / sub_steps);
        }
    };
    expose(0.0);
    cv::Mat seen(region.height, region.width, CV_32F);
    for (int v = 0; v < region.height; ++v) {
        if (model.departures.readout_s != 0.0)
            expose(model.departures.readout_s *
                   (static_cast<double>(region.y + v) / (image.height_px - 1) - 0.5));
        const Eigen::VectorXd black = columns * black_of_row.row(v).transpose();
        for (int u = 0; u < region.width; ++u)
            seen.at<float>(v, u) = static_cast<float>(paper + (ink - paper) * black(u));
    }
    if (is_disc(model.departures))
        cv::filter2D(seen, seen, -1, disc(model.departures.defocus_px), {-1, -1}, 0.0, cv::BORDER_REPLICATE);

    const double grey_per_e = white / camera.full_well_e;
    const double read_e = std::hypot(camera.read_noise_e, model.departures.read_noise_e);
    for (int v = 0; v < region.height; ++v)
        for (int u = 0; u < region.width; ++u) {
            const int at_u = region.x + u, at_v = region.y + v;
            const double gain = gains.empty() ? 1.0 : static_cast<double>(gains.at<float>(at_v, at_u));
            const double electrons = gain * static_cast<double>(seen.at<float>(v, u)) * camera.full_well_e *
                                     light_at(image, model.departures, at_u, at_v);
            const double noisy = electrons + std::hypot(std::sqrt(electrons), read_e) * noise.normal();
            picture.image.at<unsigned char>(at_v, at_u) =
                cv::saturate_cast<unsigned char>(grey_per_e * noisy);
        }
    return picture;
}

}  // namespace fidservo::reference

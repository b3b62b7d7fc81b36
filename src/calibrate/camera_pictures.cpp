// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/camera_pictures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr double drawn_width = 720.0;

/// From image px to the drawing.
struct Drawing {
    double scale, height;
    explicit Drawing(const CameraGeometry& camera)
        : scale(drawn_width / camera.width_px), height(scale * camera.height_px) {}
    Eigen::Vector2d operator()(const Eigen::Vector2d& image_px) const {
        return scale * (image_px + Eigen::Vector2d(0.5, 0.5));
    }
    std::string opening(const std::string& description) const {
        return fmt::format(
            "<svg class=\"chart\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" aria-label=\"{}\">"
            "<rect x=\"0.5\" y=\"0.5\" width=\"{:.0f}\" height=\"{:.0f}\" "
            "style=\"fill:none\" stroke=\"currentColor\"/>",
            drawn_width, height, description, drawn_width - 1.0, height - 1.0);
    }
};

template <class Visit>
void each_corner(const calib::CameraCalibration& calibration, Visit visit) {
    for (const calib::ViewFit& view : calibration.views)
        for (const calib::SightResidual& tag : view.tags)
            if (tag.used)
                for (std::size_t k = 0; k < 4; ++k) visit(tag.seen_px[k], tag.error_px[k]);
}

}  // namespace

std::string coverage_svg(const calib::CameraCalibration& calibration, const calib::Coverage& coverage) {
    using calib::Coverage;
    const Drawing at(calibration.camera);
    std::string svg = at.opening("Corners seen, over the image");
    const double width = drawn_width / Coverage::columns, height = at.height / Coverage::rows;
    for (int row = 0; row < Coverage::rows; ++row)
        for (int column = 0; column < Coverage::columns; ++column)
            if (coverage.corners[row * Coverage::columns + column] == 0)
                svg += fmt::format(
                    "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                    "style=\"fill:currentColor\" opacity=\"0.15\"><title>no corner here</title></rect>",
                    column * width, row * height, width, height);
    svg += "<g fill=\"currentColor\" opacity=\"0.6\">";
    each_corner(calibration, [&](const Eigen::Vector2d& seen, const Eigen::Vector2d&) {
        const Eigen::Vector2d place = at(seen);
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.4\"/>", place.x(), place.y());
    });
    return svg +
           fmt::format("</g></svg><p>Corners in {:.0f} % of the {} x {} cells; the shaded ones saw none.</p>",
                       100.0 * coverage.share, Coverage::columns, Coverage::rows);
}

std::string residual_field_svg(const calib::CameraCalibration& calibration) {
    constexpr int columns = 16, rows = 12;
    const Drawing at(calibration.camera);
    struct Cell {
        Eigen::Vector2d place = Eigen::Vector2d::Zero(), error = Eigen::Vector2d::Zero();
        double count = 0.0;
    };
    std::vector<Cell> cells(columns * rows);
    each_corner(calibration, [&](const Eigen::Vector2d& seen, const Eigen::Vector2d& error) {
        const Eigen::Vector2d place = at(seen);
        const int column = std::clamp(static_cast<int>(place.x() / drawn_width * columns), 0, columns - 1);
        const int row = std::clamp(static_cast<int>(place.y() / at.height * rows), 0, rows - 1);
        Cell& cell = cells[row * columns + column];
        cell.place += place;
        cell.error += error;
        cell.count += 1.0;
    });
    double longest = 1e-12;
    for (Cell& cell : cells) {
        if (cell.count == 0.0) continue;
        cell.place /= cell.count;
        cell.error /= cell.count;
        longest = std::max(longest, cell.error.norm());
    }
    const double magnification = 0.8 * drawn_width / columns / longest;
    std::string svg = at.opening("Mean residuals over the image, magnified");
    svg += "<g stroke=\"currentColor\" fill=\"currentColor\">";
    for (const Cell& cell : cells) {
        if (cell.count == 0.0) continue;
        const Eigen::Vector2d tip = cell.place + magnification * cell.error;
        svg += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.6\"/><line x1=\"{:.1f}\" y1=\"{:.1f}\" "
            "x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
            cell.place.x(), cell.place.y(), cell.place.x(), cell.place.y(), tip.x(), tip.y());
    }
    return svg + fmt::format(
                     "</g></svg><p>Mean residual of the corners in each cell; the longest is {:.3g} px.</p>",
                     longest);
}

}  // namespace fidservo

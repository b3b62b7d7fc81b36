// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage of every shape against brute force: 32 x 32 samples a pixel, then a Gaussian.
#include "plant/view/cell_grid.h"
#include "plant/view/disc.h"
#include "plant/view/edge_profile.h"
#include "plant/view/gaussian.h"
#include "plant/view/scratch_path.h"
#include "plant/view/tag_code.h"

#include <functional>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace fidservo::plant::view {
namespace {

constexpr double blur_px = 0.8;
constexpr double full_scale_fraction = 0.004;  // mostly the error of the brute force

using Inside = std::function<bool(const Eigen::Vector2d&)>;
using Painted = std::function<void(double, double, std::span<float>)>;

/// Pixel means of a blurred shape, in a square of pixels whose first is at `first`. Samples 1/32 px apart;
/// the blur and the pixel's box are one separable kernel on them.
class BruteForce {
  public:
    BruteForce(const Inside& inside, const Eigen::Vector2d& first, int pixels) : pixels_(pixels) {
        std::vector<double> kernel;
        for (int k = -margin * per_px; k < margin * per_px; ++k) {
            const double x = (k + 0.5) / per_px;
            kernel.push_back(normal_cdf((x + 0.5) / blur_px) - normal_cdf((x - 0.5) / blur_px));
        }
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        for (double& weight : kernel) weight /= sum;
        const int side = (pixels - 1 + 2 * margin) * per_px;
        const auto place = [&](double start, int k) { return start - margin + (k + 0.5) / per_px; };
        std::vector<double> rows(static_cast<std::size_t>(side) * pixels);  // filtered in u
        std::vector<double> line(side);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                line[x] = inside({place(first.x(), x), place(first.y(), y)}) ? 1.0 : 0.0;
            }
            for (int u = 0; u < pixels; ++u) {
                rows[static_cast<std::size_t>(y) * pixels + u] =
                    std::inner_product(kernel.begin(), kernel.end(),
                                       line.begin() + static_cast<std::ptrdiff_t>(u) * per_px, 0.0);
            }
        }
        for (int v = 0; v < pixels; ++v) {
            for (int u = 0; u < pixels; ++u) {
                double mean = 0.0;
                for (std::size_t k = 0; k < kernel.size(); ++k) {
                    mean += kernel[k] * rows[(static_cast<std::size_t>(v) * per_px + k) * pixels + u];
                }
                means_.push_back(mean);
            }
        }
    }
    double at(int u, int v) const { return means_[static_cast<std::size_t>(v) * pixels_ + u]; }

  private:
    static constexpr int per_px = 32, margin = 5;
    int pixels_;
    std::vector<double> means_;
};

void expect_like_brute_force(const Painted& painted, const Inside& inside, const Eigen::Vector2d& middle,
                             const std::string& name) {
    constexpr int pixels = 24;
    const Eigen::Vector2d first = middle - Eigen::Vector2d::Constant(0.5 * (pixels - 1));
    const BruteForce truth(inside, first, pixels);
    double worst = 0.0, extent = 0.0;
    std::vector<float> row(pixels);
    for (int v = 0; v < pixels; ++v) {
        painted(first.x(), first.y() + v, row);
        for (int u = 0; u < pixels; ++u) {
            worst = std::max(worst, std::abs(row[u] - truth.at(u, v)));
            extent = std::max(extent, truth.at(u, v) * (1.0 - truth.at(u, v)));
        }
    }
    EXPECT_LT(worst, full_scale_fraction) << name;
    EXPECT_GT(extent, 0.05) << name << ": there is no edge in the window";
}

std::shared_ptr<const EdgeProfile> edge_at(double angle) {
    return std::make_shared<EdgeProfile>(EdgeProfile::of_pixel(blur_px, angle));
}

TEST(CellGrid, UprightAndTurned_CoversLikeBruteForce) {
    const CellPattern tag = printed_tag({17, {0.0, 0.0}, 1.0}).pattern;
    for (const double angle : {0.0, 0.0122, 0.4, 0.75, -1.2, M_PI / 2, 3.0}) {
        for (const double cell_px : {37.5, 6.0}) {
            const Eigen::Vector2d size = Eigen::Vector2d::Constant(8 * cell_px);
            const CellGrid grid(tag, size, angle, edge_at(angle));
            const Eigen::Rotation2Dd turn(angle);
            const Inside inside = [&](const Eigen::Vector2d& place) {
                const Eigen::Vector2d cell = (turn.inverse() * place + 0.5 * size) / cell_px;
                if (cell.minCoeff() < 0.0 || cell.maxCoeff() >= 8.0) return false;
                return tag.inked[static_cast<int>(cell.y()) * 8 + static_cast<int>(cell.x())] != 0;
            };
            const Painted painted = [&](double du, double dv, std::span<float> row) {
                grid.cover(du, dv, row);
            };
            const std::string name = std::to_string(cell_px) + " px cells at " + std::to_string(angle);
            expect_like_brute_force(painted, inside,
                                    turn * Eigen::Vector2d(-4 * cell_px + 0.3125, -4 * cell_px),
                                    "corner, " + name);
            expect_like_brute_force(painted, inside, turn * Eigen::Vector2d(-cell_px, 0.21875),
                                    "bits, " + name);
        }
    }
}

TEST(CellGrid, ThinLine_CoversLikeBruteForce) {
    const double angle = 0.35;
    const Eigen::Vector2d size(60.0, 1.5);
    const CellGrid line({}, size, angle, edge_at(angle));
    const Inside inside = [&](const Eigen::Vector2d& place) {
        const Eigen::Vector2d own = Eigen::Rotation2Dd(-angle) * place;
        return std::abs(own.x()) < 30.0 && std::abs(own.y()) < 0.75;
    };
    const Painted painted = [&](double du, double dv, std::span<float> row) { line.cover(du, dv, row); };
    expect_like_brute_force(painted, inside, {0.1, 0.2}, "line");
    expect_like_brute_force(painted, inside, Eigen::Rotation2Dd(angle) * Eigen::Vector2d(30, 0), "line end");
}

TEST(Disc, LargeAndSmallAgainstTheBlur_CoversLikeBruteForce) {
    for (const double diameter : {0.7, 2.0, 8.0, 100.0}) {
        const Disc disc(diameter, blur_with_pixel_px(blur_px));
        const Inside inside = [&](const Eigen::Vector2d& place) { return place.norm() < 0.5 * diameter; };
        const Painted painted = [&](double du, double dv, std::span<float> row) { disc.cover(du, dv, row); };
        const Eigen::Vector2d middle = diameter < 20
                                           ? Eigen::Vector2d(0.3, 0.1)
                                           : Eigen::Vector2d(0.5 * diameter * Eigen::Vector2d(0.8, 0.6));
        expect_like_brute_force(painted, inside, middle, "disc of " + std::to_string(diameter) + " px");
    }
}

/// Distance-free definition of a mitred path: the union of the quadrilaterals between the cuts.
bool in_mitred_path(const std::vector<Eigen::Vector2d>& points, double width, const Eigen::Vector2d& place) {
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Eigen::Vector2d along = (points[k + 1] - points[k]).normalized();
        const auto cut_at = [&](std::size_t point) -> Eigen::Vector2d {
            if (point == 0 || point + 1 == points.size()) return points[k + 1] - points[k];
            return (points[point] - points[point - 1]).normalized() +
                   (points[point + 1] - points[point]).normalized();
        };
        const Eigen::Vector2d from = place - points[k], to = place - points[k + 1];
        const double offset = along.x() * from.y() - along.y() * from.x();
        if (std::abs(offset) < 0.5 * width && cut_at(k).dot(from) > 0 && cut_at(k + 1).dot(to) < 0)
            return true;
    }
    return false;
}

TEST(ScratchPath, StraightBendsAndEnds_CoverLikeBruteForce) {
    for (const double width : {1.0, 4.0, 12.0}) {
        const std::vector<Eigen::Vector2d> points = {{-60, -11}, {-20, 3}, {15.2, 0.4}, {10, 40}};
        const ScratchPath path(points, width, blur_with_pixel_px(blur_px));
        const Inside inside = [&](const Eigen::Vector2d& place) {
            return in_mitred_path(points, width, place);
        };
        const Painted painted = [&](double du, double dv, std::span<float> row) { path.cover(du, dv, row); };
        const std::string name = " of a scratch of " + std::to_string(width) + " px";
        expect_like_brute_force(painted, inside, {-40, -4}, "straight" + name);
        expect_like_brute_force(painted, inside, points[0], "end" + name);
        expect_like_brute_force(painted, inside, points[1], "bend" + name);
        expect_like_brute_force(painted, inside, points[2], "sharp bend" + name);
    }
}

TEST(CellGrid, PaintedInARun_IsTheSameAsPixelByPixel) {
    const CellPattern tag = printed_tag({99, {0.0, 0.0}, 1.0}).pattern;
    for (const double angle : {0.0, 1e-9, -0.0122, M_PI / 4, M_PI / 2, 2.5, M_PI}) {
        for (const double side_px : {300.0, 40.0, 12.3}) {
            const CellGrid grid(tag, {side_px, side_px}, angle, edge_at(angle));
            const auto half = static_cast<int>(grid.half_extent_px().x()) + 3;
            std::vector<float> run(2 * static_cast<std::size_t>(half)), single(1);
            for (double dv = -half; dv < half; dv += 0.05 * side_px) {
                grid.cover(-half, dv, run);
                for (int u = 0; u < 2 * half; ++u) {
                    grid.cover(u - half, dv, single);
                    ASSERT_NEAR(run[u], single[0], 1e-5) << angle << ' ' << side_px << ' ' << u << ' ' << dv;
                }
            }
        }
    }
}

/// Centre of coverage in u, px, of a shape whose centre is at (shift, 0.3).
double centroid_u(const Painted& painted, double shift) {
    constexpr int half = 40;
    std::vector<float> row(2 * half + 1);
    double sum = 0.0, moment = 0.0;
    for (int v = -half; v <= half; ++v) {
        painted(-half - shift, v - 0.3, row);
        for (int u = -half; u <= half; ++u) {
            sum += row[u + half];
            moment += u * static_cast<double>(row[u + half]);
        }
    }
    return moment / sum;
}

TEST(Shapes, CentreOfCoverage_FollowsTheShiftWithoutAGridHarmonic) {
    const Disc disc(30.0, blur_with_pixel_px(blur_px));
    const CellGrid pad({}, {30.0, 20.0}, 0.3, edge_at(0.3)), upright({}, {30.0, 20.0}, 0.0, edge_at(0.0));
    const std::vector<Eigen::Vector2d> points = {{-15, -6}, {15, 6}};
    const ScratchPath scratch(points, 4.0, blur_with_pixel_px(blur_px));
    for (int k = 0; k < 40; ++k) {
        const double shift = 0.37 * k / 10.0;
        const auto expect_at_shift = [&](const auto& shape) {
            const Painted painted = [&](double du, double dv, std::span<float> row) {
                shape.cover(du, dv, row);
            };
            EXPECT_NEAR(centroid_u(painted, shift), shift, 3e-5);
        };
        expect_at_shift(disc);
        expect_at_shift(pad);
        expect_at_shift(upright);
        expect_at_shift(scratch);
    }
}

TEST(EdgeProfile, WithoutBlur_IsTheAreaOfThePixelBehindTheEdge) {
    const EdgeProfile upright = EdgeProfile::of_pixel(0.0, 0.0);
    EXPECT_NEAR(upright(0.25), 0.75, 1e-12);
    EXPECT_EQ(upright(-0.6), 0.0);
    EXPECT_EQ(upright(0.6), 1.0);
    // Seen along its diagonal the pixel is a triangle: the part beyond d has area (1/sqrt 2 - d)^2.
    const EdgeProfile diagonal = EdgeProfile::of_pixel(0.0, M_PI / 4);
    EXPECT_NEAR(diagonal(0.3), 1.0 - std::pow(std::sqrt(0.5) - 0.3, 2), 1e-4);
}

TEST(BivariateNormal, AtTheOrigin_IsSheppardsFormula) {
    for (const double rho : {-0.87, -0.3, 0.0, 0.5, 0.87}) {
        EXPECT_NEAR(bivariate_normal_cdf(0.0, 0.0, rho), 0.25 + std::asin(rho) / (2.0 * M_PI), 1e-8) << rho;
    }
}

}  // namespace
}  // namespace fidservo::plant::view

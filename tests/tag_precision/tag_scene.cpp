// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/tag_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <opencv2/core.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

namespace fidservo::precision {
namespace {

constexpr int cells = 8;

/// Whether each of the tag's 8 x 8 cells is black, as the library draws them; its own picture has a white
/// rim.
std::array<std::array<bool, cells>, cells> black_cells(int tag_id) {
    apriltag_family_t* family = tag36h11_create();
    image_u8_t* drawn = apriltag_to_image(family, tag_id);
    std::array<std::array<bool, cells>, cells> black;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column)
            black.at(row).at(column) = drawn->buf[(row + 1) * drawn->stride + column + 1] < 128;
    std::free(drawn->buf);
    std::free(drawn);
    tag36h11_destroy(family);
    return black;
}

/// Ink that spreads: lines at both ends of every cell's growth, and what lies between them.
class InkGrid {
  public:
    explicit InkGrid(const TagScene& scene) : black_(black_cells(scene.tag_id)) {
        const double spread = scene.ink_spread_px / scene.side_px;
        for (int k = 0; k <= cells; ++k) {
            const double line = static_cast<double>(k) / cells - 0.5;
            lines_.push_back(line - spread);
            if (spread > 0.0) lines_.push_back(line + spread);
        }
        spread_ = spread;
    }

    int count() const { return static_cast<int>(lines_.size()); }
    double line(int k) const { return lines_.at(static_cast<std::size_t>(k)); }

    /// Between line `column` and the next, and line `row` and the next; outside the lines it is white.
    bool is_black(int row, int column) const {
        if (row < 0 || column < 0 || row + 1 >= count() || column + 1 >= count()) return false;
        const double x = 0.5 * (line(column) + line(column + 1)), y = 0.5 * (line(row) + line(row + 1));
        for (const double dy : {-spread_, spread_})
            for (const double dx : {-spread_, spread_})
                if (cell_is_black(y + dy, x + dx)) return true;
        return false;
    }

  private:
    bool cell_is_black(double y, double x) const {
        const int row = static_cast<int>(std::floor((y + 0.5) * cells));
        const int column = static_cast<int>(std::floor((x + 0.5) * cells));
        return row >= 0 && row < cells && column >= 0 && column < cells && black_.at(row).at(column);
    }

    std::array<std::array<bool, cells>, cells> black_;
    std::vector<double> lines_;
    double spread_ = 0.0;
};

/// A straight line on the tag as the camera shows it: with a distorting lens it is a curve, in steps of a
/// pixel.
void append_line(const TagScene& scene, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                 std::vector<BoundaryEdge>& edges) {
    const bool curved = !scene.camera.distortion.is_none();
    const int steps =
        curved ? std::max(1, static_cast<int>(std::ceil((to - from).norm() * scene.side_px))) : 1;
    Eigen::Vector2d last = image_of(scene, from);
    for (int k = 1; k <= steps; ++k) {
        const Eigen::Vector2d next = image_of(scene, from + (to - from) * (static_cast<double>(k) / steps));
        edges.push_back({last, next});
        last = next;
    }
}

/// Every stretch of line with ink on one side only, ink on the right hand.
std::vector<BoundaryEdge> ink_edges(const TagScene& scene) {
    const InkGrid ink(scene);
    std::vector<BoundaryEdge> edges;
    for (int line = 0; line < ink.count(); ++line) {
        const double at = ink.line(line);
        for (const bool upright : {true, false}) {
            const auto side_of = [&](int k) {
                const bool before = upright ? ink.is_black(k, line - 1) : ink.is_black(line - 1, k);
                const bool after = upright ? ink.is_black(k, line) : ink.is_black(line, k);
                return static_cast<int>(after) - static_cast<int>(before);
            };
            for (int k = 0; k + 1 < ink.count();) {
                const int side = side_of(k);
                int end = k + 1;
                while (end + 1 < ink.count() && side_of(end) == side) ++end;
                if (side != 0) {
                    Eigen::Vector2d from(at, ink.line(k)), to(at, ink.line(end));
                    if (!upright) {
                        from = {ink.line(k), at};
                        to = {ink.line(end), at};
                    }
                    const bool forward = upright ? side < 0 : side > 0;
                    if (!forward) std::swap(from, to);
                    append_line(scene, from, to, edges);
                }
                k = end;
            }
        }
    }
    return edges;
}

cv::Mat1d cover_picture(const TagScene& scene) {
    std::vector<BoundaryEdge> edges;
    const auto& outline = scene.cover->outline;
    for (std::size_t k = 0; k < outline.size(); ++k)
        append_line(scene, outline[k], outline[(k + 1) % outline.size()], edges);
    return coverage(edges, scene.blur, scene.size_px());
}

cv::Mat1d glare_picture(const TagScene& scene) {
    const Eigen::Vector2d at_px = image_of(scene, scene.glare->at);
    cv::Mat1d light(scene.size_px());
    for (int v = 0; v < light.rows; ++v)
        for (int u = 0; u < light.cols; ++u) {
            const double r = (Eigen::Vector2d(u, v) - at_px).norm() / scene.glare->radius_px;
            light(v, u) = scene.glare->level * std::exp(-0.5 * r * r);
        }
    return light;
}

double light_at(const TagScene& scene, int u, int v) {
    const double half = 0.5 * scene.camera.width_px;
    const Eigen::Vector2d r = (Eigen::Vector2d(u, v) - Eigen::Vector2d(0.5 * (scene.camera.width_px - 1),
                                                                       0.5 * (scene.camera.height_px - 1))) /
                              half;
    const Illumination& light = scene.illumination;
    return light.level * (1.0 + light.gradient.dot(r) + light.vignetting * r.squaredNorm());
}

}  // namespace

Eigen::Vector2d image_of(const TagScene& scene, const Eigen::Vector2d& on_tag) {
    const Eigen::Vector2d centre_mm = back_project(scene.camera, scene.centre_px, 0.0);
    const double side_mm = scene.side_px * mm_per_px(scene.camera);
    const double c = std::cos(scene.angle_rad), s = std::sin(scene.angle_rad);
    const Eigen::Vector2d turned(c * on_tag.x() - s * on_tag.y(), s * on_tag.x() + c * on_tag.y());
    return project(scene.camera, centre_mm + side_mm * turned, 0.0);
}

std::array<Eigen::Vector2d, 4> corners_of(const TagScene& scene) {
    return {image_of(scene, {-0.5, 0.5}), image_of(scene, {0.5, 0.5}), image_of(scene, {0.5, -0.5}),
            image_of(scene, {-0.5, -0.5})};
}

cv::Mat1d ink_picture(const TagScene& scene) {
    return coverage(ink_edges(scene), scene.blur, scene.size_px());
}

cv::Mat1d mean_picture(const TagScene& scene) {
    cv::Mat1d picture = ink_picture(scene);
    for (int v = 0; v < picture.rows; ++v)
        for (int u = 0; u < picture.cols; ++u)
            picture(v, u) =
                light_at(scene, u, v) * (scene.white - (scene.white - scene.black) * picture(v, u));
    if (scene.cover) {
        const cv::Mat1d share = cover_picture(scene);
        picture += cv::Mat1d(share.mul(scene.cover->level - picture));
    }
    if (scene.glare) picture += glare_picture(scene);
    return picture;
}

cv::Mat1b undamaged(const TagScene& scene) {
    constexpr double grey_level = 1.0 / 255.0;
    cv::Mat1b mask(scene.size_px(), 255);
    if (scene.cover) mask.setTo(0, cover_picture(scene) > grey_level);
    if (scene.glare) mask.setTo(0, glare_picture(scene) > grey_level);
    return mask;
}

}  // namespace fidservo::precision

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_appearance.h"

#include "core/normal_equations.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fidservo::vision {
namespace {

/// A side as pixel lines that cross it: rows where it is upright in the image, columns where it is level.
class SideCrossing {
  public:
    /// @param reach_px  across the side, within which all is sampled
    SideCrossing(const cv::Mat& image, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                 const Eigen::Vector2d& outward, double reach_px)
        : image_(image), from_px_(from_px), way_px_(to_px - from_px) {
        constexpr double of_corners = 0.12;  // left out of the side at either end
        normal_ = Eigen::Vector2d(way_px_.y(), -way_px_.x()).normalized();
        if (normal_.dot(outward) < 0.0) normal_ = -normal_;
        across_ = std::abs(normal_.x()) >= std::abs(normal_.y()) ? 0 : 1;
        outward_ = normal_[across_] > 0.0 ? 1 : -1;
        const double tangent = std::abs(normal_[1 - across_] / normal_[across_]);
        const double left_out = of_corners + tangent * reach_px / way_px_.norm();
        const double a = from_px[1 - across_] + left_out * way_px_[1 - across_],
                     b = from_px[1 - across_] + (1.0 - left_out) * way_px_[1 - across_];
        first_ = static_cast<int>(std::ceil(std::min(a, b)));
        last_ = static_cast<int>(std::floor(std::max(a, b)));
    }

    int lines() const { return last_ - first_ + 1; }
    /// Of the angle from a line to the normal of an edge that is turned from the side's by a slope.
    double cosine(double slope = 0.0) const { return std::abs(turned_normal(slope)[across_]); }
    double half_length() const { return 0.5 * (last_ - first_); }

    /// Where the side crosses a line, in px across.
    double edge_px(int line) const {
        const double share = (first_ + line - from_px_[1 - across_]) / way_px_[1 - across_];
        return from_px_[across_] + share * way_px_[across_];
    }
    /// The pixel next to the edge.
    int nearest_px(int line) const { return static_cast<int>(std::lround(edge_px(line))); }
    /// From the edge to pixel `step` of a line, counted outward from the one next to the edge, px.
    double way_px(int line, int step) const { return step + outward_ * (nearest_px(line) - edge_px(line)); }

    /// Demands lies_within(step) of all that is asked for.
    double grey(int line, int step) const {
        const int place = nearest_px(line) + outward_ * step, other = first_ + line;
        return across_ == 0 ? image_.at<unsigned char>(other, place) : image_.at<unsigned char>(place, other);
    }

    bool lies_within(int reach) const {
        const int width = across_ == 0 ? image_.cols : image_.rows,
                  height = across_ == 0 ? image_.rows : image_.cols;
        const int a = nearest_px(0), b = nearest_px(lines() - 1);
        return first_ >= 0 && last_ < height && std::min(a, b) - reach >= 0 && std::max(a, b) + reach < width;
    }

    /// A place in the image, px.
    Eigen::Vector2d place_px(double line, double outward_px) const {
        Eigen::Vector2d place;
        const double share = (first_ + line - from_px_[1 - across_]) / way_px_[1 - across_];
        place[1 - across_] = first_ + line;
        place[across_] = from_px_[across_] + share * way_px_[across_] + outward_ * outward_px;
        return place;
    }

    /// The normal of an edge that is turned from the side's by a slope, px across per line.
    Eigen::Vector2d turned_normal(double slope) const {
        Eigen::Vector2d turned;
        turned[across_] = outward_;
        turned[1 - across_] = -outward_ * (way_px_[across_] / way_px_[1 - across_] + outward_ * slope);
        return turned.normalized();
    }

  private:
    const cv::Mat& image_;
    Eigen::Vector2d from_px_, way_px_, normal_;
    int across_ = 0, outward_ = 1, first_ = 0, last_ = -1;
};

/// Light over a strip that runs along the side: even across it, a parabola along it.
struct BorderStrip {
    /// Grey levels: the mean, per px out, along the side, and its bend.
    Eigen::Vector4d light = Eigen::Vector4d::Zero();
    double middle_px = 0.0;       ///< outward from the pixel next to the edge
    double variance_grey2 = 0.0;  ///< about it
    double pixels = 0.0;
    bool is_saturated = false;

    Eigen::Vector4d terms(double step, double along) const {
        return {1.0, step - middle_px, along, along * along - 1.0 / 3.0};
    }
    double mean() const { return light[0]; }
    double at(double step, double along) const { return light.dot(terms(step, along)); }
};

/// From -1 to 1 along the side.
double along(const SideCrossing& side, int line) {
    return (line - side.half_length()) / side.half_length();
}

BorderStrip strip_of(const SideCrossing& side, int from, int to) {
    constexpr double most_saturated = 1.0 / 200.0;
    BorderStrip strip;
    strip.middle_px = 0.5 * (from + to);
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double squares = 0.0, saturated = 0.0;
    for (int line = 0; line < side.lines(); ++line)
        for (int step = from; step <= to; ++step) {
            const double grey = side.grey(line, step);
            const Eigen::Vector4d row = strip.terms(step, along(side, line));
            normal += row * row.transpose();
            right += grey * row;
            squares += grey * grey;
            strip.pixels += 1.0;
            saturated += grey <= 0.0 || grey >= 255.0 ? 1.0 : 0.0;
        }
    strip.light = solve_normal(normal, right);
    strip.variance_grey2 = std::max(0.0, squares - strip.light.dot(right)) / (strip.pixels - 4.0);
    strip.is_saturated = saturated > most_saturated * strip.pixels;
    return strip;
}

/// A side's edge within `half` px of the line, and the strips beyond.
struct Edge {
    BorderStrip white, black;
    double variance_px2 = not_measured, std_px2 = not_measured;
    double slope = 0.0;  ///< of the edge against the side, px across per line
};

Edge edge_of(const SideCrossing& side, int half, int width, bool white_inside) {
    constexpr double least_contrast = 20.0;            // grey levels
    const double outward = white_inside ? -1.0 : 1.0;  // from black to white
    Edge edge{strip_of(side, half + 1, half + width), strip_of(side, -half - width, -half - 1)};
    if (white_inside) std::swap(edge.white, edge.black);
    if (edge.white.is_saturated || edge.black.is_saturated ||
        edge.white.mean() - edge.black.mean() < least_contrast)
        return edge;
    const int lines = side.lines();
    std::vector<Eigen::Vector3d> moments(static_cast<std::size_t>(lines));  // of order 0, 1, 2
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int line = 0; line < lines; ++line) {
        const double at = along(side, line);
        const auto normalised = [&](int step) {
            const double black = edge.black.at(step, at), white = edge.white.at(step, at);
            return (side.grey(line, step) - black) / (white - black);
        };
        Eigen::Vector3d moment = Eigen::Vector3d::Zero();
        double before = normalised(-half);
        for (int step = -half; step < half; ++step) {
            const double after = normalised(step + 1), q = side.way_px(line, step) + 0.5;
            moment += outward * (after - before) * Eigen::Vector3d(1.0, q, q * q);
            before = after;
        }
        const Eigen::Vector3d row(1.0, at, at * at);
        normal += row * row.transpose();
        right += moment[1] * row;
        moments[static_cast<std::size_t>(line)] = moment;
    }
    const Eigen::Vector3d parabola = solve_normal(normal, right);
    double sum = 0.0;
    for (int line = 0; line < lines; ++line) {
        const double at = along(side, line), place = parabola.dot(Eigen::Vector3d(1.0, at, at * at));
        const Eigen::Vector3d& moment = moments[static_cast<std::size_t>(line)];
        sum += moment[2] - 2.0 * place * moment[1] + place * place * moment[0];
    }
    edge.slope = parabola[1] / side.half_length();
    const double square = std::pow(side.cosine(edge.slope), 2);
    edge.variance_px2 = square * (sum / lines - 1.0 / 12.0);
    const double contrast = edge.white.mean() - edge.black.mean();
    const double of_pixels =
        4.0 / 3.0 * (edge.white.variance_grey2 + edge.black.variance_grey2) * half * half * half / lines;
    const double reach = half * (half + 0.3 * width);  // of a level, as it is continued to the edge
    const double of_strips =
        reach * reach *
        (edge.white.variance_grey2 / edge.white.pixels + edge.black.variance_grey2 / edge.black.pixels);
    edge.std_px2 = square * std::sqrt(of_pixels + of_strips) / contrast;
    return edge;
}

constexpr int least_half_px = 3, least_strip_px = 4, most_strip_px = 12;

/// Px from the edge at which the strips of an edge of a variance across begin.
int half_of(double variance_px2) {
    constexpr double deviations = 3.5;
    return std::max(least_half_px,
                    static_cast<int>(std::ceil(deviations * std::sqrt(std::max(0.0, variance_px2)) + 1.0)));
}

/// Begins wide and closes in on the edge. Empty where the tag is too small, too blurred or not all visible.
std::optional<Edge> measured(const SideCrossing& side, double border_px, bool white_inside) {
    constexpr int least_lines = 12, rounds = 6;
    constexpr double likely = 2.0;  // standard deviations
    // The border holds the edge's inner half, the strip, and the blur of the code's cells.
    const auto room = static_cast<int>(0.95 * border_px / side.cosine());
    int half = (room - least_strip_px) / 2;
    if (side.lines() < least_lines || half < least_half_px || !side.lies_within(room + 1))
        return std::nullopt;
    const auto strip_px = [&](int beside) {
        return std::clamp(room - 2 * beside, least_strip_px, most_strip_px);
    };
    Edge edge = edge_of(side, half, strip_px(half), white_inside);
    const double scale = side.cosine() * side.cosine();
    for (int round = 0; round < rounds && !std::isnan(edge.variance_px2); ++round) {
        if (round == 0 && half_of(edge.variance_px2 / scale) > half) return std::nullopt;
        const int asked = half_of((edge.variance_px2 + likely * edge.std_px2) / scale);
        const int closer = std::max(asked, static_cast<int>(0.6 * half));
        if (closer >= half) break;
        half = closer;
        edge = edge_of(side, half, strip_px(half), white_inside);
    }
    return edge;
}

/// Mean over those strips that are not saturated and not much noisier than the quietest.
GreyNoiseSeen noise_of(const std::vector<const BorderStrip*>& strips) {
    constexpr double outlier = 2.0;
    double quietest = std::numeric_limits<double>::infinity();
    for (const BorderStrip* strip : strips)
        if (!strip->is_saturated) quietest = std::min(quietest, strip->variance_grey2);
    double grey = 0.0, variance = 0.0, pixels = 0.0;
    for (const BorderStrip* strip : strips) {
        if (strip->is_saturated || strip->variance_grey2 > outlier * quietest) continue;
        grey += strip->pixels * strip->mean();
        variance += strip->pixels * strip->variance_grey2;
        pixels += strip->pixels;
    }
    if (pixels == 0.0) return {};
    return {grey / pixels, variance / pixels, std::sqrt(2.0 / pixels)};
}

}  // namespace

TagAppearance tag_appearance(const cv::Mat& image, const TagDetection& tag) {
    const bool white_inside = tag_pattern(tag.print, 0).is_white_inside();
    TagAppearance seen{.time_ns = tag.time_ns, .tag_id = tag.tag_id, .sides = {}, .white = {}, .black = {}};
    Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : tag.corners_px) middle_px += 0.25 * corner;
    std::array<std::optional<Edge>, 4> edges;
    std::vector<const BorderStrip*> white, black;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d from_px = tag.corners_px[k], to_px = tag.corners_px[(k + 1) % 4];
        const double border_px =
            (to_px - from_px).norm() / tag.print.outline_cells() * tag.print.border_cells;
        const SideCrossing side(image, from_px, to_px, 0.5 * (from_px + to_px) - middle_px, border_px);
        edges[k] = measured(side, border_px, white_inside);
        if (!edges[k]) continue;
        const Edge& edge = *edges[k];
        const double middle = side.half_length();
        seen.sides[k].normal = side.turned_normal(edge.slope);
        seen.sides[k].variance_px2 = edge.variance_px2;
        seen.sides[k].variance_std_px2 = edge.std_px2;
        seen.sides[k].strip_px = side.place_px(middle, edge.white.middle_px);
        seen.sides[k].half_strip_px =
            side.place_px(2.0 * middle, edge.white.middle_px) - seen.sides[k].strip_px;
        if (!edge.white.is_saturated) {
            seen.sides[k].white_grey = edge.white.mean();
            seen.sides[k].white_std_grey = std::sqrt(edge.white.variance_grey2 / edge.white.pixels);
        }
        white.push_back(&edge.white);
        black.push_back(&edge.black);
    }
    seen.white = noise_of(white);
    seen.black = noise_of(black);
    return seen;
}

}  // namespace fidservo::vision

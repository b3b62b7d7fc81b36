// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/edge_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <Eigen/LU>

namespace fidservo::vision {
namespace {

/// 1 white, 0 black.
float white_at(const TagPattern& pattern, int column, int row) {
    const bool beside = column < 0 || column >= pattern.cells, above = row < 0 || row >= pattern.cells;
    const bool white = beside || above ? pattern.paper_is_white : pattern.is_white(row, column);
    return white ? 1.0F : 0.0F;
}

/// What lies around a code that reaches to the print's edge is not known, nor whether squares touch the
/// corners of a border of two cells, as on an AprilGrid.
bool is_known(const TagPattern& pattern, int column, int row) {
    const bool beside = column == 0 || column == pattern.cells, above = row == 0 || row == pattern.cells;
    return pattern.rim > 0 ? !beside && !above : !(beside && above) || pattern.corners_are_free;
}

/// The crossing before cell (column, row); its pixels are not known yet.
kernel::Node crossing(const TagPattern& pattern, int column, int row) {
    const float c00 = white_at(pattern, column - 1, row - 1), c10 = white_at(pattern, column, row - 1);
    const float c01 = white_at(pattern, column - 1, row), c11 = white_at(pattern, column, row);
    kernel::Node node{};
    const float half_side = 0.5F * static_cast<float>(pattern.cells);
    node.x = static_cast<float>(column) - half_side;
    node.y = static_cast<float>(row) - half_side;
    node.c = c00;
    node.cx = c10 - c00;
    node.cy = c01 - c00;
    node.cxy = c11 - c10 - c01 + c00;
    node.edge_up = std::abs(c10 - c00);
    node.edge_down = std::abs(c11 - c01);
    node.edge_left = std::abs(c01 - c00);
    node.edge_right = std::abs(c11 - c10);
    const float white = c00 + c10 + c01 + c11;
    const bool crosswise = white == 2.0F && c00 == c11;
    node.corners = crosswise ? 2.0F : white == 1.0F ? 1.0F : white == 3.0F ? -1.0F : 0.0F;
    return node;
}

/// x_low <= x < x_high and y_low <= y < y_high, cells, counted from a crossing.
struct Rectangle {
    double x_low, x_high, y_low, y_high;
};

/// Where a line of the tag passes an image row: at_px in row 0.
struct Crossed {
    double at_px, shift_px;

    double in(int row) const { return at_px + row * shift_px; }
};

/// Two such lines, the left one first; a pixel lies between them if it is not before the left one but before
/// the right one.
struct Strip {
    Crossed left, right;

    double width_px() const { return right.at_px - left.at_px; }
};

/// How the picture of the cells around a crossing lies in the image's rows, by the map's derivative there.
class Surroundings {
  public:
    Surroundings(const TagPicture& picture, const Eigen::Vector2d& cell)
        : at_px_(picture.image_of(cell)), by_px_(picture.cells_by_px(at_px_)), to_px_(by_px_.inverse()) {}

    double px_per_cell_x() const { return 1.0 / by_px_.row(0).norm(); }
    double px_per_cell_y() const { return 1.0 / by_px_.row(1).norm(); }

    /// Between the lines x = low and x = high (axis 0), or y (axis 1).
    Strip strip(int axis, double low, double high) const {
        constexpr double least = 1e-9;  // a line along the rows passes them as good as nowhere
        const double slope = std::abs(by_px_(axis, 0)) < least ? least : by_px_(axis, 0);
        const double shift_px = -by_px_(axis, 1) / slope;
        const double middle_px = at_px_.x() - shift_px * at_px_.y();
        const Crossed a{middle_px + low / slope, shift_px}, b{middle_px + high / slope, shift_px};
        return slope > 0.0 ? Strip{a, b} : Strip{b, a};
    }

    double lowest_row(const Rectangle& of) const {
        return at_px_.y() + std::min(to_px_(1, 0) * of.x_low, to_px_(1, 0) * of.x_high) +
               std::min(to_px_(1, 1) * of.y_low, to_px_(1, 1) * of.y_high);
    }
    double highest_row(const Rectangle& of) const {
        return at_px_.y() + std::max(to_px_(1, 0) * of.x_low, to_px_(1, 0) * of.x_high) +
               std::max(to_px_(1, 1) * of.y_low, to_px_(1, 1) * of.y_high);
    }

  private:
    Eigen::Vector2d at_px_;
    Eigen::Matrix2d by_px_, to_px_;
};

/// The first whole number from x on, for |x| < 2^31.
int whole_from(double x) {
    const int cut = static_cast<int>(x);
    return cut + (cut < x ? 1 : 0);
}

/// Pixels' places as the map's cubic takes them.
struct Grid {
    double per_px, u_start, v_start;
    std::array<float, lane_count> steps;  ///< of U, from a pixel to those right of it

    explicit Grid(const TagPicture::Cubic& cubic)
        : per_px(1.0 / cubic.unit_px),
          u_start(-cubic.origin_px.x() * per_px),
          v_start(-cubic.origin_px.y() * per_px) {
        for (std::size_t k = 0; k < lane_count; ++k)
            steps[k] = static_cast<float>(per_px) * static_cast<float>(k);
    }

    float u(int column) const { return static_cast<float>(u_start + column * per_px); }
    float v(int row) const { return static_cast<float>(v_start + row * per_px); }
};

/// Fills a band from its beginning.
class BandWriter {
  public:
    BandWriter(const cv::Mat& image, const TagPicture::Cubic& cubic, EdgeBand& band)
        : image_(image), grid_(cubic), band_(band) {
        band.nodes.clear();
        band.blocks.clear();
        band.pixels = 0;
    }

    /// Adds a rectangle's pixels. Whole lanes are written: what is too much, the next row overwrites.
    void add(const Surroundings& around, const Rectangle& of) {
        if (of.x_low >= of.x_high || of.y_low >= of.y_high) return;
        const Strip x = around.strip(0, of.x_low, of.x_high), y = around.strip(1, of.y_low, of.y_high);
        const double height_px = image_.rows;
        const int first_row = whole_from(std::min(height_px, std::max(0.0, around.lowest_row(of))));
        const int end_row = whole_from(std::max(0.0, std::min(height_px, around.highest_row(of))));
        if (first_row >= end_row) return;
        // Copies, which no store to the band can change.
        const Grid grid = grid_;
        const int columns = image_.cols;
        const double width_px = columns;
        constexpr int lanes = lane_count;

        const double widest_px = std::min(width_px, std::min(x.width_px(), y.width_px()));
        make_room(static_cast<std::size_t>((end_row - first_row) * (widest_px + 1.0)) + lane_count);
        float *u_at = band_.u.data() + at_, *v_at = band_.v.data() + at_;
        unsigned char* level_at = band_.levels.data() + at_;
        for (int row = first_row; row < end_row; ++row) {
            const double low = std::max(0.0, std::max(x.left.in(row), y.left.in(row)));
            const double high = std::min(width_px, std::min(x.right.in(row), y.right.in(row)));
            if (!(low < high)) continue;
            const int first = whole_from(low), end = whole_from(high);
            const auto* const pixels = image_.ptr<unsigned char>(row);
            const float v = grid.v(row);
            for (int k = 0; first + k < end; k += lanes) {
                const float u = grid.u(first + k);
                for (int i = 0; i < lanes; ++i) u_at[k + i] = u + grid.steps[i];
                for (int i = 0; i < lanes; ++i) v_at[k + i] = v;
                if (first + k + lanes <= columns)
                    std::memcpy(level_at + k, pixels + first + k, lane_count);
                else
                    std::memcpy(level_at + k, pixels + first + k,
                                static_cast<std::size_t>(columns - first - k));
            }
            u_at += end - first, v_at += end - first, level_at += end - first;
        }
        at_ = static_cast<std::size_t>(u_at - band_.u.data());
    }

    /// Makes blocks, as even as can be, of the pixels added since the last ones.
    void end_part(kernel::Near near, float far_level) {
        if (at_ == begin_) return;
        const std::size_t groups = (at_ - begin_ + lane_count - 1) / lane_count;
        const std::size_t end = begin_ + groups * lane_count;
        for (auto* const column : {&band_.u, &band_.v})
            std::fill(column->data() + at_, column->data() + end, (*column)[at_ - 1]);
        std::fill(band_.levels.data() + at_, band_.levels.data() + end, band_.levels[at_ - 1]);
        constexpr std::size_t most = kernel::block / lane_count;
        const std::size_t parts = (groups + most - 1) / most;
        for (std::size_t k = 0; k < parts; ++k) {
            const std::size_t from = begin_ + k * groups / parts * lane_count;
            const std::size_t to = std::min(begin_ + (k + 1) * groups / parts * lane_count, at_);
            band_.blocks.push_back({from, to - from, near, far_level});
        }
        band_.pixels += at_ - begin_;
        at_ = begin_ = end;
    }

    /// After the last part.
    void end_band() {
        band_.grey.resize(std::max(band_.grey.size(), at_));
        std::copy_n(band_.levels.data(), at_, band_.grey.data());
        band_.weights.assign(band_.blocks.size(), 1.0F);
    }

  private:
    void make_room(std::size_t for_pixels) {
        const std::size_t room = at_ + for_pixels + lane_count;
        if (room <= band_.u.size()) return;
        band_.u.resize(2 * room);
        band_.v.resize(2 * room);
        band_.levels.resize(2 * room);
    }

    const cv::Mat& image_;
    Grid grid_;
    EdgeBand& band_;
    std::size_t begin_ = 0, at_ = 0;
};

/// Takes a share of what is offered, evenly spread and without a period of its own: multiples of the golden
/// ratio.
class Choice {
  public:
    explicit Choice(double share) : share_(share) {}

    bool takes_next() {
        constexpr double golden_ratio = 0.618033988749895;
        place_ += golden_ratio;
        if (place_ >= 1.0) place_ -= 1.0;
        return place_ < share_;
    }

  private:
    double share_, place_ = 0.0;
};

/// Adds a crossing's pixels: about the crossing itself, where both lines matter, and along each edge that
/// leaves it, where the other line is too far away to.
void add_node(const TagPicture& picture, const BandReach& reach, kernel::Node node, Choice& choice,
              BandWriter& writer, EdgeBand& band) {
    constexpr double half_cell = 0.5;
    constexpr double far = 1.75;  // reaches: more than four standard deviations of the blur
    const Surroundings around(picture, {node.x, node.y});
    node.px_per_cell_x = static_cast<float>(around.px_per_cell_x());
    node.px_per_cell_y = static_cast<float>(around.px_per_cell_y());
    const double x = std::min(half_cell, reach.x_px / around.px_per_cell_x());
    const double y = std::min(half_cell, reach.y_px / around.px_per_cell_y());
    const double far_x = std::min(half_cell, far * x), far_y = std::min(half_cell, far * y);
    const bool up = node.edge_up > 0, down = node.edge_down > 0;
    const bool left = node.edge_left > 0, right = node.edge_right > 0;

    node.first_block = band.blocks.size();
    if (choice.takes_next()) {
        writer.add(around, {-x, x, up ? -far_y : -y, down ? far_y : y});
        if (left) writer.add(around, {-far_x, -x, -y, y});
        if (right) writer.add(around, {x, far_x, -y, y});
        writer.end_part(kernel::Near::both, 0.0F);
    }
    const auto add_edge = [&](bool is_there, const Rectangle& along, kernel::Near near, float far_level) {
        if (!is_there || !choice.takes_next()) return;
        writer.add(around, along);
        writer.end_part(near, far_level);
    };
    add_edge(up, {-x, x, -half_cell, -far_y}, kernel::Near::line_x, 0.0F);
    add_edge(down, {-x, x, far_y, half_cell}, kernel::Near::line_x, 1.0F);
    add_edge(left, {-half_cell, -far_x, -y, y}, kernel::Near::line_y, 0.0F);
    add_edge(right, {far_x, half_cell, -y, y}, kernel::Near::line_y, 1.0F);
    node.last_block = band.blocks.size();
    if (node.last_block > node.first_block) band.nodes.push_back(node);
}

}  // namespace

void select_band(const cv::Mat& image, const TagPicture& picture, const TagPattern& pattern,
                 const BandReach& reach, double share, EdgeBand& band) {
    BandWriter writer(image, picture.cubic(), band);
    Choice choice(share);
    for (int row = 0; row <= pattern.cells; ++row)
        for (int column = 0; column <= pattern.cells; ++column) {
            if (!is_known(pattern, column, row)) continue;
            const kernel::Node node = crossing(pattern, column, row);
            if (node.edge_up + node.edge_down + node.edge_left + node.edge_right > 0)
                add_node(picture, reach, node, choice, writer, band);
        }
    writer.end_band();
}

}  // namespace fidservo::vision

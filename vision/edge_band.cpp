#include "vision/edge_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace fidservo::vision {
namespace {

/// 1 white, 0 black; the paper around the tag is white, but on an AprilGrid black squares touch its corners.
float white_at(const TagPattern& pattern, int column, int row) {
    const bool beside = column < 0 || column >= pattern.cells, above = row < 0 || row >= pattern.cells;
    if (beside && above && pattern.has_corner_squares()) return 0.0F;
    if (beside || above) return 1.0F;
    return pattern[row * pattern.cells + column] ? 1.0F : 0.0F;
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

/// Half-open in whole pixels once rounded; empty if low >= high.
struct Interval {
    double low, high;

    Interval operator&(const Interval& other) const {
        return {std::max(low, other.low), std::min(high, other.high)};
    }
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A coordinate that changes along an image row by so much a pixel.
class Affine {
  public:
    explicit Affine(double slope) : inverse_(std::abs(slope) < 1e-12 ? 0.0 : 1.0 / slope) {}

    /// Where low <= offset + slope u < high.
    Interval where_between(double offset, double low, double high) const {
        if (inverse_ == 0.0)
            return offset >= low && offset < high ? Interval{-infinity, infinity} : Interval{0.0, 0.0};
        const double a = (low - offset) * inverse_, b = (high - offset) * inverse_;
        return inverse_ > 0 ? Interval{a, b} : Interval{b, a};
    }

  private:
    double inverse_;
};

/// The first whole number from x on, for |x| < 2^31.
int whole_from(double x) {
    const int cut = static_cast<int>(x);
    return cut + (cut < x ? 1 : 0);
}

/// Pixels of one image row that belong to a node's band, as up to four intervals that do not overlap.
struct RowSpans {
    std::array<Interval, 4> spans{};
    std::size_t count = 0;

    void add(Interval span) {
        if (span.low >= span.high) return;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k) {
            if (spans[k].low <= span.high && span.low <= spans[k].high)
                span = {std::min(span.low, spans[k].low), std::max(span.high, spans[k].high)};
            else
                spans[kept++] = spans[k];
        }
        spans[kept] = span;
        count = kept + 1;
    }
};

/// Pixels [first, last) of one image row.
struct Run {
    int row, first, last;
};

/// The runs of a node's band: of its square and within reach of its edges, by the map's derivative there.
void find_runs(const cv::Mat& image, const TagPicture& picture, const BandReach& reach, kernel::Node& node,
               std::vector<Run>& runs) {
    const Eigen::Vector2d at = picture.image_of({node.x, node.y});
    const Eigen::Matrix2d by_px = picture.cells_by_px(at);
    node.px_per_cell_x = static_cast<float>(1.0 / by_px.row(0).norm());
    node.px_per_cell_y = static_cast<float>(1.0 / by_px.row(1).norm());
    const double x_reach = std::min(0.5, reach.x_px / node.px_per_cell_x);
    const double y_reach = std::min(0.5, reach.y_px / node.px_per_cell_y);
    const Affine x_slope(by_px(0, 0)), y_slope(by_px(1, 0));

    // Half the height of the image box around a square of half a cell.
    const Eigen::Matrix2d to_px = by_px.inverse();
    const double half_height = 0.5 * (std::abs(to_px(1, 0)) + std::abs(to_px(1, 1)));
    const int first_row = std::max(0, static_cast<int>(std::ceil(at.y() - half_height)));
    const int last_row = std::min(image.rows - 1, static_cast<int>(std::floor(at.y() + half_height)));
    const Interval picture_width{0.0, static_cast<double>(image.cols)};

    for (int v = first_row; v <= last_row; ++v) {
        const double x0 = by_px(0, 1) * (v - at.y()) - by_px(0, 0) * at.x();
        const double y0 = by_px(1, 1) * (v - at.y()) - by_px(1, 0) * at.x();
        const Interval square =
            x_slope.where_between(x0, -0.5, 0.5) & y_slope.where_between(y0, -0.5, 0.5) & picture_width;
        if (square.low >= square.high) continue;
        const Interval near_x = square & x_slope.where_between(x0, -x_reach, x_reach);
        const Interval near_y = square & y_slope.where_between(y0, -y_reach, y_reach);
        RowSpans row;
        if (near_x.low < near_x.high) {
            if (node.edge_up > 0) row.add(near_x & y_slope.where_between(y0, -0.5, y_reach));
            if (node.edge_down > 0) row.add(near_x & y_slope.where_between(y0, -y_reach, 0.5));
        }
        if (near_y.low < near_y.high) {
            if (node.edge_left > 0) row.add(near_y & x_slope.where_between(x0, -0.5, x_reach));
            if (node.edge_right > 0) row.add(near_y & x_slope.where_between(x0, -x_reach, 0.5));
        }
        for (std::size_t k = 0; k < row.count; ++k) {
            const Run run{v, whole_from(row.spans[k].low), whole_from(row.spans[k].high)};
            if (run.first < run.last) runs.push_back(run);
        }
    }
}

/// Writes a run's pixels from `at` on.
void fill_run(const cv::Mat& image, const TagPicture::Cubic& cubic, const Run& run, std::size_t at,
              EdgeBand& band) {
    const auto* const row = image.ptr<unsigned char>(run.row) + run.first;
    const auto& k = cubic.coefficients;
    const double V = (run.row - cubic.origin_px.y()) / cubic.unit_px;
    const Eigen::Vector2f c0 = (k[0] + V * (k[2] + V * (k[5] + V * k[9]))).cast<float>();
    const Eigen::Vector2f c1 = (k[1] + V * (k[4] + V * k[8])).cast<float>();
    const Eigen::Vector2f c2 = (k[3] + V * k[7]).cast<float>();
    const Eigen::Vector2f c3 = k[6].cast<float>();
    const auto unit = static_cast<float>(1.0 / cubic.unit_px);
    const auto start = static_cast<float>((run.first - cubic.origin_px.x()) / cubic.unit_px);
    const int count = run.last - run.first;
    float* const qx = band.qx.data() + at;
    float* const qy = band.qy.data() + at;
    float* const grey = band.grey.data() + at;
    for (int i = 0; i < count; ++i) {
        const float U = start + unit * static_cast<float>(i);
        qx[i] = c0.x() + U * (c1.x() + U * (c2.x() + U * c3.x()));
        qy[i] = c0.y() + U * (c1.y() + U * (c2.y() + U * c3.y()));
        grey[i] = static_cast<float>(row[i]);
    }
}

/// Fills up the node that begins at `begin` and has this many pixels, and divides it into blocks.
std::size_t end_node(std::size_t begin, std::size_t pixels, EdgeBand& band) {
    const std::size_t last = begin + pixels - 1;
    const std::size_t end = begin + (pixels + lane_count - 1) / lane_count * lane_count;
    for (std::size_t i = begin; i <= last; ++i) band.weight[i] = 1.0F;
    for (std::size_t i = last + 1; i < end; ++i) {
        band.qx[i] = band.qx[last];
        band.qy[i] = band.qy[last];
        band.grey[i] = band.grey[last];
        band.weight[i] = 0.0F;
    }
    for (std::size_t at = begin; at < end; at += kernel::block) {
        const std::size_t block_end = std::min(at + kernel::block, end);
        band.blocks.push_back({at, block_end, std::min(block_end, last + 1) - at});
    }
    return end;
}

}  // namespace

void EdgeBand::weigh(const BandBlock& block, float root_of_weight) {
    std::fill_n(weight.begin() + static_cast<std::ptrdiff_t>(block.begin), block.pixels, root_of_weight);
}

void select_band(const cv::Mat& image, const TagPicture& picture, const TagPattern& pattern,
                 const BandReach& reach, int every, EdgeBand& band) {
    thread_local std::vector<Run> runs;  // kept: fresh memory costs more than its use
    runs.clear();
    band.nodes.clear();
    band.blocks.clear();
    band.pixels = 0;
    std::size_t room = 0;
    int with_edges = 0;
    for (int row = 0; row <= pattern.cells; ++row)
        for (int column = 0; column <= pattern.cells; ++column) {
            kernel::Node node = crossing(pattern, column, row);
            if (node.edge_up + node.edge_down + node.edge_left + node.edge_right == 0) continue;
            if (with_edges++ % every != 0) continue;
            node.begin = runs.size();  // of the runs for now
            find_runs(image, picture, reach, node, runs);
            node.end = runs.size();
            if (node.begin == node.end) continue;
            for (std::size_t k = node.begin; k < node.end; ++k)
                room += static_cast<std::size_t>(runs[k].last - runs[k].first);
            room += lane_count;
            band.nodes.push_back(node);
        }
    if (band.grey.size() < room)
        for (auto* const column : {&band.qx, &band.qy, &band.grey, &band.weight}) column->resize(room);
    std::size_t at = 0;
    for (kernel::Node& node : band.nodes) {
        const std::size_t begin = at;
        for (std::size_t k = node.begin; k < node.end; ++k) {
            fill_run(image, picture.cubic(), runs[k], at, band);
            at += static_cast<std::size_t>(runs[k].last - runs[k].first);
        }
        band.pixels += at - begin;
        node.begin = begin;
        node.end = at = end_node(begin, at - begin, band);
    }
}

}  // namespace fidservo::vision

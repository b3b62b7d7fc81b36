// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_alignment.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/normal_equations.h"
#include "vision/tags/quad.h"
#include "vision/tags/tag_pattern.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace fidservo::vision {
namespace {

constexpr double least_outline_side_px = 24.0;
constexpr int scans = 9;                     ///< a side
constexpr double first_scan = 0.14;          ///< of the side's length; the last one lies opposite
constexpr int least_agreeing = 5;            ///< scan lines, for a side to be seen
constexpr double agreement_px = 1.5;         ///< of a scan line with its side
constexpr double share_of_usual_step = 0.4;  ///< below, a scan line has not met the edge
constexpr double most_reach_px = 48.0;
constexpr int most_samples = 128;

using Corners = std::array<Eigen::Vector2d, 4>;

/// A side of the expected outline, from corner k to corner k + 1.
struct ExpectedSide {
    Eigen::Vector2d from_px, along;  ///< `along` is the side's whole vector
    Eigen::Vector2d inwards;         ///< unit normal
};

/// The edge met by one scan line.
struct Meeting {
    double inwards_px;  ///< from the expected side
    double step;        ///< fall from white to black, grey levels; 0: not met
};

/// Points from_px + t along + (at_start + t change) inwards, t from 0 to 1.
struct SideLine {
    double at_start_px, change_px;
};

ExpectedSide expected_side(const Corners& corners, std::size_t k) {
    const Eigen::Vector2d along = corners[(k + 1) % 4] - corners[k];
    Eigen::Vector2d inwards = Eigen::Vector2d(-along.y(), along.x()).normalized();
    if (inwards.dot(corners[(k + 2) % 4] - corners[k]) < 0) inwards = -inwards;
    return {corners[k], along, inwards};
}

double scan_place(int scan) {
    return first_scan + (1.0 - 2.0 * first_scan) * scan / (scans - 1);
}

/// The steepest fall from white to black (with `fall_sign` -1, the steepest rise) within reach of a point of
/// the expected side: the largest difference of the means of `half` samples on either side of a pixel,
/// between the samples by a parabola.
Meeting scan(const cv::Mat& image, const Eigen::Vector2d& base_px, const Eigen::Vector2d& inwards,
             double reach_px, int half, double fall_sign) {
    std::array<double, most_samples> sum;  // sum[i]: of all samples before i
    constexpr int room_px = 2;  // an edge at the very end of the reach still has its slopes in sight
    const int each_way = static_cast<int>(std::ceil(reach_px)) + half + room_px;
    sum[0] = 0.0;
    int first = -each_way;
    const auto seen = [&](int step) { return can_sample(image, base_px + step * inwards); };
    while (first <= each_way && !seen(first)) ++first;
    int count = 0;
    for (int step = first; step <= each_way && seen(step); ++step, ++count)
        sum[count + 1] = sum[count] + fall_sign * sample(image, base_px + step * inwards);

    const auto fall = [&](int i) { return (2 * sum[i] - sum[i - half] - sum[i + half]) / half; };
    int best = -1;
    for (int i = half; i + half <= count; ++i)
        if (best < 0 || fall(i) > fall(best)) best = i;
    if (best <= half || best + half >= count) return {0.0, 0.0};
    const double before = fall(best - 1), here = fall(best), after = fall(best + 1);
    const double bend = before - 2 * here + after;
    const double shift = bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
    return {first + best - 0.5 + shift, here};
}

using Meetings = std::array<Meeting, scans>;

/// The line that most scan lines agree on, by least squares over those.
std::optional<SideLine> agreed_line(const Meetings& meetings, double least_step) {
    const auto off_px = [&](int scan, const SideLine& line) {
        return std::abs(meetings[scan].inwards_px - line.at_start_px - line.change_px * scan_place(scan));
    };
    const auto agrees = [&](int scan, const SideLine& line) {
        return meetings[scan].step >= least_step && off_px(scan, line) <= agreement_px;
    };
    SideLine best{};
    int most = 0;
    for (int i = 0; i < scans; ++i)
        for (int j = i + 2; j < scans; ++j) {
            if (meetings[i].step < least_step || meetings[j].step < least_step) continue;
            const double change =
                (meetings[j].inwards_px - meetings[i].inwards_px) / (scan_place(j) - scan_place(i));
            const SideLine line{meetings[i].inwards_px - change * scan_place(i), change};
            int agreeing = 0;
            for (int k = 0; k < scans; ++k) agreeing += agrees(k, line) ? 1 : 0;
            if (agreeing > most) {
                most = agreeing;
                best = line;
            }
        }
    if (most < least_agreeing) return std::nullopt;
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (int k = 0; k < scans; ++k) {
        if (!agrees(k, best)) continue;
        const Eigen::Vector2d terms(1.0, scan_place(k));
        normal += terms * terms.transpose();
        right += terms * meetings[k].inwards_px;
    }
    const Eigen::Vector2d fit = solve_normal(normal, right);
    return SideLine{fit(0), fit(1)};
}

using ExpectedSides = std::array<ExpectedSide, 4>;
using SideLines = std::array<std::optional<SideLine>, 4>;

/// Places hidden sides by a similarity that takes the expected outline to the sides seen. Two sides that meet
/// tell shift and turn, three the scale as well; a prior keeps it near 1. False if the seen sides do not tell
/// the shift.
bool place_hidden(const ExpectedSides& sides, SideLines& lines) {
    constexpr double scale_std = 0.003, turn_std = 0.05, line_std_px = 0.3;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const ExpectedSide& side : sides) middle += 0.25 * side.from_px;
    const auto terms = [&](const ExpectedSide& side, double t) {
        const Eigen::Vector2d from_middle = side.from_px + t * side.along - middle;
        const Eigen::Vector2d turned(-from_middle.y(), from_middle.x());
        return Eigen::Vector4d(side.inwards.x(), side.inwards.y(), side.inwards.dot(turned),
                               side.inwards.dot(from_middle));
    };
    const double line_weight = 1.0 / (line_std_px * line_std_px);
    Eigen::Matrix4d normal =
        Eigen::Vector4d(0.0, 0.0, 1.0 / (turn_std * turn_std), 1.0 / (scale_std * scale_std)).asDiagonal();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        if (!lines[k]) continue;
        for (const double t : {0.0, 1.0}) {
            const Eigen::Vector4d of_line = terms(sides[k], t);
            normal += line_weight * of_line * of_line.transpose();
            right += line_weight * of_line * (lines[k]->at_start_px + t * lines[k]->change_px);
        }
    }
    if (normal.topLeftCorner<2, 2>().determinant() < line_weight * line_weight) return false;
    const Eigen::Vector4d similarity = solve_normal(normal, right);
    for (std::size_t k = 0; k < 4; ++k) {
        if (lines[k]) continue;
        const double start = terms(sides[k], 0.0).dot(similarity);
        lines[k] = {start, terms(sides[k], 1.0).dot(similarity) - start};
    }
    return true;
}

/// Corner k lies on the sides k - 1 and k.
Corners corners_of(const ExpectedSides& sides, const SideLines& lines) {
    Corners corners;
    for (std::size_t k = 0; k < 4; ++k) {
        Eigen::Matrix2d directions;
        std::array<Eigen::Vector2d, 2> starts;
        for (int i = 0; i < 2; ++i) {
            const std::size_t which = (k + 3 + i) % 4;
            starts[i] = sides[which].from_px + lines[which]->at_start_px * sides[which].inwards;
            directions.col(i) = sides[which].along + lines[which]->change_px * sides[which].inwards;
        }
        directions.col(1) *= -1.0;
        const Eigen::Vector2d t = directions.inverse() * (starts[1] - starts[0]);
        corners[k] = starts[0] + t(0) * directions.col(0);
    }
    return corners;
}

/// The outline within reach of the expected one; empty if there is none.
std::optional<Corners> find_outline(const cv::Mat& image, const ExpectedTag& expected, bool white_inside,
                                    double least_contrast) {
    ExpectedSides sides;
    double shortest_px = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k) {
        sides[k] = expected_side(expected.corners_px, k);
        shortest_px = std::min(shortest_px, sides[k].along.norm());
    }
    if (!(shortest_px >= least_outline_side_px)) return std::nullopt;
    const double cell_px = shortest_px / expected.print.outline_cells();
    const double reach_px = std::min({std::max(expected.reach_px, 1.0), 0.45 * cell_px, most_reach_px});
    const int half = std::clamp(static_cast<int>(cell_px / 6.0), 1, 4);

    std::array<Meetings, 4> meetings;
    std::array<double, 4 * scans> steps;
    for (std::size_t k = 0; k < 4; ++k)
        for (int i = 0; i < scans; ++i) {
            const Eigen::Vector2d base_px = sides[k].from_px + scan_place(i) * sides[k].along;
            meetings[k][i] =
                scan(image, base_px, sides[k].inwards, reach_px, half, white_inside ? -1.0 : 1.0);
            steps[k * scans + i] = meetings[k][i].step;
        }
    std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
    const double least_step = std::max(share_of_usual_step * steps[steps.size() / 2], 0.5 * least_contrast);

    SideLines lines;
    int seen = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        lines[k] = agreed_line(meetings[k], least_step);
        seen += lines[k] ? 1 : 0;
    }
    if (seen < 2 || (seen < 4 && !place_hidden(sides, lines))) return std::nullopt;
    const Corners corners = corners_of(sides, lines);
    for (std::size_t k = 0; k < 4; ++k)
        if (!can_sample(image, corners[k]) ||
            (corners[k] - expected.corners_px[k]).norm() > 2.0 * reach_px + 1.0)
            return std::nullopt;
    return corners;
}

}  // namespace

Result<TagDetection> align_tag(const cv::Mat& image, TimeNs time_ns, const ExpectedTag& expected,
                               const AlignmentOptions& options) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    const TagPattern pattern = tag_pattern(expected.print, expected.tag_id);
    const auto corners = find_outline(image, expected, pattern.is_white_inside(), options.least_contrast);
    if (!corners) return failure(Reason::no_tag, "no tag where it is expected");
    const PatternMatch match = match_pattern(image, *corners, pattern);
    const auto cells = static_cast<double>(pattern.cells * pattern.cells);
    const double fixed = cells - static_cast<double>(pattern.code.count());
    if (match.wrong_code_bits >
            std::min(options.most_wrong_bits, (expected.print.family->least_distance - 1) / 2) ||
        match.wrong_fixed_cells > options.most_wrong_fixed * fixed ||
        match.explained < options.least_explained || match.contrast < options.least_contrast)
        return failure(Reason::wrong_tag, "what is there does not read as the expected tag");
    return TagDetection{time_ns,      expected.tag_id, match.wrong_code_bits,
                        match.margin, *corners,        expected.print};
}

}  // namespace fidservo::vision

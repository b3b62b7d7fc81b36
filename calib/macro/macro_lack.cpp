// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_lack.h"

#include "calib/tails.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

namespace fidservo::calib {

namespace {

constexpr double lack_level = 0.01;

struct Group {
    const char* depends_on;
    int first, count;  ///< columns
};

constexpr std::array lack_groups{Group{"position", 0, 7},
                                 Group{"speed", 7, 2},
                                 Group{"the direction of motion", 9, 2},
                                 Group{"the size of the command", 11, 2},
                                 Group{"the side of the command", 13, 1},
                                 Group{"the commands before", 14, 2},
                                 Group{"time", 16, 2}};
constexpr int drive_column = 18, lack_columns = 19;

struct Ranges {
    double low_mm = std::numeric_limits<double>::infinity();
    double high_mm = -std::numeric_limits<double>::infinity();
    double command_V = 1e-12, speed_mm_per_s = 1e-12, duration_s = 1e-12;
};

Ranges ranges_of(const MacroEstimator& estimator) {
    Ranges ranges;
    ranges.speed_mm_per_s = estimator.fastest_mm_per_s();
    for (const MacroWindow& window : estimator.windows()) {
        for (const double y : window.position_mm) {
            ranges.low_mm = std::min(ranges.low_mm, y);
            ranges.high_mm = std::max(ranges.high_mm, y);
        }
        for (const double u : window.command_V) ranges.command_V = std::max(ranges.command_V, std::abs(u));
        ranges.duration_s =
            std::max(ranges.duration_s,
                     window.start_s + static_cast<double>(window.position_mm.size()) * window.tick_s);
    }
    return ranges;
}

/// The forces at a tick, in mm/s of the drive's size or less.
Eigen::Matrix<double, lack_columns, 1> forces_at(const MacroMotion& motion, const Ranges& ranges,
                                                 const MacroMotionState& state, const MacroWindow& window,
                                                 std::size_t k, double slow_drive) {
    constexpr double slow_share = 0.1;
    Eigen::Matrix<double, lack_columns, 1> g;
    const double fastest = ranges.speed_mm_per_s;
    const double place = (state.position_mm - ranges.low_mm) / std::max(ranges.high_mm - ranges.low_mm, 1e-9);
    for (int harmonic = 1; harmonic <= 3; ++harmonic) {
        const double phase = 2.0 * std::numbers::pi * harmonic * place;
        g[2 * harmonic - 2] = fastest * std::cos(phase);
        g[2 * harmonic - 1] = fastest * std::sin(phase);
    }
    g[6] = fastest * (place - 0.5);
    const double v = state.velocity_mm_per_s / fastest, u = window.command_V[k] / ranges.command_V;
    const double side = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
    g[7] = fastest * v * std::abs(v);
    g[8] = fastest * side * std::exp(-std::pow(v / slow_share, 2));
    g[9] = fastest * std::abs(v);
    g[10] = fastest * side;
    g[11] = fastest * u * std::abs(u);
    g[12] = fastest * u * u * u;
    g[13] = fastest * std::abs(u);
    const double drive = drive_speed_mm_per_s(motion, window.command_V[k]);
    g[14] = k > 0 ? drive_speed_mm_per_s(motion, window.command_V[k - 1]) - drive : 0.0;
    g[15] = slow_drive - drive;
    const double age = (window.start_s + static_cast<double>(k) * window.tick_s) / ranges.duration_s - 0.5;
    g[16] = fastest * age;
    g[17] = drive * age;
    g[drive_column] = drive;
    return g;
}

/// The change of the position, counts, by each of the tested forces: a row for each tick, a column for each
/// force.
Eigen::MatrixXd responses(const MacroEstimator& estimator, std::size_t w, const MacroPoint& point,
                          const Ranges& ranges) {
    constexpr double memory_ticks = 5.0;
    const MacroWindow& window = estimator.windows()[w];
    const MacroMotion& motion = point.motion;
    const std::vector<MacroMotionState> course = estimator.course(w, point);
    const double lost = -std::expm1(-window.tick_s / motion.time_constant_s);
    Eigen::MatrixXd result(static_cast<Eigen::Index>(course.size()), lack_columns);
    Eigen::Matrix<double, lack_columns, 1> place = Eigen::Matrix<double, lack_columns, 1>::Zero(),
                                           speed = place;
    double slow_drive = drive_speed_mm_per_s(motion, window.command_V[0]);
    for (std::size_t k = 0; k < course.size(); ++k) {
        result.row(static_cast<Eigen::Index>(k)) = place.transpose() / estimator.resolution_mm();
        const bool held =
            course[k].velocity_mm_per_s == 0.0 &&
            std::abs(drive_speed_mm_per_s(motion, window.command_V[k])) <= motion.friction_mm_per_s;
        const auto g = forces_at(motion, ranges, course[k], window, k, slow_drive);
        slow_drive += (drive_speed_mm_per_s(motion, window.command_V[k]) - slow_drive) / memory_ticks;
        if (held) {
            speed.setZero();
            continue;
        }
        place += g * window.tick_s + (speed - g) * (motion.time_constant_s * lost);
        speed += (g - speed) * lost;
    }
    return result;
}

struct Window {
    MacroEstimator::Linearised fit;
    Eigen::MatrixXd extra;  ///< responses, the start having followed
};

Window window_of(const MacroEstimator& estimator, std::size_t w, const MacroFit& fit, const Ranges& ranges) {
    Window window{estimator.linearised(w, fit.point, fit.active), responses(estimator, w, fit.point, ranges)};
    const Eigen::MatrixXd cross =
        window.fit.starts.transpose() * window.fit.curvatures.asDiagonal() * window.extra;
    window.extra -= window.fit.starts * (window.fit.start_information.inverse() * cross);
    return window;
}

struct Test {
    double probability = 1.0;
    Eigen::VectorXd multiplier;  ///< of the group's columns, by one Newton step
    double gain = 0.0;           ///< of the loss, twice
};

/// Hotelling's test of the mean of a group's scores over batches of windows.
Test test_of(const Group& group, const std::vector<Eigen::MatrixXd>& scores,
             const Eigen::MatrixXd& information) {
    Test test;
    std::size_t pieces = 1;
    for (int c = group.first; c < group.first + group.count; ++c) {
        std::vector<std::vector<double>> series;
        for (const Eigen::MatrixXd& of_recording : scores) {
            const Eigen::RowVectorXd row = of_recording.row(c);
            series.emplace_back(row.data(), row.data() + row.size());
        }
        pieces = std::max(pieces, batch_variance(series, 0).pieces);
    }
    std::vector<Eigen::VectorXd> sums;
    for (const Eigen::MatrixXd& of_recording : scores) {
        const auto batches = std::max<Eigen::Index>(of_recording.cols() > 0 ? 1 : 0,
                                                    of_recording.cols() / static_cast<Eigen::Index>(pieces));
        for (Eigen::Index i = 0; i < batches; ++i) {
            const Eigen::Index from = i * static_cast<Eigen::Index>(pieces);
            const Eigen::Index to =
                i + 1 == batches ? of_recording.cols() : from + static_cast<Eigen::Index>(pieces);
            sums.emplace_back(of_recording.middleRows(group.first, group.count)
                                  .middleCols(from, to - from)
                                  .rowwise()
                                  .sum());
        }
    }
    const auto count = static_cast<double>(sums.size());
    if (count < group.count + 4.0) return test;
    Eigen::VectorXd total = Eigen::VectorXd::Zero(group.count);
    for (const Eigen::VectorXd& sum : sums) total += sum;
    Eigen::MatrixXd variance = Eigen::MatrixXd::Zero(group.count, group.count);
    for (const Eigen::VectorXd& sum : sums)
        variance += (sum - total / count) * (sum - total / count).transpose();
    variance *= count / (count - 1.0);
    const Eigen::MatrixXd own = information.block(group.first, group.first, group.count, group.count);
    // In the information's own units, without directions that the parameters can follow.
    const Eigen::VectorXd unit = own.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(unit.asDiagonal() * own * unit.asDiagonal());
    constexpr double least_share = 1e-6;
    const auto kept = (parts.eigenvalues().array() > least_share).count();
    if (kept == 0) return test;
    const Eigen::MatrixXd turn = (unit.asDiagonal() * parts.eigenvectors().rightCols(kept)).eval();
    const Eigen::VectorXd score = turn.transpose() * total;
    const Eigen::MatrixXd spread = turn.transpose() * variance * turn;
    const double squared = score.dot(spread.ldlt().solve(score));
    const auto dimension = static_cast<double>(kept);
    const double ratio = squared * (count - dimension) / (dimension * (count - 1.0));
    if (!(ratio >= 0.0) || !std::isfinite(ratio)) return test;
    test.probability = mean_square_ratio_tail(ratio, dimension, count - dimension);
    const Eigen::VectorXd step = score.cwiseQuotient(parts.eigenvalues().tail(kept));
    test.multiplier = turn * step;
    test.gain = score.dot(step);
    return test;
}

}  // namespace

MacroLacks lacks_of(const MacroEstimator& estimator, const MacroFit& fit) {
    constexpr std::size_t least_pieces = 32;
    const Ranges ranges = ranges_of(estimator);
    const std::size_t windows = estimator.windows().size();
    MacroMatrix information = estimator.prior_information();
    Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(macro_parameter_count, lack_columns);
    double squares = 0.0;
    std::size_t recordings = 0;
    MacroLacks lacks{{}, 0.0};
    for (std::size_t w = 0; w < windows; ++w) {
        const Window window = window_of(estimator, w, fit, ranges);
        information += window.fit.own.transpose() * window.fit.curvatures.asDiagonal() * window.fit.own;
        cross += window.fit.own.transpose() * window.fit.curvatures.asDiagonal() * window.extra;
        lacks.drive_squares_count2 += window.extra.col(drive_column).squaredNorm();
        recordings = std::max(recordings, estimator.windows()[w].recording + 1);
    }
    const Eigen::MatrixXd followed = information.ldlt().solve(cross);
    const std::size_t pieces = (least_pieces + windows - 1) / windows;
    std::vector<std::vector<Eigen::VectorXd>> scores(recordings);
    Eigen::MatrixXd free = Eigen::MatrixXd::Zero(lack_columns, lack_columns);
    for (std::size_t w = 0; w < windows; ++w) {
        const Window window = window_of(estimator, w, fit, ranges);
        const Eigen::MatrixXd rest = window.extra - window.fit.own * followed;
        free += rest.transpose() * window.fit.curvatures.asDiagonal() * rest;
        const MacroWindow& of = estimator.windows()[w];
        const auto rows = static_cast<std::size_t>(rest.rows());
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            const auto from = static_cast<Eigen::Index>(rows * piece / pieces),
                       to = static_cast<Eigen::Index>(rows * (piece + 1) / pieces);
            scores[of.recording].emplace_back(-rest.middleRows(from, to - from).transpose() *
                                              window.fit.slopes.segment(from, to - from));
        }
        for (Eigen::Index k = 0; k < rest.rows(); ++k) {
            const auto i = static_cast<std::size_t>(k);
            const double error =
                window.fit.prediction_count[i] - of.position_mm[i] / estimator.resolution_mm();
            squares += window.fit.curvatures[k] * error * error;
        }
    }
    std::vector<Eigen::MatrixXd> by_recording;
    for (const auto& of_recording : scores) {
        Eigen::MatrixXd& all =
            by_recording.emplace_back(lack_columns, static_cast<Eigen::Index>(of_recording.size()));
        for (std::size_t j = 0; j < of_recording.size(); ++j)
            all.col(static_cast<Eigen::Index>(j)) = of_recording[j];
    }
    for (const Group& group : lack_groups) {
        const Test test = test_of(group, by_recording, free);
        if (test.probability > lack_level / static_cast<double>(lack_groups.size()) || squares <= 0.0)
            continue;
        MacroVector shift = -followed.middleCols(group.first, group.count) * test.multiplier;
        for (int i = 0; i < macro_parameter_count; ++i)
            if (!fit.active[static_cast<std::size_t>(i)]) shift[i] = 0.0;
        lacks.found.push_back(
            {group.depends_on, test.probability, std::min(1.0, test.gain / squares), shift});
    }
    std::ranges::sort(lacks.found, std::greater<>(), &MacroLack::share);
    return lacks;
}

double shift_variance(const std::vector<MacroLack>& lacks, const MacroVector& gradient) {
    double squares = 0.0, shares = 0.0;
    for (const MacroLack& lack : lacks) {
        squares += lack.share * std::pow(gradient.dot(lack.shift), 2);
        shares += lack.share;
    }
    return shares > 0.0 ? squares / shares : 0.0;
}

}  // namespace fidservo::calib

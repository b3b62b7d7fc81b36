// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/cramer_rao.h"

#include <functional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <opencv2/core.hpp>

namespace fidservo::precision {
namespace {

using Change = std::function<void(TagScene&, double)>;

/// Derivative of the mean picture, in shares of full scale per unit of the parameter.
cv::Mat1d derivative(const TagScene& scene, double step, const Change& change) {
    TagScene before = scene, after = scene;
    change(before, -step);
    change(after, step);
    return cv::Mat1d((mean_picture(after) - mean_picture(before)) / (2.0 * step));
}

std::vector<cv::Mat1d> derivatives(const TagScene& scene, bool perspective) {
    std::vector<cv::Mat1d> all{
        derivative(scene, 0.02, [](TagScene& s, double du) { s.centre_px.x() += du; }),
        derivative(scene, 0.02, [](TagScene& s, double dv) { s.centre_px.y() += dv; }),
        derivative(scene, 1e-4, [](TagScene& s, double turn) { s.angle_rad += turn; }),
        derivative(scene, 0.02, [](TagScene& s, double growth) { s.side_px += growth; }),
        derivative(scene, 0.01, [](TagScene& s, double wider) { s.blur.sigma_px += wider; })};
    const cv::Mat1d mean = mean_picture(scene);
    cv::Mat1d along_u(mean.size()), along_v(mean.size());
    for (int v = 0; v < mean.rows; ++v)
        for (int u = 0; u < mean.cols; ++u) {
            along_u(v, u) = mean(v, u) * (u - scene.centre_px.x()) / scene.side_px;
            along_v(v, u) = mean(v, u) * (v - scene.centre_px.y()) / scene.side_px;
        }
    all.insert(all.end(), {mean, cv::Mat1d(mean.size(), 1.0), along_u, along_v});
    if (perspective)
        for (const int axis : {0, 1})
            all.push_back(derivative(scene, 1e-3,
                                     [axis](TagScene& s, double tilt) { s.camera.tilt_rad[axis] += tilt; }));
    return all;
}

}  // namespace

std::vector<cv::Mat1d> sensitivities(const TagScene& scene, const Sensor& sensor,
                                     const UnknownPerspective& perspective) {
    TagScene plain = scene;
    plain.cover.reset();
    plain.glare.reset();
    std::vector<cv::Mat1d> all = derivatives(plain, perspective.fitted);
    const cv::Mat1d mean = mean_picture(plain);
    constexpr double step = 1e-6;
    for (int v = 0; v < mean.rows; ++v)
        for (int u = 0; u < mean.cols; ++u) {
            const double share = mean(v, u);
            const double response =
                (grey_of(sensor, share + step) - grey_of(sensor, share - step)) / (2.0 * step);
            for (cv::Mat1d& one : all) one(v, u) *= response;
        }
    return all;
}

Eigen::MatrixXd fisher_information(const TagScene& scene, const Sensor& sensor,
                                   const UnknownPerspective& perspective) {
    const std::vector<cv::Mat1d> slopes = sensitivities(scene, sensor, perspective);
    const cv::Mat1d mean = mean_picture(scene);
    const cv::Mat1b visible = undamaged(scene);
    const auto unknowns = static_cast<Eigen::Index>(slopes.size());
    Eigen::MatrixXd fisher = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd row(unknowns);
    for (int v = 0; v < mean.rows; ++v)
        for (int u = 0; u < mean.cols; ++u) {
            if (visible(v, u) == 0) continue;
            for (Eigen::Index k = 0; k < unknowns; ++k) row[k] = slopes[static_cast<std::size_t>(k)](v, u);
            fisher.selfadjointView<Eigen::Lower>().rankUpdate(row, 1.0 / grey_variance(sensor, mean(v, u)));
        }
    return fisher.selfadjointView<Eigen::Lower>();
}

Eigen::Matrix2d position_bound(const TagScene& scene, const Sensor& sensor,
                               const UnknownPerspective& perspective) {
    const Eigen::MatrixXd fisher = fisher_information(scene, sensor, perspective);
    const Eigen::Index others = fisher.rows() - 2;
    const Eigen::Matrix2d schur =
        fisher.topLeftCorner<2, 2>() -
        fisher.topRightCorner(2, others) *
            fisher.bottomRightCorner(others, others).ldlt().solve(fisher.bottomLeftCorner(others, 2));
    return schur.inverse();
}

}  // namespace fidservo::precision

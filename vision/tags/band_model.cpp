// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/band_model.h"

#include <algorithm>
#include <cmath>

namespace fidservo::vision {
namespace {

kernel::Constants constants_of(const TagPicture& picture, const BandLook& look, const GreyNoise& noise) {
    const auto f = [](double value) { return static_cast<float>(value); };
    kernel::Constants c{};
    const Eigen::Matrix3d& m = picture.m();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) c.homography[3 * row + column] = f(m(row, column));
    for (int k = 0; k < TagPicture::cubic_terms; ++k) {
        const Eigen::Vector2d& q = picture.cubic().coefficients[k];
        c.cubic_x[k] = f(m(0, 0) * q.x() + m(0, 1) * q.y() + (k == 0 ? m(0, 2) : 0.0));
        c.cubic_y[k] = f(m(1, 0) * q.x() + m(1, 1) * q.y() + (k == 0 ? m(1, 2) : 0.0));
    }
    c.inverse_blur_x = f(1.0 / look.blur_x_px);
    c.inverse_blur_y = f(1.0 / look.blur_y_px);
    c.half_motion_x = f(0.5 * look.motion_x_px / look.blur_x_px);
    c.half_motion_y = f(0.5 * look.motion_y_px / look.blur_y_px);
    c.spread = f(look.spread_px);
    c.skew = f(look.skew_factor);
    c.tail = f(look.tail_factor);
    c.kink = f(look.kink_factor);
    c.black = f(look.black_grey);
    c.height = f(look.white_grey - look.black_grey);
    c.light_x = f(look.light(0) / kernel::half_side_cells);
    c.light_y = f(look.light(1) / kernel::half_side_cells);
    c.light_r = f(look.light(2) / (kernel::half_side_cells * kernel::half_side_cells));
    c.noise_floor = f(noise.floor_variance);
    c.noise_gain = f(noise.gain_grey_per_e);
    c.noise_spread = f(noise.gain_spread * noise.gain_spread);
    return c;
}

kernel::Band view_of(const EdgeBand& band, const std::vector<float>& weights) {
    return {band.u.data(),  band.v.data(),     band.grey.data(), band.blocks.data(),
            weights.data(), band.nodes.data(), band.nodes.size()};
}

bool wide() {
    static const bool has = kernel::has_wide_vectors();
    return has;
}

Eigen::MatrixXd symmetric(const kernel::Sums& sums, Eigen::Index size) {
    Eigen::MatrixXd matrix(size, size);
    for (Eigen::Index row = 0; row < size; ++row)
        for (Eigen::Index column = 0; column <= row; ++column)
            matrix(row, column) = matrix(column, row) = sums.products[row][column];
    return matrix;
}

BandEquations add_up(const EdgeBand& band, const std::vector<float>& weights, const TagPicture& picture,
                     const BandLook& look, const GreyNoise& noise, kernel::Residuals* residuals) {
    kernel::Sums sums{};
    const kernel::AddBand add = wide() ? kernel::add_band_wide : kernel::add_band_plain;
    add(static_cast<std::size_t>(picture.parameters()), view_of(band, weights),
        constants_of(picture, look, noise), residuals, sums);
    const Eigen::Index parameters = picture.parameters() + kernel::look_columns;
    BandEquations equations{symmetric(sums, parameters), Eigen::VectorXd(parameters),
                            sums.products[parameters][parameters]};
    for (Eigen::Index k = 0; k < parameters; ++k) equations.right(k) = sums.products[parameters][k];
    return equations;
}

}  // namespace

BandEquations evaluate_band(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                            const GreyNoise& noise, std::vector<kernel::Residuals>& residuals) {
    residuals.resize(band.blocks.size());
    return add_up(band, band.weights, picture, look, noise, residuals.data());
}

void reweigh(BandEquations& equations, const EdgeBand& band, const std::vector<float>& weights_before,
             const TagPicture& picture, const BandLook& look, const GreyNoise& noise) {
    thread_local std::vector<float> roots;  // kept: fresh memory costs more than its use
    for (const double sign : {1.0, -1.0}) {
        bool any = false;
        roots.assign(band.weights.size(), 0.0F);
        for (std::size_t k = 0; k < roots.size(); ++k) {
            const double more = sign * (std::pow(band.weights[k], 2) - std::pow(weights_before[k], 2));
            if (more <= 0.0) continue;
            roots[k] = static_cast<float>(std::sqrt(more));
            any = true;
        }
        if (!any) continue;
        const BandEquations change = add_up(band, roots, picture, look, noise, nullptr);
        equations.normal += sign * change.normal;
        equations.right += sign * change.right;
        equations.square_sum += sign * change.square_sum;
    }
}

Eigen::MatrixXd band_scatter(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                             const GreyNoise& noise) {
    kernel::Sums sums{};
    const kernel::AddScatter add = wide() ? kernel::add_scatter_wide : kernel::add_scatter_plain;
    add(static_cast<std::size_t>(picture.parameters()), view_of(band, band.weights),
        constants_of(picture, look, noise), sums);
    const auto crossings = static_cast<double>(band.nodes.size());
    return crossings / std::max(1.0, crossings - 1.0) *
           symmetric(sums, picture.parameters() + kernel::look_columns);
}

}  // namespace fidservo::vision

#include "vision/band_model.h"

namespace fidservo::vision {
namespace {

kernel::Constants constants_of(const TagPicture& picture, const BandLook& look, const GreyNoise& noise) {
    const auto f = [](double value) { return static_cast<float>(value); };
    kernel::Constants c{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) c.m[3 * row + column] = f(picture.m()(row, column));
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

kernel::Band view_of(const EdgeBand& band) {
    return {band.qx.data(),     band.qy.data(),    band.grey.data(),
            band.weight.data(), band.nodes.data(), band.nodes.size()};
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

}  // namespace

BandEquations evaluate_band(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                            const GreyNoise& noise, std::vector<float>& block_squares) {
    block_squares.resize(band.blocks.size());
    kernel::Sums sums{};
    const kernel::AddBand add = wide() ? kernel::add_band_wide : kernel::add_band_plain;
    add(static_cast<std::size_t>(picture.parameters()), view_of(band), constants_of(picture, look, noise),
        block_squares.data(), sums);
    const Eigen::Index parameters = picture.parameters() + kernel::look_columns;
    BandEquations equations{symmetric(sums, parameters), Eigen::VectorXd(parameters),
                            sums.products[parameters][parameters]};
    for (Eigen::Index k = 0; k < parameters; ++k) equations.right(k) = sums.products[parameters][k];
    return equations;
}

Eigen::MatrixXd band_scatter(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                             const GreyNoise& noise) {
    kernel::Sums sums{};
    const kernel::AddScatter add = wide() ? kernel::add_scatter_wide : kernel::add_scatter_plain;
    add(static_cast<std::size_t>(picture.parameters()), view_of(band), constants_of(picture, look, noise),
        sums);
    return symmetric(sums, picture.parameters() + kernel::look_columns);
}

}  // namespace fidservo::vision

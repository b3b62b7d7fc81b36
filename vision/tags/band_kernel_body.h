// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The functions of band_kernel.h, compiled for the processor that the including file is compiled for.
#include "vision/tags/band_kernel.h"
#include "vision/tags/edge_profile.h"

namespace fidservo::vision::kernel {
namespace {

/// Number of pixels whose columns are multiplied at a time, so that they stay in the first-level cache.
constexpr std::size_t chunk = 8 * block;

/// The columns of the weighted Jacobian, followed by the weighted residual.
struct Columns {
    alignas(32) float at[most_columns][chunk];
};

/// The profile of a line that is out of reach: constant, 0 or 1.
[[gnu::always_inline]] inline void level_profile(float level, EdgeProfile& f) {
    f.f0 = Lanes{} + level;
    f.f1 = f.f2 = f.f3 = f.f4 = f.f5 = Lanes{};
}

/// Places of eight pixels in the tag frame.
template <std::size_t geometry>
[[gnu::always_inline]] inline void locate(const Band& band, std::size_t first, const Constants& c, Lanes& x,
                                          Lanes& y) {
    Lanes u, v;
    load(band.u + first, u);
    load(band.v + first, v);
    if constexpr (geometry == 4) {
        const auto cubic = [&](const float(&k)[10], Lanes& value) {
            value = (k[0] + v * (k[2] + v * (k[5] + v * k[9]))) +
                    u * ((k[1] + v * (k[4] + v * k[8])) + u * ((k[3] + v * k[7]) + u * k[6]));
        };
        cubic(c.cubic_x, x);
        cubic(c.cubic_y, y);
    } else {
        const float(&h)[9] = c.homography;
        const Lanes by_depth = 1.0F / (h[6] * u + h[7] * v + h[8]);
        x = by_depth * (h[0] * u + h[1] * v + h[2]);
        y = by_depth * (h[3] * u + h[4] * v + h[5]);
    }
}

/// Computes the columns for eight pixels of a block, and adds up their residuals and squared residuals in
/// standard deviations, without weights.
/// @param shown  1 for the block's pixels, 0 for the padding
template <std::size_t geometry, Near near>
[[gnu::always_inline]] inline void fill_columns(const Band& band, const Node& node, const Block& of,
                                                std::size_t first, const Lanes& shown, float root_of_weight,
                                                const Constants& c, Columns& j, std::size_t into,
                                                Lanes& residuals, Lanes& squares) {
    const float by_x = node.px_per_cell_x * c.inverse_blur_x;
    const float by_y = node.px_per_cell_y * c.inverse_blur_y;
    Lanes x, y, grey;
    locate<geometry>(band, first, c, x, y);
    load(band.grey + first, grey);
    EdgeProfile fx, fy;
    if constexpr (near == Near::line_y)
        level_profile(of.far_level, fx);
    else
        profile_at((x - node.x) * by_x, c.half_motion_x, fx);
    if constexpr (near == Near::line_x)
        level_profile(of.far_level, fy);
    else
        profile_at((y - node.y) * by_y, c.half_motion_y, fy);

    // Ink that spreads by e = eps s moves every edge towards white: f(z -+ eps), as a Taylor series. Its even
    // terms keep the edge's sign, the odd ones do not.
    const float eps_x = c.spread * c.inverse_blur_x, eps_y = c.spread * c.inverse_blur_y;
    const float even2_x = 0.5F * eps_x * eps_x, even2_y = 0.5F * eps_y * eps_y;
    const float even4_x = even2_x * even2_x * (1.0F / 6) + c.tail,
                even4_y = even2_y * even2_y * (1.0F / 6) + c.tail;
    const float odd3_x = even2_x * eps_x * (1.0F / 3) - c.skew,
                odd3_y = even2_y * eps_y * (1.0F / 3) - c.skew;
    const Lanes A = fx.f0 + even2_x * fx.f2 + even4_x * fx.f4;
    const Lanes B = fy.f0 + even2_y * fy.f2 + even4_y * fy.f4;
    const Lanes A1 = fx.f1 + even2_x * fx.f3 + even4_x * fx.f5;
    const Lanes B1 = fy.f1 + even2_y * fy.f3 + even4_y * fy.f5;
    const Lanes odd_x = eps_x * fx.f1 + odd3_x * fx.f3 - c.kink * fx.f5;
    const Lanes odd_y = eps_y * fy.f1 + odd3_y * fy.f3 - c.kink * fy.f5;
    const Lanes dx = node.cx + node.cxy * B, dy = node.cy + node.cxy * A;
    const Lanes edge_x = node.edge_up + (node.edge_down - node.edge_up) * B;
    const Lanes edge_y = node.edge_left + (node.edge_right - node.edge_left) * A;
    const Lanes covered =
        node.c + node.cx * A + dy * B - odd_x * edge_x - odd_y * edge_y + node.corners * odd_x * odd_y;
    const Lanes by_spread = c.inverse_blur_x * (eps_x * fx.f2 * dx - (fx.f1 + even2_x * fx.f3) * edge_x) +
                            c.inverse_blur_y * (eps_y * fy.f2 * dy - (fy.f1 + even2_y * fy.f3) * edge_y);
    const Lanes by_skew = fx.f3 * edge_x + fy.f3 * edge_y;
    const Lanes by_kink = fx.f5 * edge_x + fy.f5 * edge_y;
    const Lanes r2 = x * x + y * y;
    const Lanes light = 1.0F + c.light_x * x + c.light_y * y + c.light_r * r2;
    const Lanes unlit = c.black + c.height * covered;
    const Lanes model = unlit * light;
    const Lanes lit = model > 0.0F ? model : model * 0.0F;
    Lanes by_std;
    inverse_root(c.noise_floor + lit * (c.noise_gain + lit * c.noise_spread), by_std);
    const Lanes weight = shown * root_of_weight;
    const Lanes w = by_std * weight;
    const Lanes height = w * c.height * light;
    const Lanes residual = (grey - model) * by_std * shown;
    residuals += residual;
    squares += residual * residual;

    const auto put = [&](std::size_t column, const Lanes& values) { store(values, &j.at[column][into]); };
    const Lanes odd1_x = eps_x * fx.f2 + odd3_x * fx.f4, odd1_y = eps_y * fy.f2 + odd3_y * fy.f4;
    const Lanes gx =
        height * by_x *
        (A1 * (dx - (node.edge_right - node.edge_left) * odd_y) - odd1_x * (edge_x - node.corners * odd_y));
    const Lanes gy =
        height * by_y *
        (B1 * (dy - (node.edge_down - node.edge_up) * odd_x) - odd1_y * (edge_y - node.corners * odd_x));
    const Lanes radial = gx * x + gy * y;
    put(0, gx);
    put(1, gy);
    put(2, radial);
    put(3, gy * x - gx * y);
    if constexpr (geometry == 8) {
        put(4, gx * x - gy * y);
        put(5, gx * y + gy * x);
        put(6, radial * x);
        put(7, radial * y);
    }
    put(geometry + width_x, height * fx.f2 * dx);
    put(geometry + width_y, height * fy.f2 * dy);
    put(geometry + spread, height * by_spread);
    put(geometry + skew, height * by_skew);
    put(geometry + tail, height * (fx.f4 * dx + fy.f4 * dy));
    put(geometry + kink, height * by_kink);
    put(geometry + white, w * light * covered);
    put(geometry + black, w * light * (1.0F - covered));
    constexpr auto sides_per_cell = static_cast<float>(1.0 / half_side_cells);  // half sides per cell
    const Lanes by_light = w * unlit * sides_per_cell;
    put(geometry + light_x, by_light * x);
    put(geometry + light_y, by_light * y);
    put(geometry + light_r, by_light * sides_per_cell * r2);
    put(geometry + look_columns, residual * root_of_weight);
}

template <std::size_t geometry, Near near>
[[gnu::always_inline]] inline Residuals fill_block_near(const Band& band, const Node& node, const Block& of,
                                                        float root_of_weight, const Constants& c, Columns& j,
                                                        std::size_t into) {
    constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
    Lanes residuals = {}, squares = {};
    for (std::size_t i = 0; i < of.pixels; i += lane_count) {
        const Lanes shown = lane < static_cast<float>(of.pixels - i) ? Lanes{} + 1.0F : Lanes{};
        fill_columns<geometry, near>(band, node, of, of.begin + i, shown, root_of_weight, c, j, into + i,
                                     residuals, squares);
    }
    return {sum_of(residuals), sum_of(squares)};
}

template <std::size_t geometry>
Residuals fill_block(const Band& band, const Node& node, const Block& of, float root_of_weight,
                     const Constants& c, Columns& j, std::size_t into) {
    switch (of.near) {
        case Near::line_x:
            return fill_block_near<geometry, Near::line_x>(band, node, of, root_of_weight, c, j, into);
        case Near::line_y:
            return fill_block_near<geometry, Near::line_y>(band, node, of, root_of_weight, c, j, into);
        case Near::both:
            break;
    }
    return fill_block_near<geometry, Near::both>(band, node, of, root_of_weight, c, j, into);
}

constexpr std::size_t whole_lanes(std::size_t pixels) {
    return (pixels + lane_count - 1) / lane_count * lane_count;
}

/// sums[i][k] += column i times column k, on and below the diagonal (and a little above it). Two by four sums
/// at a time stay in registers.
template <std::size_t columns>
[[gnu::always_inline]] inline void add_products(const Columns& j, std::size_t count,
                                                Lanes (&sums)[columns][columns]) {
    static_assert(columns % 4 == 0);
    for (std::size_t a = 0; a < columns; a += 2)
        for (std::size_t b = 0; b <= a + 1; b += 4) {
            Lanes(&upper)[columns] = sums[a];
            Lanes(&lower)[columns] = sums[a + 1];
            Lanes u0 = upper[b], u1 = upper[b + 1], u2 = upper[b + 2], u3 = upper[b + 3];
            Lanes l0 = lower[b], l1 = lower[b + 1], l2 = lower[b + 2], l3 = lower[b + 3];
            for (std::size_t i = 0; i < count; i += lane_count) {
                Lanes top, bottom, right;
                load(&j.at[a][i], top);
                load(&j.at[a + 1][i], bottom);
                load(&j.at[b][i], right);
                u0 += top * right;
                l0 += bottom * right;
                load(&j.at[b + 1][i], right);
                u1 += top * right;
                l1 += bottom * right;
                load(&j.at[b + 2][i], right);
                u2 += top * right;
                l2 += bottom * right;
                load(&j.at[b + 3][i], right);
                u3 += top * right;
                l3 += bottom * right;
            }
            upper[b] = u0, upper[b + 1] = u1, upper[b + 2] = u2, upper[b + 3] = u3;
            lower[b] = l0, lower[b + 1] = l1, lower[b + 2] = l2, lower[b + 3] = l3;
        }
}

template <std::size_t geometry>
void add_band_of(const Band& band, const Constants& constants, Residuals* residuals, Sums& sums) {
    constexpr std::size_t columns = columns_of(geometry);
    Columns j;
    alignas(32) Lanes products[columns][columns] = {};
    std::size_t filled = 0;
    for (std::size_t n = 0; n < band.node_count; ++n) {
        const Node& node = band.nodes[n];
        for (std::size_t b = node.first_block; b < node.last_block; ++b) {
            const float weight = band.weights[b];
            if (residuals == nullptr && weight == 0.0F) continue;
            const Residuals of_block =
                fill_block<geometry>(band, node, band.blocks[b], weight, constants, j, filled);
            if (residuals != nullptr) residuals[b] = of_block;
            if (weight == 0.0F) continue;
            filled += whole_lanes(band.blocks[b].pixels);
            if (filled + block <= chunk) continue;
            add_products<columns>(j, filled, products);
            filled = 0;
        }
    }
    add_products<columns>(j, filled, products);
    for (std::size_t row = 0; row < columns; ++row)
        for (std::size_t column = 0; column <= row; ++column)
            sums.products[row][column] += static_cast<double>(sum_of(products[row][column]));
}

template <std::size_t geometry>
void add_scatter_of(const Band& band, const Constants& constants, Sums& sums) {
    constexpr std::size_t parameters = geometry + look_columns;
    Columns j;
    for (std::size_t n = 0; n < band.node_count; ++n) {
        const Node& node = band.nodes[n];
        double score[parameters] = {};
        for (std::size_t b = node.first_block; b < node.last_block; ++b) {
            const Block& of = band.blocks[b];
            fill_block<geometry>(band, node, of, band.weights[b], constants, j, 0);
            for (std::size_t k = 0; k < parameters; ++k) {
                Lanes sum = {};
                for (std::size_t i = 0; i < of.pixels; i += lane_count) {
                    Lanes left, right;
                    load(&j.at[k][i], left);
                    load(&j.at[parameters][i], right);
                    sum += left * right;
                }
                score[k] += static_cast<double>(sum_of(sum));
            }
        }
        for (std::size_t row = 0; row < parameters; ++row)
            for (std::size_t column = 0; column <= row; ++column)
                sums.products[row][column] += score[row] * score[column];
    }
}

void add_band(std::size_t geometry, const Band& band, const Constants& constants, Residuals* residuals,
              Sums& sums) {
    (geometry == 4 ? add_band_of<4> : add_band_of<8>)(band, constants, residuals, sums);
}

void add_scatter(std::size_t geometry, const Band& band, const Constants& constants, Sums& sums) {
    (geometry == 4 ? add_scatter_of<4> : add_scatter_of<8>)(band, constants, sums);
}

}  // namespace
}  // namespace fidservo::vision::kernel

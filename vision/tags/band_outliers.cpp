// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/band_outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace fidservo::vision {
namespace {

constexpr float most_of_block = 4.4F;
constexpr float most_of_crossing = 3.6F;
constexpr float most_of_sum = 3.0F;
constexpr float left_out_excess = 2.0F;  ///< excess of what goes with its neighbours, or with most of its own

/// Parts of a crossing's neighbourhood: about the crossing itself, and the edges that leave it.
enum Place : std::size_t { middle, up, down, left, right, places };

Place place_of(const kernel::Block& block) {
    if (block.near == kernel::Near::both) return middle;
    if (block.near == kernel::Near::line_x) return block.far_level == 0.0F ? up : down;
    return block.far_level == 0.0F ? left : right;
}

/// Residuals of pixels that fit.
struct Tally {
    float sum = 0.0F, square_sum = 0.0F, pixels = 0.0F;

    void add(const kernel::Residuals& residuals, float count) {
        sum += residuals.sum;
        square_sum += residuals.square_sum;
        pixels += count;
    }
};

struct Part {
    Tally fitting = {};
    bool misfits = false;  ///< in some block
    bool damaged = false;
};

struct JudgedCrossing {
    const kernel::Node* node;
    Tally fitting = {};
    std::array<Part, places> parts = {};

    bool is_damaged() const {
        return std::any_of(parts.begin() + up, parts.end(), [](const Part& edge) { return edge.misfits; });
    }
    bool is_beside(const JudgedCrossing& other) const {
        return std::max(std::abs(node->x - other.node->x), std::abs(node->y - other.node->y)) < 1.5F;
    }
};

float size_of(const EdgeBand& band, std::size_t block) {
    return static_cast<float>(band.blocks[block].pixels);
}

/// Limit of the mean of so many squares of unit normals (Wilson and Hilferty 1931).
float limit_of(float pixels, float deviations) {
    const float variance = 2.0F / (9.0F * pixels);
    const float root = 1.0F - variance + deviations * std::sqrt(variance);
    return root * root * root;
}

/// The mean square of a block that fits as well as any. Where even the median one does not fit, the print or
/// the noise is not as believed, and blocks differ by more than noise lets them.
float usual_of(const std::vector<float>& mean_squares, float allowance) {
    constexpr float fits = 1.3F, spread_of_misfits = 1.5F;
    thread_local std::vector<float> sorted;
    sorted = mean_squares;
    const auto at = [&](double share) {
        const auto place =
            sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size()));
        std::nth_element(sorted.begin(), place, sorted.end());
        return *place;
    };
    const float median = at(0.5);
    return std::max(allowance, median < fits * allowance ? median : spread_of_misfits * at(0.75));
}

/// Finds the parts that are damaged at a damaged crossing or beside one.
void find_damaged_parts(float usual, std::vector<JudgedCrossing>& crossings) {
    thread_local std::vector<const JudgedCrossing*> centres;  // kept: fresh memory costs more than its use
    centres.clear();
    for (const JudgedCrossing& crossing : crossings)
        if (crossing.is_damaged()) centres.push_back(&crossing);
    const auto leans = [&](const Tally& of) {
        return std::abs(of.sum) > most_of_sum * std::sqrt(of.pixels * usual);
    };
    for (JudgedCrossing& crossing : crossings) {
        if (std::none_of(centres.begin(), centres.end(),
                         [&](const JudgedCrossing* centre) { return crossing.is_beside(*centre); }))
            continue;
        const bool whole = leans(crossing.fitting);
        for (Part& part : crossing.parts) part.damaged = whole || part.misfits || leans(part.fitting);
    }
}

/// Damaged parts of a crossing, and what goes with them.
std::array<bool, places> parts_to_leave_out(const JudgedCrossing& crossing) {
    const auto damaged = [](const Part& part) { return part.damaged; };
    std::array<bool, places> out{};
    out[middle] = std::any_of(crossing.parts.begin(), crossing.parts.end(), damaged);
    for (const Place edge : {up, down, left, right})
        out[edge] = crossing.parts[edge].damaged || crossing.parts[middle].damaged;
    return out;
}

}  // namespace

void judge_blocks(const EdgeBand& band, float allowance, const std::vector<kernel::Residuals>& residuals,
                  BlockJudgement& judgement) {
    std::vector<float>& excess = judgement.excess;
    const std::size_t blocks = band.blocks.size();
    excess.resize(blocks);
    if (blocks == 0) return;
    for (std::size_t k = 0; k < blocks; ++k) excess[k] = residuals[k].square_sum / size_of(band, k);
    judgement.usual = usual_of(excess, allowance);
    for (const kernel::Node& node : band.nodes) {
        Tally fitting;
        for (std::size_t k = node.first_block; k < node.last_block; ++k) {
            excess[k] /= judgement.usual * limit_of(size_of(band, k), most_of_block);
            if (excess[k] <= 1.0F) fitting.add(residuals[k], size_of(band, k));
        }
        if (fitting.pixels == 0.0F) continue;
        const float whole = fitting.square_sum /
                            (fitting.pixels * judgement.usual * limit_of(fitting.pixels, most_of_crossing));
        if (whole <= 1.0F) continue;
        for (std::size_t k = node.first_block; k < node.last_block; ++k)
            excess[k] = std::max(excess[k], std::max(left_out_excess, whole));
    }
}

void follow_damage(const EdgeBand& band, const std::vector<kernel::Residuals>& residuals,
                   BlockJudgement& judgement) {
    std::vector<float>& excess = judgement.excess;
    thread_local std::vector<JudgedCrossing> crossings;  // kept: fresh memory costs more than its use
    crossings.clear();
    for (const kernel::Node& node : band.nodes) {
        JudgedCrossing& crossing = crossings.emplace_back(JudgedCrossing{&node});
        for (std::size_t k = node.first_block; k < node.last_block; ++k) {
            Part& part = crossing.parts[place_of(band.blocks[k])];
            if (excess[k] > 1.0F) {
                part.misfits = true;
                continue;
            }
            part.fitting.add(residuals[k], size_of(band, k));
            crossing.fitting.add(residuals[k], size_of(band, k));
        }
    }
    find_damaged_parts(judgement.usual, crossings);
    for (const JudgedCrossing& crossing : crossings) {
        const std::array<bool, places> out = parts_to_leave_out(crossing);
        for (std::size_t k = crossing.node->first_block; k < crossing.node->last_block; ++k)
            if (out[place_of(band.blocks[k])]) excess[k] = std::max(excess[k], left_out_excess);
    }
}

}  // namespace fidservo::vision

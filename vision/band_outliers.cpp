#include "vision/band_outliers.h"

#include <algorithm>
#include <cmath>

namespace fidservo::vision {
namespace {

constexpr float most_of_block = 4.4F;
constexpr float most_of_crossing = 3.6F;
constexpr float most_beside_misfit = 1.9F;

/// A crossing of the code's lines with its blocks [first, last).
struct Crossing {
    float x, y;
    std::size_t first, last;
    float square_sum = 0.0F;  ///< of the blocks that fit
    float pixels = 0.0F;      ///< likewise
    float excess = 0.0F;
};

/// Limit of the mean of so many squares of unit normals (Wilson and Hilferty 1931).
float limit_of(float pixels, float deviations) {
    const float variance = 2.0F / (9.0F * pixels);
    const float root = 1.0F - variance + deviations * std::sqrt(variance);
    return root * root * root;
}

float excess_of(const Crossing& crossing, float usual, float deviations) {
    if (crossing.pixels == 0.0F) return 0.0F;
    return crossing.square_sum / (crossing.pixels * usual * limit_of(crossing.pixels, deviations));
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

}  // namespace

void judge_blocks(const EdgeBand& band, float allowance, const std::vector<float>& block_squares,
                  std::vector<float>& excess) {
    const std::size_t blocks = band.blocks.size();
    excess.resize(blocks);
    if (blocks == 0) return;
    const auto size_of = [&](std::size_t k) { return static_cast<float>(band.blocks[k].pixels); };
    for (std::size_t k = 0; k < blocks; ++k) excess[k] = block_squares[k] / size_of(k);
    const float usual = usual_of(excess, allowance);

    std::vector<Crossing> crossings;
    crossings.reserve(band.nodes.size());
    std::vector<const Crossing*> misfits;
    for (const kernel::Node& node : band.nodes) {
        Crossing crossing{node.x, node.y, node.first_block, node.last_block};
        bool damaged = false;
        for (std::size_t k = node.first_block; k < node.last_block; ++k) {
            excess[k] /= usual * limit_of(size_of(k), most_of_block);
            if (excess[k] > 1.0F) {
                damaged = true;
                continue;
            }
            crossing.square_sum += block_squares[k];
            crossing.pixels += size_of(k);
        }
        crossing.excess = excess_of(crossing, usual, most_of_crossing);
        crossings.push_back(crossing);
        if (damaged || crossing.excess > 1.0F) misfits.push_back(&crossings.back());
    }
    if (misfits.empty()) return;
    for (Crossing& crossing : crossings) {
        const bool beside = std::any_of(misfits.begin(), misfits.end(), [&](const Crossing* misfit) {
            return std::max(std::abs(misfit->x - crossing.x), std::abs(misfit->y - crossing.y)) < 1.5F;
        });
        if (beside)
            crossing.excess = std::max(crossing.excess, excess_of(crossing, usual, most_beside_misfit));
        if (crossing.excess > 1.0F)
            for (std::size_t at = crossing.first; at < crossing.last; ++at)
                excess[at] = std::max(excess[at], crossing.excess);
    }
}

}  // namespace fidservo::vision

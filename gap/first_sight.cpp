#include "gap/first_sight.h"

#include "gap/score.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

/// The base with an effect at a size that is a share of the given one.
Hypothesis with(const Hypothesis& base, const Candidate& candidate, const std::vector<double>& shape,
                const Eigen::VectorXd& share) {
    std::vector<double> values = shape;
    for (std::size_t k = 0; k < candidate.sizes.size(); ++k) {
        const std::size_t at = candidate.sizes[k];
        const plant::EffectParameter& parameter = candidate.effect->parameters[at];
        values[at] = std::clamp(
            parameter.vanishing + share(static_cast<Eigen::Index>(k)) * (shape[at] - parameter.vanishing),
            parameter.low, parameter.high);
    }
    Hypothesis changed = base;
    changed.push_back({candidate.effect, values});
    return changed;
}

/// Shares of the sizes that make the errors smallest, weighted by the loss at the base.
Eigen::VectorXd best_shares(std::span<const Window> windows, const Wanted& counted, const Errors& base,
                            const std::vector<Errors>& changes) {
    const auto width = static_cast<Eigen::Index>(changes.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(width), change(width);
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0) continue;
        Eigen::MatrixXd own = Eigen::MatrixXd::Zero(width, width);
        Eigen::VectorXd own_right = Eigen::VectorXd::Zero(width);
        double squares = 0.0, count = 0.0;
        for (std::size_t row = windows[w].begin; row < windows[w].end; ++row) {
            if (std::isnan(base[row])) continue;
            for (Eigen::Index k = 0; k < width; ++k) {
                const float value = changes[static_cast<std::size_t>(k)][row];
                change(k) = std::isfinite(value) ? value : 0.0F;
            }
            own.selfadjointView<Eigen::Lower>().rankUpdate(change);
            own_right -= static_cast<double>(base[row]) * change;
            squares += static_cast<double>(base[row]) * base[row];
            count += 1.0;
        }
        if (count == 0.0) continue;
        normal += own / (count + squares);
        right += own_right / (count + squares);
    }
    const Eigen::MatrixXd full = normal.selfadjointView<Eigen::Lower>();
    return full.completeOrthogonalDecomposition().solve(right);
}

/// Errors if they changed in proportion to the sizes.
Errors added(const Errors& base, const std::vector<Errors>& changes, const Eigen::VectorXd& shares) {
    Errors sum = base;
    for (std::size_t k = 0; k < changes.size(); ++k)
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += static_cast<float>(shares(static_cast<Eigen::Index>(k))) * changes[k][i];
    return sum;
}

}  // namespace

std::vector<Promise> at_first_sight(const Predict& predict, std::span<const Window> windows,
                                    const Wanted& counted, const Hypothesis& base, const Errors& base_errors,
                                    const Candidate& candidate) {
    constexpr double probe = 0.25;  // of the typical size
    constexpr std::size_t most_places = 8, most_starts = 4;
    const auto width = static_cast<Eigen::Index>(candidate.sizes.size());
    struct Place {
        std::vector<double> shape;
        Eigen::VectorXd shares;
        double expected_gain;  ///< if errors changed in proportion to the sizes
        double probe_gain;     ///< of a small size, really
    };
    const std::vector<double> base_squares = mean_squares(windows, base_errors);
    std::vector<Place> places;
    for (const std::vector<double>& shape : candidate.shapes) {
        std::vector<Errors> changes;
        double probe_gain = -std::numeric_limits<double>::infinity();
        for (Eigen::Index k = 0; k < width; ++k) {
            Errors change = predict(with(base, candidate, shape, probe * Eigen::VectorXd::Unit(width, k)));
            if (change.empty()) break;
            probe_gain = std::max(probe_gain, gained(windows, counted, base_squares, change));
            for (std::size_t i = 0; i < change.size(); ++i)
                change[i] = (change[i] - base_errors[i]) / static_cast<float>(probe);
            changes.push_back(std::move(change));
        }
        if (static_cast<Eigen::Index>(changes.size()) < width) continue;
        const Eigen::VectorXd shares = best_shares(windows, counted, base_errors, changes);
        const double expected = gained(windows, counted, base_squares, added(base_errors, changes, shares));
        places.push_back({shape, shares, expected, probe_gain});
    }
    std::ranges::sort(places, std::greater{}, &Place::expected_gain);
    if (places.size() > most_places / 2)  // the others by what is not extrapolated
        std::ranges::sort(places.begin() + most_places / 2, places.end(), std::greater{}, &Place::probe_gain);
    std::vector<Promise> starts;
    for (std::size_t p = 0; p < std::min(places.size(), most_places); ++p) {
        Promise best{base, -std::numeric_limits<double>::infinity()};
        for (const double part : {1.0, 0.4, 2.5}) {
            const Hypothesis there = with(base, candidate, places[p].shape, part * places[p].shares);
            const double gain = gained(windows, counted, base_squares, predict(there));
            if (gain > best.gain) best = {there, gain};
        }
        starts.push_back(best);
    }
    std::ranges::sort(starts, std::greater{}, &Promise::gain);
    if (starts.size() > most_starts) starts.resize(most_starts);
    return starts;
}

}  // namespace fidservo::gap

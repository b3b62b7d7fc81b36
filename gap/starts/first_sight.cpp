// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/first_sight.h"

#include "core/parallel.h"
#include "gap/fit/score.h"
#include "gap/fit/slopes.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

/// The settings that may be refitted, changed by the given numbers of scales.
Hypothesis moved(const ScaledParameters& parameters, const Eigen::VectorXd& scales) {
    std::vector<double> values = parameters.values;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] += scales(static_cast<Eigen::Index>(k));
    return parameters.at(values);
}

/// The settings that may be refitted, changed by the given numbers of scales, followed by the candidate.
Hypothesis moved(const Surroundings& beside, const Eigen::VectorXd& scales, plant::EffectSetting added) {
    Hypothesis part = moved(beside.parameters, scales);
    part.push_back(std::move(added));
    return part;
}

/// Whether a size may lie on either side of the value at which the effect vanishes.
bool has_other_side(const Candidate& candidate) {
    return std::ranges::any_of(candidate.sizes, [&](std::size_t k) {
        const plant::EffectParameter& parameter = candidate.effect->parameters[k];
        return parameter.low < parameter.vanishing;
    });
}

}  // namespace

plant::EffectSetting sized(const Candidate& candidate, const std::vector<double>& shape,
                           const Eigen::VectorXd& shares) {
    std::vector<double> values = shape;
    for (std::size_t k = 0; k < candidate.sizes.size(); ++k) {
        const std::size_t at = candidate.sizes[k];
        const plant::EffectParameter& parameter = candidate.effect->parameters[at];
        values[at] = std::clamp(
            parameter.vanishing + shares(static_cast<Eigen::Index>(k)) * (shape[at] - parameter.vanishing),
            parameter.low, parameter.high);
    }
    return {candidate.effect, std::move(values)};
}

Surroundings surroundings(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
                          const Hypothesis& base, const Errors& base_errors, const Places& places) {
    const ScaledParameters parameters(part_of(base, places));
    const Predict predict_part = [&](const Hypothesis& part) {
        return predict(with_part(base, places, part));
    };
    std::vector<Errors> slopes(parameters.size());
    parallel_for(slopes.size(),
                 [&](std::size_t k) { slopes[k] = slope(predict_part, parameters, k, base_errors); });
    Surroundings beside{
        base, base_errors, places, parameters, LinearErrors(windows, base_errors, std::move(slopes)), {}};
    if (parameters.size() > 0)
        beside.moved = predict_part(moved(parameters, beside.linear.optimum(counted).shares));
    return beside;
}

Promise promise_of(plant::EffectSetting setting, const Predict& predict, std::span<const Window> windows,
                   const Wanted& counted, const Surroundings& beside, std::span<const double> base_squares) {
    Hypothesis part = part_of(beside.base, beside.places);
    part.push_back(std::move(setting));
    const double gain =
        gained(windows, counted, base_squares, predict(extended(beside.base, beside.places, part)));
    return {std::move(part), gain};
}

std::vector<Promise> at_first_sight(const Predict& predict, std::span<const Window> windows,
                                    const Wanted& counted, const Surroundings& beside,
                                    const Candidate& candidate) {
    constexpr double probe = 0.25;  // share of the typical size with which responses are computed
    constexpr double hopeless_gain = 0.4 * least_gain;
    constexpr double shorter = 0.4, further = 2.5, furthest = 100.0;
    constexpr std::size_t most_places = wide_beam;
    const auto width = static_cast<Eigen::Index>(candidate.sizes.size());
    const auto moving = beside.linear.size();
    const Eigen::VectorXd unmoved = Eigen::VectorXd::Zero(moving);
    struct Place {
        std::vector<double> shape;
        Eigen::VectorXd steps;  ///< scales of what may be refitted, then shares of the sizes
        double expected_gain;   ///< gain of the steps, by linear extrapolation
        double probe_gain;      ///< gain of a small size, by a prediction
    };
    const std::vector<double> base_squares = mean_squares(windows, beside.errors);
    const double without =
        beside.moved.empty() ? 0.0 : std::max(0.0, gained(windows, counted, base_squares, beside.moved));
    std::vector<Place> places;
    const auto is_hopeless = [&](const Place& place) {
        return place.expected_gain - without < hopeless_gain && place.probe_gain <= 0.0;
    };
    const auto probed = [&](const std::vector<double>& shape, double share) -> std::optional<Place> {
        std::vector<Errors> changes;
        double probe_gain = -std::numeric_limits<double>::infinity();
        for (Eigen::Index k = 0; k < width; ++k) {
            const Hypothesis part =
                moved(beside, unmoved, sized(candidate, shape, share * Eigen::VectorXd::Unit(width, k)));
            Errors change = predict(extended(beside.base, beside.places, part));
            if (change.empty()) return {};
            probe_gain = std::max(probe_gain, gained(windows, counted, base_squares, change));
            for (std::size_t i = 0; i < change.size(); ++i)
                change[i] = (change[i] - beside.errors[i]) / static_cast<float>(share);
            changes.push_back(std::move(change));
        }
        LinearErrors::Optimum optimum = beside.linear.optimum(counted, std::move(changes));
        const double expected = gained(counted, base_squares, optimum.mean_squares);
        return Place{shape, std::move(optimum.shares), expected, probe_gain};
    };
    for (const std::vector<double>& shape : candidate.shapes) {
        std::optional<Place> place = probed(shape, probe);
        // A cold wire cannot respond in one direction, which says nothing about the other one.
        if (place && is_hopeless(*place) && has_other_side(candidate)) place = probed(shape, -probe);
        if (place && !is_hopeless(*place)) places.push_back(*std::move(place));
    }
    std::ranges::sort(places, std::greater{}, &Place::expected_gain);
    if (places.size() > most_places / 2)  // the further ones are ranked by gains that are not extrapolated
        std::ranges::sort(places.begin() + most_places / 2, places.end(), std::greater{}, &Place::probe_gain);
    places.resize(std::min(places.size(), most_places));
    const auto stepped = [&](const Place& place, const Eigen::VectorXd& rest, const Eigen::VectorXd& shares) {
        Hypothesis there = moved(beside, rest, sized(candidate, place.shape, shares));
        const double gain =
            gained(windows, counted, base_squares, predict(extended(beside.base, beside.places, there)));
        return Promise{std::move(there), gain};
    };
    const auto part_of_steps = [&](const Place& place, double part) {
        return stepped(place, part * place.steps.head(moving), part * place.steps.tail(width));
    };
    struct Seen {
        const Place* place;
        Promise best;
    };
    std::vector<Seen> seen;
    seen.reserve(places.size());
    for (const Place& place : places) seen.push_back({&place, part_of_steps(place, 1.0)});
    std::ranges::stable_sort(seen, std::greater{}, [](const Seen& one) { return one.best.gain; });
    seen.resize(std::min(seen.size(), most_starts));
    std::vector<Promise> starts;
    for (auto& [place, best] : seen) {
        const auto improves = [&, &best = best](Promise other) {
            if (!(other.gain > best.gain)) return false;
            best = std::move(other);
            return true;
        };
        const double ratio = best.gain / place->expected_gain;
        // Other values of its sizes may suit another shape.
        const bool has_no_shape = candidate.shapes.size() == 1;
        const bool is_linear =
            has_no_shape && place->expected_gain > 0.0 && ratio > nearly_all && ratio < 1.0 / nearly_all;
        if (!is_linear) {
            improves(part_of_steps(*place, shorter));
            // Far from the optimum the linear step is much too short: lengthen it as long as that helps.
            for (double part = further; part < furthest && improves(part_of_steps(*place, part));)
                part *= further;
        }
        if (moving > 0) improves(stepped(*place, unmoved, place->steps.tail(width)));
        if (best.gain - without < hopeless_gain)
            improves(stepped(*place, unmoved, Eigen::VectorXd::Ones(width)));
        starts.push_back(std::move(best));
    }
    std::ranges::sort(starts, std::greater{}, &Promise::gain);
    std::erase_if(starts, [&](const Promise& start) { return start.gain - without < hopeless_gain; });
    return starts;
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/incremental_prediction.h"

#include "gap/candidates/coupling.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

/// Indices at which a hypothesis differs from another one that has the same effects, or all but its last.
std::vector<std::size_t> differences(const Hypothesis& hypothesis, const Hypothesis& other) {
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < hypothesis.size(); ++k)
        if (k >= other.size() || !(hypothesis[k] == other[k])) places.push_back(k);
    return places;
}

}  // namespace

Errors IncrementalPrediction::operator()(const Hypothesis& settings) {
    Hypothesis whole = beside_;
    whole.insert(whole.end(), settings.begin(), settings.end());
    std::shared_ptr<const Known> known;
    {
        const std::scoped_lock lock(access_);
        known = known_;
    }
    if (!known || known->errors.empty() || settings.size() < known->settings.size())
        return predicted_whole(std::move(whole), settings);
    const std::vector<std::size_t> places = differences(settings, known->settings);
    if (places.empty()) return known->errors;
    if (places.size() > 1) return predicted_whole(std::move(whole), settings);
    const plant::EffectSetting& other = settings[places.front()];
    SignalFlags signals = reached_by({other});
    if (moves_carriage(*other.effect) && evidence_.platform_feels_carriage(whole))
        signals[index_of(Signal::hall)] = true;
    const std::vector<Window>& windows = evidence_.windows();
    const Wanted reached = only_of(windows, wanted_, signals);
    const Errors again = evidence_.errors(whole, reached, 0.0, known->paths.get());
    if (again.empty()) return again;
    Errors errors = known->errors;
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (reached[w] != 0)
            std::copy(again.begin() + static_cast<std::ptrdiff_t>(windows[w].begin),
                      again.begin() + static_cast<std::ptrdiff_t>(windows[w].end),
                      errors.begin() + static_cast<std::ptrdiff_t>(windows[w].begin));
    return errors;
}

Errors IncrementalPrediction::predicted_whole(Hypothesis whole, const Hypothesis& settings) {
    std::shared_ptr<const CarriagePaths> paths;
    {
        const std::scoped_lock lock(access_);
        if (known_) paths = known_->paths;
    }
    paths = evidence_.paths(whole, wanted_, std::move(paths));
    Known now{settings, evidence_.errors(whole, wanted_, 0.0, paths.get()), std::move(paths)};
    auto shared = std::make_shared<const Known>(std::move(now));
    const std::scoped_lock lock(access_);
    known_ = shared;
    return shared->errors;
}

}  // namespace fidservo::gap

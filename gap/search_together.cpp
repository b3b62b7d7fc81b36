// All smooth candidates at once, of wire and view beside what is known of the carriage.
#include "gap/everything.h"
#include "gap/search.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {
namespace {

/// One smooth candidate of each class, that which a hypothesis has if it has one.
std::vector<const Candidate*> smooth_ones(const std::vector<Candidate>& all, const Hypothesis& known) {
    const auto is_known = [&](const Candidate& candidate) {
        return std::ranges::find(known, candidate.effect, &plant::EffectSetting::effect) != known.end();
    };
    std::vector<const Candidate*> found;
    for (const Candidate& candidate : all) {
        if (!is_smooth(candidate)) continue;
        const auto same = std::ranges::find(found, candidate.class_name, &Candidate::class_name);
        if (same == found.end())
            found.push_back(&candidate);
        else if (is_known(candidate))
            *same = &candidate;
    }
    return found;
}

}  // namespace

Search::Together Search::everything_beside(const CrossFit& base) const {
    constexpr SignalFlags smooth{false, true, true, false, false, false};
    const std::vector<const Candidate*> all = smooth_ones(candidates_, base.of_half[0]);
    const auto is_among = [&](const plant::EffectSetting& setting) {
        return std::ranges::find(all, setting.effect, &Candidate::effect) != all.end();
    };
    const Evidence& evidence = fitter_.evidence();
    std::array<Hypothesis, 2> beside = base.of_half;
    for (Hypothesis& hypothesis : beside) std::erase_if(hypothesis, is_among);
    Hypothesis begun = base.of_half[0];
    std::erase_if(begun, [&](const plant::EffectSetting& setting) { return !is_among(setting); });
    std::array<Wanted, 2> wanted;
    for (std::size_t side = 0; side < 2; ++side)
        wanted[side] = only_of(evidence.windows(), fitter_.half(side), smooth);
    return together(beside, needed_of_everything(evidence, all, beside, begun, wanted));
}

Search::Together Search::together(const std::array<Hypothesis, 2>& beside, NeededCandidates needed) const {
    Together together{
        std::move(needed.candidates), std::move(needed.worth), {.of_half = beside, .mean_squares = {}}};
    for (std::size_t side = 0; side < 2; ++side)
        together.fitted.of_half[side].insert(together.fitted.of_half[side].end(),
                                             needed.of_half[side].begin(), needed.of_half[side].end());
    fitter_.judge(together.fitted);
    return together;
}

}  // namespace fidservo::gap

#include "gap/search_memory.h"

#include <algorithm>

namespace fidservo::gap {
namespace {

bool equal(const Hypothesis& left, const Hypothesis& right) {
    return std::ranges::equal(left, right, [](const plant::EffectSetting& a, const plant::EffectSetting& b) {
        return a.effect == b.effect && a.values == b.values;
    });
}

}  // namespace

Finding& SearchMemory::of(std::size_t candidate, const std::array<Hypothesis, 2>& beside) {
    std::deque<Finding>& known = findings_[candidate];
    const auto found = std::ranges::find_if(known, [&](const Finding& finding) {
        return equal(finding.beside[0], beside[0]) && equal(finding.beside[1], beside[1]);
    });
    if (found != known.end()) return *found;
    Finding& fresh = known.emplace_back();
    fresh.beside = beside;
    return fresh;
}

}  // namespace fidservo::gap

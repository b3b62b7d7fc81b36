#include "gap/remainder.h"

#include "gap/gap_size.h"
#include "gap/halves.h"
#include "gap/surrogate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

/// A remainder below this is not worth a finding, whatever its significance.
constexpr double least_floors = 1.1;
/// What is above this is a gap, whether or not anything is found that it depends on.
constexpr double clear_floors = 1.25;

/// Errors of what was fitted on the other half.
Errors held_out_errors(const Evidence& evidence, const CrossFit& explained,
                       std::span<const std::uint8_t> half) {
    const Wanted wanted = everything(evidence);
    Errors errors = evidence.errors(explained.of_half[1], wanted);
    const Errors other = evidence.errors(explained.of_half[0], wanted);
    for (std::size_t w = 0; w < half.size(); ++w)
        if (half[w] == 1)
            for (std::size_t k = evidence.windows()[w].begin; k < evidence.windows()[w].end; ++k)
                errors[k] = other[k];
    return errors;
}

/// A block for what is left of a signal and depends on nothing that was looked at.
std::string_view likely_block(Signal signal) {
    switch (signal) {
        case Signal::encoder:
            return "macro.mechanics";
        case Signal::hall:
            return "micro.heater";
        case Signal::tag:
            return "camera.geometry";
        case Signal::macro_command:
        case Signal::micro_command:
            break;
    }
    return "controller";
}

/// Groups of the signal's surrogate that predict what was not fitted, and the surrogate's period.
struct Dependences {
    std::vector<int> groups;
    double period_mm = 0.0;
};

Dependences dependences(const Evidence& evidence, Signal signal, const Errors& errors,
                        std::span<const std::uint8_t> half, double tail) {
    if (signal != Signal::encoder && signal != Signal::hall) return {};
    const Surrogate surrogate =
        signal == Signal::encoder ? carriage_surrogate(evidence, errors) : platform_surrogate(evidence);
    const Regression regression(evidence.windows(), signal, errors, surrogate.columns, surrogate.nuisances,
                                half);
    return {regression.significant_groups(tail), surrogate.period_mm};
}

Remainder remainder_of_signal(const Evidence& evidence, Signal signal, double floors,
                              const Dependences& found) {
    Remainder remainder{std::string(likely_block(signal)), {}, {}};
    for (const int group : found.groups) {
        const auto dependence = static_cast<Dependence>(group);
        std::string name(name_of(dependence));
        if (dependence == Dependence::position_period) name += fmt::format(" ({:.3g} mm)", found.period_mm);
        remainder.depends_on.push_back(std::move(name));
    }
    if (!found.groups.empty())
        remainder.block = block_of(signal, static_cast<Dependence>(found.groups.front()));
    remainder.text =
        fmt::format("{}: {:.3g} {} r.m.s. ({:.3g} floors) remain that no effect explains; {}",
                    name_of(signal), floors * evidence.floor(signal), unit_of(signal), floors,
                    remainder.depends_on.empty()
                        ? std::string("nothing was found that they depend on")
                        : fmt::format("they depend on {}", fmt::join(remainder.depends_on, ", ")));
    return remainder;
}

}  // namespace

std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail) {
    const std::vector<std::uint8_t> half = halves(evidence);
    const Errors errors = held_out_errors(evidence, explained, half);
    std::optional<Remainder> largest;
    double largest_floors = 0.0;
    for (const SignalGap& gap : signal_gaps(evidence, explained.mean_squares, explained.mean_squares)) {
        const double floors = gap.after / gap.floor;
        if (floors < least_floors || floors < largest_floors) continue;
        const Dependences found = dependences(evidence, gap.signal, errors, half, tail);
        if (found.groups.empty() && floors < clear_floors) continue;
        largest = remainder_of_signal(evidence, gap.signal, floors, found);
        largest_floors = floors;
    }
    return largest;
}

}  // namespace fidservo::gap

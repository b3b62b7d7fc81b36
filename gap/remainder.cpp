#include "gap/remainder.h"

#include "gap/halves.h"

#include "gap/gap_size.h"
#include "gap/surrogate.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

/// A remainder below this is not worth a finding, whatever its significance.
constexpr double least_floors = 1.1;

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

/// R.m.s. of the windows' errors in floors.
double rms(const Evidence& evidence, Signal signal, std::span<const double> squares) {
    double sum = 0.0, count = 0.0;
    for (std::size_t w = 0; w < squares.size(); ++w) {
        const Window& window = evidence.windows()[w];
        if (window.signal != signal || std::isnan(squares[w])) continue;
        sum += squares[w] * static_cast<double>(window.end - window.begin);
        count += static_cast<double>(window.end - window.begin);
    }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

struct SignalRemainder {
    Remainder remainder;
    double floors = 0.0;
};

std::optional<SignalRemainder> of_signal(const Evidence& evidence, const CrossFit& explained,
                                         const Errors& errors, const Surrogate& surrogate,
                                         std::span<const std::uint8_t> half, double tail) {
    const double floors = rms(evidence, surrogate.signal, explained.mean_squares);
    const Regression regression(evidence.windows(), surrogate.signal, errors, surrogate.columns,
                                surrogate.nuisances, half);
    const std::vector<int> groups = regression.significant_groups(tail);
    if (groups.empty()) return {};
    SignalRemainder found{{}, floors};
    for (const int group : groups) {
        const auto dependence = static_cast<Dependence>(group);
        std::string name(name_of(dependence));
        if (dependence == Dependence::position_period)
            name += fmt::format(" ({:.3g} mm)", surrogate.period_mm);
        found.remainder.depends_on.push_back(std::move(name));
    }
    found.remainder.block = block_of(surrogate.signal, static_cast<Dependence>(groups.front()));
    found.remainder.text =
        fmt::format("{}: {:.3g} {} r.m.s. ({:.3g} floors) remain that no effect explains; they depend on {}",
                    name_of(surrogate.signal), floors * evidence.floor(surrogate.signal),
                    unit_of(surrogate.signal), floors, fmt::join(found.remainder.depends_on, ", "));
    return found;
}

}  // namespace

std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail) {
    const std::vector<std::uint8_t> half = halves(evidence);
    const Errors errors = held_out_errors(evidence, explained, half);
    std::optional<SignalRemainder> largest;
    using Make = Surrogate (*)(const Evidence&, const Errors&);
    constexpr std::array<std::pair<Signal, Make>, 2> makers{
        {{Signal::encoder, carriage_surrogate}, {Signal::hall, platform_surrogate}}};
    for (const auto& [signal, surrogate_of] : makers) {
        if (rms(evidence, signal, explained.mean_squares) < least_floors) continue;
        const auto found = of_signal(evidence, explained, errors, surrogate_of(evidence, errors), half, tail);
        if (found && (!largest || found->floors > largest->floors)) largest = found;
    }
    if (!largest) return {};
    return largest->remainder;
}

}  // namespace fidservo::gap

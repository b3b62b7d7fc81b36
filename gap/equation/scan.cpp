// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/scan.h"

#include "core/parallel.h"
#include "gap/equation/losing.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace fidservo::gap {

namespace {

/// A large error of the quantity at a port, in the port's unit.
double usual_amount(plant::Port port) {
    constexpr double of_power = 10.0, of_heat = 5.0, of_place_or_voltage = 0.1, of_view = 0.02;
    switch (port) {
        case plant::Port::heater_power:
            return of_power;
        case plant::Port::heat_flow:
        case plant::Port::transformation:
            return of_heat;
        case plant::Port::contraction:
        case plant::Port::platform:
        case plant::Port::hall_voltage:
            return of_place_or_voltage;
        default:
            return of_view;
    }
}

}  // namespace

std::vector<Sketch> scanned(const Evidence& evidence, const CrossFit& beside, plant::Port port,
                            const std::vector<Term>& terms, std::size_t count) {
    const plant::Site site = plant::describe(port).site;
    if (site != plant::Site::micro && site != plant::Site::camera) return {};
    constexpr std::size_t few = 4;
    constexpr std::array amounts{-1.0, -0.2, 0.2, 1.0};
    const Wanted wanted =
        where_most_is_lost(evidence, site == plant::Site::micro ? Signal::hall : Signal::tag,
                           beside.mean_squares, 1.0, few, few);
    struct Scanned {
        double loss;
        Sketch sketch;
    };
    std::vector<Scanned> found(terms.size(), {std::numeric_limits<double>::infinity(), {}});
    parallel_for(terms.size(), [&](std::size_t t) {
        const Term& term = terms[t];
        if (term.texts.size() > 1) return;
        Scanned& best = found[t];
        for (const double amount : amounts) {
            const Sketch sketch{port, {term}, {amount * usual_amount(port) / term.size}};
            Hypothesis with = beside.of_half[0];
            with.push_back(plant::typical_setting(
                plant::effect_of(formula_of(sketch, plant::describe(port).blocks.front(), "term"))));
            const double loss = total_loss(evidence.windows(), wanted, evidence.errors(with, wanted));
            if (loss < best.loss) best = {loss, sketch};
        }
    });
    std::ranges::stable_sort(found, {}, &Scanned::loss);
    std::vector<Sketch> leading;
    for (std::size_t k = 0; k < std::min<std::size_t>(count, found.size()); ++k)
        if (std::isfinite(found[k].loss)) leading.push_back(std::move(found[k].sketch));
    return leading;
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/equation_score.h"

#include "core/rig.h"
#include "gap/equation/visited.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"

#include <cmath>
#include <set>
#include <span>
#include <vector>

namespace fidservo::selfcheck {

namespace {

using plant::FormulaCode;
using plant::Port;
using plant::Site;

/// What formulas at different ports have in common.
enum class Quantity { force, heat, own };

Quantity quantity_of(Port port) {
    switch (port) {
        case Port::drive_voltage:
        case Port::force:
        case Port::friction:
            return Quantity::force;
        case Port::heater_power:
        case Port::heat_flow:
            return Quantity::heat;
        default:
            return Quantity::own;
    }
}

/// By what a port's value is the quantity, at one moment; NaN where it does not count.
double share_of(Port port, const gap::SeenVariables& seen, const Rig& rig) {
    constexpr double moving_mm_per_s = 1.0;
    switch (quantity_of(port)) {
        case Quantity::force:
            if (!(std::abs(seen[plant::carriage_variable::speed]) > moving_mm_per_s)) return std::nan("");
            return port == Port::friction ? 1.0 : -1.0;
        case Quantity::heat: {
            if (port == Port::heat_flow) return 1.0;
            using namespace plant::micro_variable;
            const bool heats = seen[heater_power] > seen[wire_temp] - seen[room_temp];
            const HeaterParameters& heater = rig.micro->heater;
            return 1.0 / (heats ? heater.heating_tau_s : heater.cooling_tau_s);
        }
        case Quantity::own:
            return 1.0;
    }
    return 1.0;
}

std::vector<double> quantity_along(const gap::Evidence& evidence, const FormulaCode& code,
                                   std::span<const double> parameters) {
    std::vector<double> all;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run) {
        const auto seen = gap::variables_along(evidence, code.port().site, run);
        const std::vector<double> values = gap::values_along(evidence, code, parameters, run);
        for (std::size_t k = 0; k < values.size(); ++k)
            all.push_back(share_of(code.port().port, seen[k], evidence.rig()) * values[k]);
    }
    return all;
}

/// Over the true function's size.
double apart(const gap::Evidence& evidence, const FormulaCode& truth, std::span<const double> true_values,
             const FormulaCode& found, std::span<const double> values) {
    const Port port = truth.port().port, other = found.port().port;
    const bool share_a_quantity =
        quantity_of(port) == Quantity::own ? port == other : quantity_of(port) == quantity_of(other);
    if (!share_a_quantity) return 1.0;
    const std::vector<double> right = quantity_along(evidence, truth, true_values),
                              proposed = quantity_along(evidence, found, values);
    double sum = 0.0, proposed_sum = 0.0, count = 0.0;
    for (std::size_t k = 0; k < right.size(); ++k) {
        if (!std::isfinite(right[k]) || !std::isfinite(proposed[k])) continue;
        sum += right[k];
        proposed_sum += proposed[k];
        count += 1.0;
    }
    if (count == 0.0) return 1.0;
    const bool has_zero = truth.port().site != Site::encoder;
    const double mean = has_zero ? 0.0 : sum / count, proposed_mean = has_zero ? 0.0 : proposed_sum / count;
    double different = 0.0, size = 0.0;
    for (std::size_t k = 0; k < right.size(); ++k) {
        if (!std::isfinite(right[k]) || !std::isfinite(proposed[k])) continue;
        different += std::pow((proposed[k] - proposed_mean) - (right[k] - mean), 2);
        size += std::pow(right[k] - mean, 2);
    }
    return std::sqrt(different / size);
}

/// Those that say the same: a heater's power follows its command; friction always has the direction; the
/// room's temperature hardly changes.
std::set<std::string> variables_of(const FormulaCode& code) {
    const std::vector<std::string> used = code.variable_names();
    std::set<std::string> names(used.begin(), used.end());
    names.erase("direction");
    names.erase("room_temp");
    if (names.erase("heater_command") > 0) names.insert("heater_power");
    if (names.erase("voltage") > 0) names.insert("command");
    return names;
}

}  // namespace

EquationScore score_equation(const FormulaEffect& truth, const gap::Diagnosis& diagnosis,
                             const gap::Evidence& evidence) {
    EquationScore score;
    const gap::Equation* equation = gap::proposed_equation(diagnosis);
    if (equation == nullptr) return score;
    const FormulaCode &found = *equation->setting.effect->formula, &right = FormulaCode::of(truth);
    const plant::EffectSetting whole = plant::typical_setting(plant::effect_of(truth));
    score.acts_on = equation->acts_on;
    score.formula = equation->formula;
    score.right_variables = variables_of(found) == variables_of(right);
    score.apart = apart(evidence, right, whole.values, found, equation->setting.values);
    score.removed = equation->gap_removed;
    score.removed_of_kinds_left_out = equation->gap_removed_of_kinds_left_out;
    return score;
}

}  // namespace fidservo::selfcheck

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/together.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace fidservo::plant {

namespace {

double size_together(Again again, const EffectParameter& parameter, double stated, double beside) {
    constexpr double no_factor = 1.0;
    switch (again) {
        case Again::adds:
            return parameter.vanishing == no_factor ? stated * beside
                                                    : stated + (beside - parameter.vanishing);
        case Again::adds_squares:
            return std::hypot(stated, beside);
        case Again::replaces:
            break;
    }
    return beside;
}

bool gives(const StatedEffect& effect, std::string_view parameter) {
    return std::ranges::find(effect.parameters, parameter, &StatedEffect::Parameter::name) !=
           effect.parameters.end();
}

}  // namespace

StatedEffect together(const StatedEffect& stated, const StatedEffect& beside) {
    FIDSERVO_DEMAND(stated.name == beside.name && !stated.formula && !beside.formula);
    const EffectSetting before = setting_of(stated), more = setting_of(beside);
    const Effect& effect = *more.effect;
    StatedEffect both{stated.name, {}};
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const EffectParameter& parameter = effect.parameters[k];
        double value = before.values[k];
        if (gives(beside, parameter.name))
            value = parameter.is_size() ? size_together(effect.again, parameter, value, more.values[k])
                                        : more.values[k];
        if (!(value >= parameter.low && value <= parameter.high))
            throw InputError(
                fmt::format("{}: {}: {:.6g} with what the rig file states; allowed: {:.6g} to "
                            "{:.6g}",
                            effect.name, parameter.name, value, parameter.low, parameter.high));
        both.parameters.push_back({std::string(parameter.name), value});
    }
    return both;
}

}  // namespace fidservo::plant

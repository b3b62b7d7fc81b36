// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/formulas/formula_effect.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_code.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace fidservo::plant {

namespace {

struct NamedRole {
    std::string_view name;
    Role role;
};
constexpr std::array roles{NamedRole{"size", Role::size}, NamedRole{"shape", Role::shape},
                           NamedRole{"optional", Role::optional}};

/// From which a fit of a shape may begin where its file does not say: spread over the bounds, by ratios where
/// these are of one sign and far apart.
std::vector<double> spread(const FormulaEffect::Parameter& parameter) {
    constexpr int count = 5;
    constexpr double far = 10.0;
    const bool by_ratio =
        parameter.low * parameter.high > 0.0 &&
        std::max(std::abs(parameter.high / parameter.low), std::abs(parameter.low / parameter.high)) > far;
    std::vector<double> values;
    for (int k = 0; k < count; ++k) {
        const double share = (k + 0.5) / count;
        values.push_back(by_ratio ? parameter.low * std::pow(parameter.high / parameter.low, share)
                                  : std::lerp(parameter.low, parameter.high, share));
    }
    return values;
}

/// An optional parameter counts as its vanishing value within this share of its range.
constexpr double negligible_share = 1e-3;

bool is_of_effect_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
}

/// A parameter as a size of the change from a stated value.
EffectParameter change_from(double stated, const FormulaEffect::Parameter& text, EffectParameter parameter) {
    constexpr double share_of_value = 0.2, share_of_range = 0.05;
    const double none = text.role == "size" ? text.vanishing : 0.0;
    const double step =
        stated == none ? share_of_range * (text.high - text.low) : share_of_value * std::abs(stated - none);
    parameter.vanishing = stated;
    parameter.typical = stated + step <= text.high ? stated + step : std::max(text.low, stated - step);
    parameter.role = Role::size;
    parameter.starts = {};
    parameter.negligible = 0.0;
    return parameter;
}

class FormulaOfName {
  public:
    explicit FormulaOfName(const FormulaEffect& text) : text_(text) {
        if (text_.name.empty() || !std::ranges::all_of(text_.name, is_of_effect_name))
            refuse("name", "allowed: letters, digits, _, - and ., so that options can name it");
        if (find_effect(text_.name) != nullptr)
            refuse("name", "is that of a listed effect; allowed: another one");
        const FormulaCode& code = FormulaCode::of(text_);
        if (std::ranges::none_of(text_.parameters,
                                 [](const FormulaEffect::Parameter& of) { return of.role == "size"; }))
            refuse("parameters",
                   "none has the role size, at whose vanishing value the effect is absent; allowed: one or "
                   "more");
        starts_.reserve(text_.parameters.size());
        for (const FormulaEffect::Parameter& parameter : text_.parameters) add(parameter);
        std::vector<double> typical;
        typical.reserve(parameters_.size());
        for (const EffectParameter& parameter : parameters_) typical.push_back(parameter.typical);
        code.demand_extents(typical);
        effect_.name = text_.name;
        effect_.block = text_.block;
        effect_.part = code.port().part;
        effect_.text = text_.text;
        effect_.source = text_.source;
        effect_.parameters = parameters_;
        effect_.needs_place = code.port().site != Site::micro && uses_place(code);
        effect_.again = Again::replaces;
        effect_.formula = &code;
    }
    /// @param stated  the values that a rig file states
    FormulaOfName(const FormulaEffect& text, std::span<const double> stated) : FormulaOfName(text) {
        for (std::size_t k = 0; k < parameters_.size(); ++k)
            parameters_[k] = change_from(stated[k], text_.parameters[k], parameters_[k]);
    }
    FormulaOfName(const FormulaOfName&) = delete;  // the effect points at what is here
    FormulaOfName& operator=(const FormulaOfName&) = delete;

    const Effect& effect() const { return effect_; }

  private:
    [[noreturn]] void refuse(const std::string& key, const std::string& what) const {
        throw InputError(text_.name + ": " + key + ": " + what);
    }

    static bool uses_place(const FormulaCode& code) {
        switch (code.port().site) {
            case Site::carriage:
                return code.uses(carriage_variable::place);
            case Site::encoder:
                return code.uses(encoder_variable::place);
            case Site::micro:
                return code.uses(micro_variable::place);
            case Site::camera:
                return code.uses(camera_variable::camera_place);
        }
        return false;
    }

    void add(const FormulaEffect::Parameter& parameter) {
        const std::string key = "parameters." + parameter.name;
        const auto role = std::ranges::find(roles, parameter.role, &NamedRole::name);
        if (role == roles.end())
            refuse(key + ".role", "\"" + parameter.role + "\"; allowed: size, shape, optional");
        if (!(parameter.low < parameter.high && std::isfinite(parameter.low) &&
              std::isfinite(parameter.high))) {
            std::ostringstream what;
            what << "low is " << parameter.low << ", high " << parameter.high
                 << "; allowed: two finite numbers, low below high";
            refuse(key + ".bounds", what.str());
        }
        for (const auto& [name, value] :
             {std::pair{"vanishing", parameter.vanishing}, {"typical", parameter.typical}})
            if (!(value >= parameter.low && value <= parameter.high)) {
                std::ostringstream what;
                what << "its " << name << " value, " << value
                     << ", is out of its bounds; allowed: " << parameter.low << " .. " << parameter.high;
                refuse(key + "." + name, what.str());
            }
        if (role->role == Role::size && parameter.typical == parameter.vanishing)
            refuse(key + ".typical", "is the vanishing value; allowed: one with which the effect is there");
        starts_.push_back(role->role != Role::shape  ? std::vector<double>{}
                          : parameter.starts.empty() ? spread(parameter)
                                                     : parameter.starts);
        parameters_.push_back(EffectParameter{
            .name = parameter.name,
            .unit = parameter.unit,
            .low = parameter.low,
            .high = parameter.high,
            .vanishing = parameter.vanishing,
            .typical = parameter.typical,
            .meaning = parameter.text,
            .role = role->role,
            .starts = starts_.back(),
            .negligible =
                role->role == Role::optional ? negligible_share * (parameter.high - parameter.low) : 0.0});
    }

    FormulaEffect text_;
    std::vector<std::vector<double>> starts_;
    std::vector<EffectParameter> parameters_;
    Effect effect_{};
};

}  // namespace

const Effect& effect_of(const FormulaEffect& text) {
    static std::mutex guard;
    static std::map<const FormulaCode*, std::unique_ptr<const FormulaOfName>> all;
    const FormulaCode& code = FormulaCode::of(text);
    const std::lock_guard lock(guard);
    std::unique_ptr<const FormulaOfName>& known = all[&code];
    if (!known) known = std::make_unique<const FormulaOfName>(code.effect());
    return known->effect();
}

const Effect& refit_of(const StatedEffect& stated) {
    FIDSERVO_DEMAND(stated.formula.has_value());
    static std::mutex guard;
    static std::map<std::pair<const FormulaCode*, std::vector<double>>, std::unique_ptr<const FormulaOfName>>
        all;
    const FormulaCode& code = FormulaCode::of(*stated.formula);
    const std::vector<double> values = setting_of(stated).values;
    const std::lock_guard lock(guard);
    std::unique_ptr<const FormulaOfName>& known = all[{&code, values}];
    if (!known) known = std::make_unique<const FormulaOfName>(code.effect(), values);
    return known->effect();
}

void add_formula(const FormulaCode& code, PlantParameters& plant, std::span<const double> values,
                 const std::string& stated_at) {
    switch (code.port().site) {
        case Site::carriage:
            plant.axis.formulas.add(code, values, stated_at);
            return;
        case Site::encoder:
            plant.encoder.formulas.add(code, values, stated_at);
            return;
        case Site::micro:
            plant.micro->formulas.add(code, values, stated_at);
            return;
        case Site::camera:
            plant.camera->formulas.add(code, values, stated_at);
            return;
    }
}

}  // namespace fidservo::plant

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects as formulas, in a file of their own or stated in a rig file: format fidservo-effects/1
// (docs/effects.md).
#include "core/rig.h"
#include "plant/effects/effect.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fidservo {

class YamlValue;
namespace plant {
class FormulaFault;
}

/// The effects of a file, in its order. Throws InputError with file, line and key where it is none, an effect
/// cannot be evaluated, or two have one name.
std::vector<const plant::Effect*> load_effects_file(const std::filesystem::path& file);
/// The effects of a parsed file.
std::vector<const plant::Effect*> read_effects_file(const YamlValue& root);

/// Fails at the key of an effect that a fault of its formula names.
/// @param map  the effect as an effects file or a rig file states it
[[noreturn]] void fail_at_formula(const YamlValue& map, const plant::FormulaFault& fault);
/// The same of an effect of an effects file; throws the fault itself if the file has none of its name.
[[noreturn]] void fail_at_formula(const std::filesystem::path& file, const plant::FormulaFault& fault);

/// Throws InputError that names the option if one of its names is of no effect.
/// @param formulas  effects known besides the catalogue
void demand_effects(const char* option, const std::vector<std::string>& names,
                    std::span<const plant::Effect* const> formulas);

/// A formula with the values of its parameters, as a rig file states it: like an entry of an effects file,
/// with `value` beside a parameter's bounds where it is not the typical one.
StatedEffect read_stated_formula(const YamlValue& map);

/// The text that read_stated_formula() reads.
std::string stated_formula_yaml(const StatedEffect& effect);

}  // namespace fidservo

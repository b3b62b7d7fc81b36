// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The effects that a diagnosis tries, and the start values of their fits.
#include "gap/candidates/patch.h"
#include "gap/candidates/wave.h"
#include "gap/evidence.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// An optional parameter of an effect, and start values for its fit.
struct Refinement {
    std::string_view name;
    std::size_t parameter;
    std::vector<double> values;
};

/// An effect together with the grid of its start values.
struct Candidate {
    const plant::Effect* effect;
    std::vector<std::size_t> sizes;  ///< indices of the parameters that are sizes; at least one
    /// Start values of all parameters: sizes at typical values, shapes over a grid.
    std::vector<std::vector<double>> shapes;
    std::optional<WaveParameters> wave;    ///< for an effect that is periodic in position; it has one shape
    std::optional<PatchParameters> patch;  ///< for raised friction around a place
    /// For a scale error of the encoder: the change of scale that changes the reading by a quarter of a count
    /// over the whole way.
    double step_within_counts = 0.0;
    std::string class_name;  ///< shared by effects that no data can distinguish; otherwise the effect's name
    /// This effect is tried as the simpler form of another candidate but not named: without it the richer one
    /// would be named for what both have in common.
    bool is_limit = false;
};

/// The optional parameters, which are not in a candidate's shapes: they are fitted once the rest is known.
std::vector<Refinement> refinements_of(const plant::Effect& effect);

/// A scale error of the encoder in steps to both sides of zero, because its gain has a local maximum for each
/// count that it adds at the far end of the rail. Of other candidates there are none.
std::vector<plant::EffectSetting> settings_within_counts(const Candidate& candidate);

/// How many parameters an effect has without its refinements and choices.
std::size_t unrefined_parameters(const plant::Effect& effect);

/// Whether the carriage's position on the rail is known wherever its reading is judged. If it is not,
/// positions cannot be compared between recordings, and no effect at a place can be named.
bool knows_places(const Evidence& evidence);

/// The effects of the catalogue that the rig can have and a recorded signal can show; those of camera.image
/// only where frames were measured, and those that act at a place only where positions are known. An excluded
/// effect of which another one is a richer form is kept as that one's limit (is_limit).
/// @param only  names to keep; empty: all
/// @param without  names to leave out, with all of their class
/// A formula that the rig file states is tried as one whose parameters may have changed (plant::refit_of).
/// @param formulas  effects besides those of the catalogue
std::vector<Candidate> candidates(const Evidence& evidence, std::span<const std::string> only,
                                  std::span<const std::string> without,
                                  std::span<const plant::Effect* const> formulas = {});

/// The class of an effect.
std::string_view class_of(std::string_view effect);

/// Whether an effect is the simpler form of a richer one, to which that reduces where its additional
/// parameters vanish.
bool is_limit_of(const plant::Effect& plainer, const plant::Effect& richer);

/// The setting of a richer effect's simpler form that does roughly the same.
/// @param richer  has a simpler form
/// @param rail  in the middle of which a spring equals the constant force
plant::EffectSetting plain_form(const plant::EffectSetting& richer, const MacroParameters& rail);

/// Settings of a richer effect as large as its simpler form, over the grid of its shapes; empty where its
/// first parameter does not determine the simpler form's size, or where it has many shapes.
std::vector<plant::EffectSetting> rich_forms(const plant::EffectSetting& plain, const Candidate& richer);

}  // namespace fidservo::gap

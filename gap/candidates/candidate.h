// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The effects that a diagnosis tries, and where their fits may begin.
#include "gap/candidates/patch.h"
#include "gap/candidates/wave.h"
#include "gap/evidence.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// A parameter that an effect may be without, and values from which its fit may begin.
struct Refinement {
    std::string_view name;
    std::size_t parameter;
    std::vector<double> values;
};

/// An effect as a family of hypotheses.
struct Candidate {
    const plant::Effect* effect;
    std::vector<std::size_t> sizes;           ///< parameters that say how large; one at least
    std::vector<std::vector<double>> shapes;  ///< all values, sizes at typical ones, shapes over a grid
    std::optional<WaveParameters> wave;       ///< of an effect periodic in position; it has one shape
    std::optional<PatchParameters> patch;     ///< of friction raised around a place
    /// Of a false scale of the encoder: what changes the reading at the end of the way by a quarter of a
    /// count.
    double step_within_counts = 0.0;
    std::string class_name;  ///< effects that no data can tell apart share it, otherwise the effect's name
    /// Not to be named, but what another candidate comes to where what sets that apart vanishes: without it
    /// the richer one would be named for what it shares with the plainer.
    bool is_limit = false;
};

/// What no candidate's shape has: it is looked for once the rest is known.
std::vector<Refinement> refinements_of(const plant::Effect& effect);

/// How many parameters an effect has without its refinements and choices.
std::size_t unrefined_parameters(const plant::Effect& effect);

/// Whether it is known where on the rail the carriage is wherever its reading is judged. If it is not, places
/// on the rail are not the same ones from recording to recording, and none can be named.
bool knows_places(const Evidence& evidence);

/// Effects of the catalogue that the rig can have and a recorded signal can show; camera.image effects
/// where frames were measured only, and those that act at a place only where places are known.
/// Those left out of which one of the others is a richer form are there as its limits.
/// @param only  names to keep; empty: all
/// @param without  names to leave out, with all of their class
/// @param formulas  effects beside those of the catalogue
std::vector<Candidate> candidates(const Evidence& evidence, std::span<const std::string> only,
                                  std::span<const std::string> without,
                                  std::span<const plant::Effect* const> formulas = {});

/// The class of an effect.
std::string_view class_of(std::string_view effect);

/// Whether an effect is what a richer one comes to where what sets that apart vanishes.
bool is_limit_of(const plant::Effect& plainer, const plant::Effect& richer);

/// The limit of a richer effect that does roughly what that does.
/// @param richer  has a limit
/// @param rail  in whose middle a spring pulls as the constant force does
plant::EffectSetting plain_form(const plant::EffectSetting& richer, const MacroParameters& rail);

/// A richer effect along its shapes, as large as its limit and with what they share; none where its first
/// parameter does not say how large the limit is, or where it has many shapes.
std::vector<plant::EffectSetting> rich_forms(const plant::EffectSetting& plain, const Candidate& richer);

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The true causes of a self-check's case. Only the scoring reads them.
#include "core/formula_effect.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

enum class CaseKind : std::uint8_t {
    none,             ///< the rig is as its file says
    one,              ///< an effect of the catalogue
    two,              ///< two effects of the catalogue, of one block or of two
    withheld,         ///< an effect of the catalogue that the diagnosis may not use
    unlisted,         ///< an effect that the catalogue lacks
    frames,           ///< recordings with frames; an effect of the image
    frames_none,      ///< recordings with frames; the rig is as its file says
    frames_withheld,  ///< recordings with frames; an effect of the image that the diagnosis may not use
    three,            ///< three effects of the catalogue, of three blocks
    /// A dominant effect of the catalogue, eight small ones, and a discrepancy that is no effect of the
    /// catalogue.
    messy,
    messy_none,  ///< as messy, without the dominant effect
    rough,       ///< two large effects and a discrepancy of many floors, of one stage
};
inline constexpr std::size_t kind_count = 12;

/// "none", "one", "two", "withheld", "unlisted", "frames", "frames-none", "frames-withheld", "three",
/// "messy", "messy-none", "rough".
std::string_view name_of(CaseKind kind);

struct TrueEffect {
    std::string effect;      ///< the catalogue's name, or a name of its own
    std::string class_name;  ///< shared by effects that no data can distinguish from it
    std::string block;
    std::string formula;  ///< which formula simulates it; empty: the catalogue's
    double size = 0.0;    ///< in the unit of its draw
    /// The error it is expected to cause, in floors of the signal that shows it most.
    double expected_floors = 0;
    /// The gap that this effect alone causes over all signals, sqrt(gap^2 - 1), measured on the case's
    /// campaign; 0: not measured.
    double gap_floors = 0.0;
    /// For an effect that the diagnosis cannot name: its contribution at a port, if a formula can state it
    /// (draw/true_formula.h).
    std::optional<FormulaEffect> as_formula = {};
};

/// A smooth function that acts on one block of the signal chain and that no effect of the catalogue
/// describes.
struct TrueDiscrepancy {
    std::string block;
    std::string depends_on;   ///< "speed", "place", "contraction", "temperature" or "time"
    double size = 0.0;        ///< r.m.s. over its range: V, or mm of the camera's place
    double gap_floors = 0.0;  ///< as in TrueEffect
};

struct Label {
    CaseKind kind = CaseKind::none;
    std::vector<TrueEffect> effects;  ///< for a messy or rough rig the dominant one is first
    std::optional<TrueDiscrepancy> discrepancy = {};
};

}  // namespace fidservo::selfcheck

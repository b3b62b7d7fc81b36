// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a case of the self-check was made with. The scorer alone reads it.
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
    withheld,         ///< an effect of the catalogue that the diagnosis is not given
    unlisted,         ///< an effect that the catalogue lacks
    frames,           ///< recordings with frames; an effect of the image
    frames_none,      ///< recordings with frames; the rig is as its file says
    frames_withheld,  ///< recordings with frames; an effect of the image that the diagnosis is not given
    three,            ///< three effects of the catalogue, of three blocks
    messy,       ///< a dominant effect of the catalogue, eight small ones, and a discrepancy that none has
    messy_none,  ///< the same without the dominant one
};
inline constexpr std::size_t kind_count = 11;

/// "none", "one", "two", "withheld", "unlisted", "frames", "frames-none", "frames-withheld", "three",
/// "messy", "messy-none".
std::string_view name_of(CaseKind kind);

struct TrueEffect {
    std::string effect;      ///< the catalogue's name, or a name of its own
    std::string class_name;  ///< what no data tell from it shares this
    std::string block;
    std::string formula;         ///< how it was made where there are several ways; empty for the plain one
    double size = 0.0;           ///< in the unit of its draw
    double expected_floors = 0;  ///< by its size, in floors of the signal that shows it most
    /// What this effect alone adds to the gap over all signals, sqrt(gap^2 - 1), as measured on the case's
    /// campaign; 0: not measured.
    double gap_floors = 0.0;
    /// What it adds at a port, where a formula states that (draw/true_formula.h): of effects that no name is
    /// right for.
    std::optional<FormulaEffect> as_formula = {};
};

/// A smooth function that no effect has, on one signal's block.
struct TrueDiscrepancy {
    std::string block;
    std::string depends_on;   ///< "speed", "place", "contraction", "temperature" or "time"
    double size = 0.0;        ///< r.m.s. over its range: V, or mm of the camera's place
    double gap_floors = 0.0;  ///< as of an effect
};

struct Label {
    CaseKind kind = CaseKind::none;
    std::vector<TrueEffect> effects;  ///< of a messy rig the dominant one first
    std::optional<TrueDiscrepancy> discrepancy = {};
};

}  // namespace fidservo::selfcheck

#pragma once
// What a case of the self-check was made with. The scorer alone reads it.
#include <cstdint>
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
};
inline constexpr std::size_t kind_count = 8;

/// "none", "one", "two", "withheld", "unlisted", "frames", "frames-none", "frames-withheld".
std::string_view name_of(CaseKind kind);

struct TrueEffect {
    std::string effect;      ///< the catalogue's name, or a name of its own
    std::string class_name;  ///< what no data tell from it shares this
    std::string block;
    std::string formula;         ///< how it was made where there are several ways; empty for the plain one
    double size = 0.0;           ///< in the unit of its draw
    double expected_floors = 0;  ///< by its size, in floors of the signal that shows it most
};

struct Label {
    CaseKind kind = CaseKind::none;
    std::vector<TrueEffect> effects;
};

}  // namespace fidservo::selfcheck

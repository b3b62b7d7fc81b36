// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The skeleton of every report: one self-contained HTML file that works offline, light and dark.
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::report {

/// The outcome of a run, shown as a colour and a sign.
enum class Mood { good, bad, unsure, neutral };

/// The style sheet's class of a mood.
std::string_view class_of(Mood mood);

/// One figure in the row below the headline.
struct KeyFigure {
    std::string value;
    std::string label;
    Mood mood = Mood::neutral;
};

struct Page {
    std::string title;     ///< of the window
    std::string kind;      ///< what sort of report this is, e.g. "Inspection"
    std::string headline;  ///< the outcome, in one sentence
    std::string subline;   ///< what was done, on what
    Mood mood = Mood::neutral;
    std::vector<KeyFigure> figures;
    std::string body;    ///< sections, as HTML
    std::string footer;  ///< HTML: versions and hashes
};

/// A section with a heading that can be linked to.
std::string section(const std::string& id, const std::string& heading, const std::string& html);

/// The whole HTML file. Scripts and styles are embedded; a content security policy forbids loading anything.
std::string render(const Page& page);

}  // namespace fidservo::report

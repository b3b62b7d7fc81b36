// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::testing {

/// What is wrong with the nesting of an HTML text's elements; empty if nothing is. Scripts and styles are
/// passed over; void elements need no end.
inline std::string nesting_fault(std::string_view html) {
    constexpr std::array<std::string_view, 4> without_end{"meta", "input", "br", "img"};
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string_view::npos; at = html.find('<', at + 1)) {
        const std::size_t end = html.find('>', at);
        if (end == std::string_view::npos) return "an element's tag does not end";
        std::string_view tag = html.substr(at + 1, end - at - 1);
        if (tag.starts_with('!') || tag.ends_with('/')) continue;
        if (tag.starts_with('/')) {
            if (open.empty() || open.back() != tag.substr(1))
                return "</" + std::string(tag.substr(1)) + "> ends " +
                       (open.empty() ? "nothing" : open.back());
            open.pop_back();
            continue;
        }
        const std::string name(tag.substr(0, tag.find_first_of(" \n")));
        if (name == "script" || name == "style") {
            at = html.find("</" + name, end);
            if (at == std::string_view::npos) return name + " does not end";
            continue;
        }
        if (std::find(without_end.begin(), without_end.end(), name) == without_end.end())
            open.push_back(name);
    }
    return open.empty() ? "" : open.back() + " does not end";
}

}  // namespace fidservo::testing

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compare/same_rig.h"

#include "src/files/recording/description.h"
#include "src/files/recording/reader.h"

#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::compare {
namespace {

/// By what it is called, the values that a set's recordings state.
using Statements = std::map<std::string, std::set<std::string>>;

/// What a set states of the rig.
struct StatedRig {
    Statements identity, labels;
};

StatedRig stated_rig(const std::filesystem::path& set) {
    StatedRig stated;
    for (const std::filesystem::path& folder : find_recordings(set)) {
        const std::filesystem::path file = folder / "recording.yaml";
        Recording recording;
        read_description(file, recording);
        const RecordingOrigin origin = read_origin(file);
        stated.identity["rig"].insert(recording.rig);
        if (!origin.unit.empty()) stated.identity["unit"].insert(origin.unit);
        for (const auto& [label, value] : origin.labels) stated.labels[label].insert(value);
    }
    return stated;
}

/// "unit: P-7 in A, P-8 in B; rig: ..."; empty where nothing differs.
std::string differences(const Statements& in_a, const Statements& in_b) {
    std::vector<std::string> all;
    for (const auto& [what, values] : in_a) {
        const auto other = in_b.find(what);
        if (other == in_b.end() || (values.size() == 1 && values == other->second)) continue;
        all.push_back(fmt::format("{}: {} in A, {} in B", what, fmt::join(values, ", "),
                                  fmt::join(other->second, ", ")));
    }
    return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace

std::vector<std::string> notes_on_rigs(const std::filesystem::path& before,
                                       const std::filesystem::path& after) {
    const StatedRig a = stated_rig(before), b = stated_rig(after);
    std::vector<std::string> notes;
    if (const std::string rigs = differences(a.identity, b.identity); !rigs.empty())
        notes.push_back(fmt::format(
            "these recordings state more than one rig ({}): what differs between rigs has not changed in any",
            rigs));
    if (const std::string labels = differences(a.labels, b.labels); !labels.empty())
        notes.push_back(fmt::format("the labels are not the same ({})", labels));
    return notes;
}

}  // namespace fidservo::compare

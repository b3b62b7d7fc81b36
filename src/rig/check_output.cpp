// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/rig/check_output.h"

#include "src/files/disk/durable_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo {

std::string describe(const std::vector<Ability>& abilities, const std::vector<Finding>& findings) {
    std::string text;
    for (const Ability& ability : abilities) {
        const std::string answer = ability.is_possible()     ? "yes"
                                   : ability.missing.empty() ? "no: " + ability.reason
                                                             : "no: " + ability.missing + ": missing";
        text += fmt::format("{:<24} {}\n", ability.command, answer);
    }
    for (const Finding& finding : findings)
        text +=
            fmt::format("{}: {}: {}; usual: {}\n", finding.key, finding.value, finding.why, finding.usual);
    return text + (findings.empty() ? "nothing looks wrong\n"
                                    : fmt::format("{} {} wrong\n", findings.size(),
                                                  findings.size() == 1 ? "number looks" : "numbers look"));
}

void write_rig_check_json(const std::filesystem::path& file, const std::string& rig_name,
                          const std::vector<Ability>& abilities, const std::vector<Finding>& findings) {
    nlohmann::ordered_json json{{"format", "fidservo-rig-check/1"},
                                {"rig", rig_name},
                                {"abilities", nlohmann::json::array()},
                                {"findings", nlohmann::json::array()}};
    for (const Ability& ability : abilities)
        json["abilities"].push_back({{"command", ability.command},
                                     {"possible", ability.is_possible()},
                                     {"missing", ability.missing},
                                     {"reason", ability.reason}});
    for (const Finding& finding : findings)
        json["findings"].push_back(
            {{"key", finding.key}, {"value", finding.value}, {"why", finding.why}, {"usual", finding.usual}});
    write_or_throw(file, json.dump(2) + '\n');
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/campaign_file.h"

#include "core/input_error.h"
#include "src/files/disk/durable_file.h"
#include "src/files/disk/sha256.h"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo {

namespace {

std::filesystem::path campaign_file(const ExperimentOptions& options) {
    return options.out / "campaign.json";
}

nlohmann::ordered_json campaign_json(const ExperimentOptions& options) {
    return {{"format", "fidservo-campaign/1"},
            {"rig_sha256", sha256_of_file(options.session.rig_file)},
            {"seed", options.session.seed},
            {"stage", options.session.stage},
            {"camera", options.session.camera}};
}

}  // namespace

void begin_campaign(const ExperimentOptions& options) {
    write_or_throw(campaign_file(options), campaign_json(options).dump(2) + "\n");
}

void demand_same_campaign(const ExperimentOptions& options) {
    const std::filesystem::path file = campaign_file(options);
    std::ifstream stream(file);
    if (!stream) throw InputError(fmt::format("{}: there is no campaign to resume here", file.string()));
    const auto begun = nlohmann::json::parse(stream, nullptr, false);
    if (!begun.is_object()) throw InputError(fmt::format("{}: is damaged", file.string()));
    const nlohmann::ordered_json now = campaign_json(options);
    for (const auto& [key, value] : now.items())
        if (const auto then = begun.value(key, nlohmann::json()); then != nlohmann::json(value))
            throw InputError(fmt::format("{}: {}: the campaign was begun with {}; now it is {}",
                                         file.string(), key, then.dump(), value.dump()));
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/campaign.h"

#include "core/input_error.h"
#include "src/files/recording/reader.h"
#include "src/fleet/content.h"
#include "src/fleet/task_name.h"

#include <set>
#include <vector>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

namespace fs = std::filesystem;

/// Throws InputError where recordings are of two units.
RecordingOrigin origin_of_all(const std::vector<fs::path>& recordings) {
    RecordingOrigin all;
    std::set<std::string> disputed;
    fs::path of_unit;
    for (const fs::path& folder : recordings) {
        const RecordingOrigin one = read_origin(folder / "recording.yaml");
        if (!one.unit.empty() && !all.unit.empty() && one.unit != all.unit)
            throw InputError(fmt::format("{}: is of the unit {}, and {} is of {}: a campaign is of one unit",
                                         folder.string(), one.unit, of_unit.string(), all.unit));
        if (all.unit.empty() && !one.unit.empty()) {
            all.unit = one.unit;
            of_unit = folder;
        }
        if (!one.recorded_at.empty() && (all.recorded_at.empty() || one.recorded_at < all.recorded_at))
            all.recorded_at = one.recorded_at;
        for (const auto& [key, value] : one.labels)
            if (all.labels.emplace(key, value).first->second != value) disputed.insert(key);
    }
    for (const std::string& key : disputed) all.labels.erase(key);
    return all;
}

}  // namespace

Campaign campaign_of(const fs::path& path) {
    Campaign campaign{.noted = noted_path(path), .content = {}, .origin = {}, .fault = {}};
    std::vector<fs::path> recordings;
    try {
        recordings = find_recordings(path);
        campaign.content = content_of(path, recordings);
        campaign.origin = origin_of_all(recordings);
    } catch (const InputError& error) {
        campaign.fault = error.what();
        if (campaign.content.empty()) campaign.content = content_of(path, {});
    }
    return campaign;
}

}  // namespace fidservo::fleet

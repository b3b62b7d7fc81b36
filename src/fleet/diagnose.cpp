// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/diagnose.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/diagnose/diagnosis_json.h"
#include "src/files/disk/sha256.h"
#include "src/files/rig/rig_file.h"
#include "src/fleet/campaign.h"
#include "src/fleet/content.h"
#include "src/fleet/task_name.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

namespace fidservo::fleet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What all tasks share.
struct Common {
    const DiagnoseRequest& request;
    Rig rig;
    gap::DiagnosisOptions options;
    std::string rig_content, effects_content;
};

Common common_of(const DiagnoseRequest& request) {
    const Rig rig = load_rig(request.rig_file);
    const diagnose::Asked& asked = request.asked;
    return {.request = request,
            .rig = rig,
            .options = diagnose::options_of(asked, rig),
            .rig_content = content_of_files(files_of_rig(request.rig_file)),
            .effects_content = asked.effects_file.empty() ? "" : sha256_of_file(asked.effects_file)};
}

/// All that a result is made from.
std::string key_of(const Common& common, const std::string& content) {
    const DiagnoseRequest& request = common.request;
    const Json inputs{{"kind", "diagnose"},
                      {"content", content},
                      {"rig", common.rig_content},
                      {"effects_file", common.effects_content},
                      {"only", request.asked.only},
                      {"without", request.asked.without},
                      {"matters", request.asked.matters},
                      {"effort_s", request.effort_s},
                      {"program", this_program()}};
    return sha256(inputs.dump());
}

/// The diagnosis of a campaign as `diagnose --json` writes it, and how many rows might be predicted for it.
struct Diagnosed {
    Json diagnosis;
    double rows;
};

Diagnosed diagnose_campaign(const Common& common, const fs::path& path) {
    const diagnose::Answer answer = diagnose::diagnose_recordings(
        common.rig, diagnose::read_recordings({path}), common.options, {.effort_s = common.request.effort_s});
    return {Json::parse(diagnosis_json(answer.diagnosis)),
            (answer.limit.whole_s + answer.limit.equation_s) * gap::rows_a_second};
}

class CampaignTasks {
  public:
    CampaignTasks(const Common& common, const ResultStore& store) : common_(common), store_(store) {}

    TaskEnd work(const fs::path& path) const {
        const Campaign campaign = campaign_of(path);
        const ResultName name = name_of(campaign);
        if (auto end = end_if_there(store_, name)) return *std::move(end);
        Json result = head_of(campaign, name);
        std::string why = campaign.fault;
        if (why.empty()) why = fill(result, path);
        if (campaign_of(path).content != campaign.content)
            return {.outcome = Outcome::undone, .text = "its recordings changed while they were diagnosed"};
        return publish(name, std::move(result), as_noted(std::move(why), path, campaign.noted));
    }

    TaskEnd say_crash(const fs::path& path, std::string_view signal) const {
        const Campaign campaign = campaign_of(path);
        const ResultName name = name_of(campaign);
        return publish(name, head_of(campaign, name), why_crashed(signal));
    }

  private:
    ResultName name_of(const Campaign& campaign) const {
        return {file_stem(campaign.noted), key_of(common_, campaign.content)};
    }

    Json head_of(const Campaign& campaign, const ResultName& name) const {
        const auto or_null = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
        const RecordingOrigin& origin = campaign.origin;
        return {{"format", result_format},
                {"task",
                 {{"kind", "diagnose"},
                  {"campaign", campaign.noted},
                  {"content", campaign.content},
                  {"unit", or_null(origin.unit)},
                  {"recorded_at", or_null(origin.recorded_at)},
                  {"labels", Json(origin.labels)}}},
                {"rig", {{"name", common_.rig.name}, {"content", common_.rig_content}}},
                {"program", this_program()},
                {"effort", std::llround(common_.request.effort_s * gap::rows_a_second)},
                {"key", name.key},
                {"status", "done"}};
    }

    /// @return why there is no diagnosis; empty: there is one
    std::string fill(Json& result, const fs::path& path) const {
        try {
            Diagnosed diagnosed = diagnose_campaign(common_, path);
            for (Json& note : diagnosed.diagnosis["notes"])
                note = as_noted(note.get<std::string>(), path, result["task"]["campaign"].get<std::string>());
            result["effort"] = std::llround(diagnosed.rows);
            result["diagnosis"] = std::move(diagnosed.diagnosis);
            return {};
        } catch (const gap::BudgetEnded&) {
            return "the effort that was allowed was over before anything was predicted";
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const cv::Exception& error) {
            if (error.code == cv::Error::StsNoMem) throw;
            return error.what();
        } catch (const std::exception& error) {
            return error.what();
        }
    }

    TaskEnd publish(const ResultName& name, Json result, std::string why) const {
        std::ranges::replace(why, '\n', ' ');
        if (!why.empty()) {
            result["status"] = "failed";
            result["reason"] = why;
        }
        return publish_result(store_, name, result.dump(2, ' ', false, Json::error_handler_t::replace),
                              std::move(why));
    }

    const Common& common_;
    const ResultStore& store_;
};

/// Sorted, each once, also where it is given by another path, so that shards agree on their numbers however
/// they were given.
std::vector<fs::path> campaigns_of(const DiagnoseRequest& request) {
    std::vector<std::pair<std::string, fs::path>> by_name;
    std::error_code error;
    for (const fs::path& path : request.campaigns) {
        if (!fs::is_directory(path, error))
            throw InputError(fmt::format("{}: there is no such folder", path.string()));
        by_name.emplace_back(noted_path(path), path);
    }
    std::ranges::sort(by_name);
    std::vector<fs::path> campaigns;
    std::set<fs::path> folders;
    std::map<std::string, fs::path> by_stem;
    for (const auto& [noted, path] : by_name) {
        if (!folders.insert(fs::canonical(path)).second) continue;
        const auto [same, is_new] = by_stem.emplace(file_stem(noted), path);
        if (!is_new)
            throw InputError(
                fmt::format("{} and {}: results would note both as {}; allowed: paths that differ in "
                            "their last two folders, or relative ones",
                            same->second.string(), path.string(), noted));
        campaigns.push_back(path);
    }
    return campaigns;
}

}  // namespace

int diagnose_fleet(const DiagnoseRequest& request) {
    const Common common = common_of(request);
    const std::vector<fs::path> campaigns = campaigns_of(request);
    const ResultStore store = open_store(request.run);
    const CampaignTasks tasks(common, store);
    diagnose::keep_memory();
    const TaskWork work{
        .work = [&](std::size_t k) { return tasks.work(campaigns[k]); },
        .say_crash = [&](std::size_t k,
                         std::string_view signal) { return tasks.say_crash(campaigns[k], signal); }};
    return run_fleet(store, request.run, "campaigns", campaigns.size(), work,
                     [&](std::size_t k) { return campaigns[k].string(); })
        .exit_code;
}

}  // namespace fidservo::fleet

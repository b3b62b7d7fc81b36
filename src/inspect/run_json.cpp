// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/run_json.h"

#include "src/files/disk/durable_file.h"

#include <nlohmann/json.hpp>

namespace fidservo::inspect {
namespace {

using nlohmann::ordered_json;

ordered_json json_of_visit(const Visit& visit) {
    ordered_json failures = ordered_json::array();
    for (const FailedAttempt& failed : visit.failures)
        failures.push_back({{"view", failed.view}, {"reason", failed.reason}, {"text", failed.text}});
    ordered_json json{{"site", visit.site},
                      {"again", visit.again},
                      {"end", name_of(visit.end)},
                      {"verdict", name_of(outcome_of(visit))},
                      {"checks", visit.rows.size()},
                      {"from_s", visit.from_s},
                      {"to_s", visit.to_s},
                      {"macro_time_s", visit.macro_time_s},
                      {"micro_time_s", visit.micro_time_s},
                      {"recording", visit.recording},
                      {"failures", failures}};
    return json;
}

/// Ticks, overruns, held ticks, quantiles in us, the histogram as pairs [up to us, ticks] without its empty
/// bins, and whether real-time priority and locked memory were permitted.
ordered_json json_of_loop(const control::LoopStatistics& loop) {
    const control::LatenessHistogram& lateness = loop.lateness;
    ordered_json histogram = ordered_json::array();
    for (std::size_t bin = 0; bin < lateness.counts.size(); ++bin)
        if (lateness.counts[bin] > 0)
            histogram.push_back(
                {microseconds(control::LatenessHistogram::end_ns(bin)), lateness.counts[bin]});
    return {{"ticks", loop.ticks},
            {"overruns", loop.overruns},
            {"held", loop.held},
            {"late_us",
             {{"median", microseconds(lateness.quantile_ns(0.5))},
              {"p99", microseconds(lateness.quantile_ns(0.99))},
              {"worst", microseconds(lateness.worst_ns)}}},
            {"late_histogram_us", histogram},
            {"real_time_priority", loop.real_time_priority},
            {"memory_locked", loop.memory_locked}};
}

ordered_json json_of_frames(const vision::FrameCounts& frames) {
    return {{"used", frames.handed_out},     {"skipped", frames.skipped},
            {"lost", frames.lost},           {"damaged", frames.damaged},
            {"unstamped", frames.unstamped}, {"reconnections", frames.reconnects}};
}

}  // namespace

void write_run_json(const std::filesystem::path& file, const Recipe& recipe, const JournalContent& content,
                    const DeviceFigures& devices) {
    const RunIdentity& id = content.identity;
    const Counts counts = count(content.visits);
    ordered_json visits = ordered_json::array();
    for (const Visit& visit : content.visits) visits.push_back(json_of_visit(visit));
    ordered_json json{{"format", "fidservo-inspection/1"},
                      {"recipe", recipe.name},
                      {"version", id.version},
                      {"stage", id.stage},
                      {"camera", id.camera},
                      {"seed", id.seed},
                      {"sha256",
                       {{"recipe", id.recipe_sha256},
                        {"rig", id.rig_sha256},
                        {"plate", id.plate_sha256},
                        {"printed_plate",
                         id.printed_sha256.empty() ? ordered_json(nullptr) : ordered_json(id.printed_sha256)},
                        {"calibration", id.calibration_sha256}}},
                      {"verdict", counts.pass == counts.total() ? "pass" : "fail"},
                      {"checks",
                       {{"total", counts.total()},
                        {"pass", counts.pass},
                        {"fail", counts.fail},
                        {"not_decidable", counts.not_decidable},
                        {"not_measured", counts.not_measured}}},
                      {"resumed", content.resumed},
                      {"rig_time_s", content.visits.empty() ? 0.0 : content.visits.back().to_s},
                      {"visits", visits}};
    if (devices.loop) json["control_loop"] = json_of_loop(*devices.loop);
    if (devices.frames) json["frames"] = json_of_frames(*devices.frames);
    replace_file(file, json.dump(2) + "\n");
}

}  // namespace fidservo::inspect

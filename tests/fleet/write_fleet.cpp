// SPDX-License-Identifier: GPL-3.0-or-later
// write_fleet OUT RIG.yaml UNITS WEEKS SEED RECORDING...: writes campaigns OUT/unit-UU/week-WW of rigs
// simulated by the independent model (reference/), with one random effect for each unit; of each campaign
// only the recordings named are made.
#include "core/rig.h"
#include "src/files/recording/description.h"
#include "src/files/recording/writer.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/draw/campaign.h"
#include "src/selfcheck/draw/case_draw.h"
#include "src/simulation/experiments.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <set>
#include <string>

#include <fmt/format.h>

namespace fidservo {
namespace {

/// Mondays, from the 5th of January 2026 on.
std::string week_start(int week) {
    const auto day = std::chrono::sys_days(std::chrono::year(2026) / 1 / 5) + std::chrono::weeks(week);
    const std::chrono::year_month_day date(day);
    return fmt::format("{:04}-{:02}-{:02}T08:00:00Z", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

/// The rig of a unit: a case of the self-check with an effect that the catalogue lists.
selfcheck::TrueRig rig_of_unit(const Rig& nominal, std::uint64_t seed, std::size_t unit) {
    std::size_t number = 0;
    for (std::size_t found = 0;; ++number) {
        if (selfcheck::kind_of_case(seed, number) != selfcheck::CaseKind::one) continue;
        if (found++ == unit) break;
    }
    return selfcheck::draw_case(nominal, seed, number).true_rig;
}

void write_fleet(const std::filesystem::path& out, const std::filesystem::path& rig_file, int units,
                 int weeks, std::uint64_t seed, const std::set<std::string>& wanted) {
    const Rig nominal = load_rig(rig_file);
    for (int unit = 0; unit < units; ++unit) {
        const selfcheck::TrueRig rig = rig_of_unit(nominal, seed, static_cast<std::size_t>(unit));
        for (int week = 0; week < weeks; ++week) {
            const auto folder = out / fmt::format("unit-{:02}", unit) / fmt::format("week-{:02}", week);
            std::filesystem::create_directories(folder);
            RecordingOrigin origin{.unit = fmt::format("unit-{:02}", unit), .recorded_at = week_start(week)};
            origin.labels["batch"] = fmt::format("{}", 1 + unit / 10);
            for (const CampaignRun& run : campaign_runs(nominal))
                if (wanted.contains(run.name))
                    write_recording(folder / run.name,
                                    selfcheck::record_run(nominal, rig, run,
                                                          seed + 1000 * static_cast<std::uint64_t>(unit) +
                                                              static_cast<std::uint64_t>(week)),
                                    nominal.camera, origin);
        }
    }
}

}  // namespace
}  // namespace fidservo

int main(int argc, char** argv) {
    if (argc < 7) {
        std::fputs("usage: write_fleet OUT RIG.yaml UNITS WEEKS SEED RECORDING...\n", stderr);
        return 2;
    }
    try {
        fidservo::write_fleet(argv[1], argv[2], std::atoi(argv[3]), std::atoi(argv[4]),
                              std::strtoull(argv[5], nullptr, 10), {argv + 6, argv + argc});
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "write_fleet: {}\n", error.what());
        return 1;
    }
}

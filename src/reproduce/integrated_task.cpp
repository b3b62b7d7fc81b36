// SPDX-License-Identifier: GPL-3.0-or-later
// The integrated task (fig. 22): the macro stage moves and settles, then the camera leads the micro stage.
// This runs the program's own session, through rendered images, on the simulated rig.
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/plate_file.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"
#include "src/session/session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

struct Target {
    int tag_id;
    double dx_um;
};

constexpr std::array visited_targets{Target{40, 0.0}, Target{44, 350.0}, Target{20, -420.0},
                                     Target{21, 150.0}, Target{70, 0.0}};
constexpr double observed_s = 1.0;

template <class T>
T demanded_of_task(Result<T> result) {
    if (!result) throw RunFault(fmt::format("integrated task: {}", result.error().text));
    if constexpr (!std::is_void_v<T>) return *std::move(result);
}

/// Visits the targets, and keeps the recording of it in a folder.
std::vector<Arrival> visit_targets(const Laboratory& laboratory, const std::filesystem::path& folder) {
    const Plate plate = plate_of(laboratory.rig.fiducials.value());
    SessionOptions options;
    options.rig_file = laboratory.rig_file;
    options.seed = laboratory.seed;
    Session session(options, laboratory.rig, plate, plate);
    demanded_of_task(session.home());
    session.record_to(folder, "integrated");
    std::vector<Arrival> arrivals;
    arrivals.reserve(visited_targets.size());
    for (const Target& target : visited_targets) {
        arrivals.push_back(demanded_of_task(session.go_to(target.tag_id, 1e-3 * target.dx_um)));
        demanded_of_task(session.observe(observed_s));
    }
    demanded_of_task(session.end_recording());
    return arrivals;
}

/// The shortest time in s from the carriage's last count to a new micro set point.
double shortest_rest_s(const Recording& recording) {
    double shortest_s = std::numeric_limits<double>::infinity();
    std::size_t moved = 0;
    for (std::size_t k = 1; k < recording.rows.size(); ++k) {
        const StageRow &row = recording.rows[k], &before = recording.rows[k - 1];
        if (row.encoder_count != before.encoder_count) moved = k;
        const bool new_setpoint =
            std::isfinite(row.micro_setpoint_mm) && row.micro_setpoint_mm != before.micro_setpoint_mm;
        if (new_setpoint && moved > 0)
            shortest_s = std::min(shortest_s, recording.tick_s * static_cast<double>(k - moved));
    }
    return shortest_s;
}

/// The encoder counts from where it was switched on; at rest at the end it stands on its set point.
std::vector<double> carriage_on_plate_mm(const Rig& rig, const Recording& recording) {
    std::vector<double> carriage = carriage_mm(rig, recording);
    const double zero_mm = recording.rows.back().macro_setpoint_mm - carriage.back();
    for (double& place : carriage) place += zero_mm;
    return carriage;
}

std::string arrival_table(const std::vector<Arrival>& arrivals) {
    std::vector<std::vector<std::string>> rows;
    rows.reserve(arrivals.size());
    for (const Arrival& arrival : arrivals)
        rows.push_back({fmt::format("tag {} {:+.0f} um", arrival.tag_id, arrival.target_dx_um),
                        fmt::format("{:.2f}", arrival.reached_dx_um - arrival.target_dx_um),
                        fmt::format("{:.2f}", arrival.reached_std_um),
                        fmt::format("{:.2f}", arrival.macro_time_s),
                        fmt::format("{:.2f}", arrival.micro_time_s), std::to_string(arrival.micro_moves)});
    return table_html({"target", "error by the camera, um", "standard error, um", "macro stage, s",
                       "micro stage, s", "micro moves"},
                      rows);
}

}  // namespace

Chapter integrated_task(const Laboratory& laboratory) {
    const Rig& rig = laboratory.rig;
    const std::filesystem::path folder = laboratory.out / "recordings" / "integrated";
    const std::vector<Arrival> arrivals = visit_targets(laboratory, folder);
    const Recording recording = read_recording(folder);
    const double rest_s = shortest_rest_s(recording);
    double worst_um = 0.0;
    for (const Arrival& arrival : arrivals)
        worst_um = std::max(worst_um, std::abs(arrival.reached_dx_um - arrival.target_dx_um));

    Chapter chapter{"integrated", "The integrated task", "", {}};
    chapter.html =
        time_figure("integrated",
                    "Fig. 22 from our data: five fiducial-relative targets. The carriage goes first; when it "
                    "stands, and the camera "
                    "has confirmed it, the platform moves.",
                    rig.tick_s,
                    {{"Carriage",
                      "mm",
                      {{"set point", column(recording, &StageRow::macro_setpoint_mm), true, 2, true},
                       {"carriage (encoder)", carriage_on_plate_mm(rig, recording), false, 2}}},
                     {"Platform",
                      "mm",
                      {{"set point", column(recording, &StageRow::micro_setpoint_mm), true, 4, true},
                       {"platform (Hall sensor)", platform_mm(rig, recording), false, 4}}}}) +
        arrival_table(arrivals);
    chapter.claims = {
        {"fig. 22", "The micro stage moves only after the macro stage has settled.",
         fmt::format("no micro set point earlier than {:.0f} ms after the carriage's last count",
                     1e3 * rest_s),
         holds_if(std::isfinite(rest_s) && rest_s >= 0.05), ""},
        {"fig. 22, abstract", "The integrated system positions to 5 um.",
         fmt::format("at most {:.2f} um from {} targets, as the camera measured them at rest", worst_um,
                     arrivals.size()),
         holds_if(worst_um <= 5.0), ""}};
    return chapter;
}

}  // namespace fidservo::reproduce

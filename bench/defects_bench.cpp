// SPDX-License-Identifier: GPL-3.0-or-later
// How small a defect is found, and how often a good plate is called bad: random defects (kind, size, place)
// on 50 plates, rendered with the camera's noise and seen by the checks of the demo recipe.
//
//   defects_bench [FOLDER]     writes defects.csv (a row a defect) and defects.html (found against size)
#include "core/input_error.h"
#include "core/random.h"
#include "core/rig.h"
#include "core/units.h"
#include "plant/view/plate_view.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/rig_file.h"
#include "src/inspect/measure/checks.h"
#include "src/inspect/measure/nominal_drawing.h"
#include "src/inspect/recipe/pattern.h"
#include "src/report/chart.h"
#include "src/report/page.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <thread>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

constexpr int plates = 50;
constexpr int sites_a_plate = 5;
constexpr int defects_a_plate = 3;     // the other sites are good
constexpr double defect_limit_um = 4;  // of the comparison: one pixel, in place of the demo's 25 um
constexpr double arrival_um = 1.0;     // the camera stands this far from where it should at most

enum class Kind { speck, pinhole, scratch, shifted_pad, thin_line };
constexpr std::array kinds{Kind::speck, Kind::pinhole, Kind::scratch, Kind::shifted_pad, Kind::thin_line};

std::string_view name_of(Kind kind) {
    static constexpr std::array names{"speck (diameter)", "pinhole (diameter)", "scratch (width)",
                                      "shifted pad (shift)", "thin line (width lost)"};
    return names[static_cast<std::size_t>(kind)];
}

double largest_um(Kind kind) {
    return kind == Kind::speck || kind == Kind::pinhole ? 16.0 : 4.0;
}

struct Defect {
    Kind kind;
    double size_um;
};

/// Prints one defect beside a fiducial. Places are those where the recipe's features leave room, or the
/// feature.
Defect print_defect(Plate& plate, const Site& site, NoiseStream& random) {
    const Kind kind = kinds[static_cast<std::size_t>(random.uniform() * kinds.size())];
    const Defect defect{kind, (0.02 + 0.98 * random.uniform()) * largest_um(kind)};
    const double size_mm = mm_from_um(defect.size_um), angle = 2.0 * std::numbers::pi * random.uniform();
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d free_mm =
        site.fiducial_mm + Eigen::Vector2d(-0.5 + 0.9 * random.uniform(), -1.7 + 0.7 * random.uniform());
    const auto feature = [&](const char* name) -> Feature& {
        return *std::ranges::find(plate.features, name_at(name, site.tag_id), &Feature::name);
    };
    switch (kind) {
        case Kind::speck:
            plate.features.push_back({"defect", Dot{free_mm, size_mm}, 0.1});
            break;
        case Kind::scratch:
            plate.features.push_back(
                {"defect", Scratch{{free_mm - 0.15 * direction, free_mm + 0.15 * direction}, size_mm}, 0.35});
            break;
        case Kind::pinhole: {
            const Eigen::Vector2d centre_mm = std::get<Pad>(feature("pad").shape).centre_mm;
            const Eigen::Vector2d off_mm(0.4 * (random.uniform() - 0.5), 0.25 * (random.uniform() - 0.5));
            plate.features.push_back({"defect", Dot{centre_mm + off_mm, size_mm}, plate.paper_reflectance});
            break;
        }
        case Kind::shifted_pad:
            std::get<Pad>(feature("pad").shape).centre_mm += size_mm * direction;
            break;
        case Kind::thin_line:
            std::get<Line>(feature("track").shape).width_mm -= size_mm;
            break;
    }
    return defect;
}

struct SiteOutcome {
    int plate, site;
    std::optional<Defect> defect;
    int checks = 0, failed = 0, undecided = 0;
};

/// Inspects a site from every view of the recipe, and counts its checks in the outcome.
SiteOutcome inspect_site(const Recipe& recipe, const CameraParameters& camera, const plant::PlateView& view,
                         const Site& site, const DrawNominal& draw_nominal, NoiseStream& random,
                         SiteOutcome outcome) {
    vision::TagDetector detector;
    std::vector<Snapshot> snapshots;
    for (const View& place : site.views) {
        const double s_mm =
            site.fiducial_mm.x() + mm_from_um(place.offset_um + arrival_um * (2.0 * random.uniform() - 1.0));
        vision::Frame frame;
        frame.image = view.render({&s_mm, 1}, random.bits() >> 1);
        const auto snapshot = read_snapshot(frame, camera, recipe.nominal, site.tag_id, detector);
        if (!snapshot) throw RunFault("no fiducial: " + snapshot.error().text);
        snapshots.push_back(*snapshot);
    }
    for (std::size_t k = 0; k < site.views.size(); ++k)
        for (const ResultRow& row :
             check_view({site, site.views[k], recipe.nominal, snapshots[k], snapshots, draw_nominal, ""})
                 .rows) {
            ++outcome.checks;
            outcome.failed += row.verdict == Outcome::fail;
            outcome.undecided += row.verdict == Outcome::not_decidable;
        }
    return outcome;
}

std::vector<SiteOutcome> inspect_plate(const Recipe& recipe, const CameraParameters& camera, int seed,
                                       const DrawNominal& draw_nominal) {
    NoiseStream random(static_cast<std::uint64_t>(seed), "defects");
    Plate printed = recipe.nominal;
    std::vector<SiteOutcome> outcomes;
    for (int k = 0; k < sites_a_plate; ++k) {
        const Site& site = recipe.sites[static_cast<std::size_t>(k) * 3];
        outcomes.push_back({seed, site.tag_id, {}});
        if (k < defects_a_plate) outcomes.back().defect = print_defect(printed, site, random);
    }
    plant::ViewOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    const plant::PlateView view(camera, printed, options);
    for (int k = 0; k < sites_a_plate; ++k) {
        SiteOutcome& outcome = outcomes[static_cast<std::size_t>(k)];
        outcome = inspect_site(recipe, camera, view, recipe.sites[static_cast<std::size_t>(k) * 3],
                               draw_nominal, random, outcome);
    }
    return outcomes;
}

/// Wilson's interval for a share, 95 %.
report::SharePoint share(double x, int found, int of) {
    const double z = 1.96, n = of, p = found / n;
    const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return {x, p, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

std::vector<report::ShareCurve> curves_of(const std::vector<SiteOutcome>& outcomes) {
    std::vector<report::ShareCurve> curves;
    for (const Kind kind : kinds) {
        report::ShareCurve curve{std::string(name_of(kind)), {}};
        constexpr int bins = 4;
        for (int bin = 0; bin < bins; ++bin) {
            int found = 0, of = 0;
            double sum_um = 0.0;
            for (const SiteOutcome& outcome : outcomes) {
                if (!outcome.defect || outcome.defect->kind != kind) continue;
                if (std::min(bins - 1, static_cast<int>(outcome.defect->size_um / largest_um(kind) * bins)) !=
                    bin)
                    continue;
                ++of;
                found += outcome.failed > 0;
                sum_um += outcome.defect->size_um;
            }
            if (of > 0) curve.points.push_back(share(sum_um / of, found, of));
        }
        if (!curve.points.empty()) curves.push_back(curve);
    }
    return curves;
}

Recipe recipe_with_limit(const Rig& rig) {
    const std::filesystem::path file = std::filesystem::path(FIDSERVO_ASSETS_DIR) / "demo/recipe.yaml";
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    std::string recipe = text.str();
    const std::string demo_limit = "longest_defect_um: 25";
    for (std::size_t at = 0; (at = recipe.find(demo_limit)) != std::string::npos;)
        recipe.replace(at, demo_limit.size(), fmt::format("longest_defect_um: {}", defect_limit_um));
    return parse_recipe(recipe, file, rig);
}

std::vector<SiteOutcome> inspect_all(const Recipe& recipe, const CameraParameters& camera) {
    const DrawNominal draw_nominal = nominal_drawing(camera, recipe.nominal);
    std::vector<std::vector<SiteOutcome>> of_plate(plates);
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int k = next++; k < plates; k = next++)
            of_plate[static_cast<std::size_t>(k)] = inspect_plate(recipe, camera, k + 1, draw_nominal);
    };
    std::vector<std::jthread> workers;
    for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k)
        workers.emplace_back(work);
    workers.clear();
    std::vector<SiteOutcome> all;
    for (const auto& outcomes : of_plate) all.insert(all.end(), outcomes.begin(), outcomes.end());
    return all;
}

void report_on(const std::vector<SiteOutcome>& outcomes, const std::filesystem::path& folder) {
    int good_checks = 0, false_alarms = 0, undecided = 0, defects = 0, found = 0;
    std::string csv = "plate_seed,site,kind,size_um,failed_checks,undecided_checks,checks\n";
    for (const SiteOutcome& outcome : outcomes) {
        if (outcome.defect) {
            ++defects;
            found += outcome.failed > 0;
        } else {
            good_checks += outcome.checks;
            false_alarms += outcome.failed;
            undecided += outcome.undecided;
        }
        csv += fmt::format("{},{},{},{},{},{},{}\n", outcome.plate, outcome.site,
                           outcome.defect ? name_of(outcome.defect->kind) : "none",
                           outcome.defect ? fmt::format("{:.2f}", outcome.defect->size_um) : "",
                           outcome.failed, outcome.undecided, outcome.checks);
    }
    const double alarms = 1000.0 * false_alarms / good_checks;
    const std::string headline = fmt::format(
        "{} of {} random defects found; {:.2f} false alarms per 1,000 checks", found, defects, alarms);
    fmt::print("{} plates, seeds 1 to {}: {} ({} alarms and {} undecided in {} checks at good sites)\n",
               plates, plates, headline, false_alarms, undecided, good_checks);
    std::filesystem::create_directories(folder);
    replace_file(folder / "defects.csv", csv);
    report::Page page;
    page.title = "Defects found against their size";
    page.kind = "Benchmark";
    page.headline = headline;
    page.subline = fmt::format(
        "{} rendered plates, seeds 1 to {}; tolerances of the demo recipe (10 um), comparison from {} um on.",
        plates, plates, defect_limit_um);
    page.body = report::section(
        "found", "Found against size",
        report::share_chart_svg("size in um", "share found", curves_of(outcomes)) +
            "<p class=\"hint\">Bars: 95 % interval (Wilson). Shifts and lost width this small are within the "
            "marks' and lines' tolerance of 10 um; it is the comparison with the drawn plate that finds "
            "them.</p>");
    replace_file(folder / "defects.html", report::render(page));
    fmt::print("report: {}\n", (folder / "defects.html").string());
}

}  // namespace
}  // namespace fidservo::inspect

int main(int argc, char** argv) {
    using namespace fidservo;
    try {
        const Rig rig = load_rig(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
        const inspect::Recipe recipe = inspect::recipe_with_limit(rig);
        const std::filesystem::path folder = argc > 1 && argv[1][0] != '-' ? argv[1] : "out/bench";
        inspect::report_on(inspect::inspect_all(recipe, rig.camera.value()), folder);
    } catch (const std::exception& problem) {
        fmt::print(stderr, "defects_bench: {}\n", problem.what());
        return 3;
    }
}

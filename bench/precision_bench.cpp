// SPDX-License-Identifier: GPL-3.0-or-later
// How precisely and how fast a tag is placed, against the Cramer-Rao bound and against other people's methods
// on the same frames: precision_bench [REPORT.html] [SHARE]; the report
// lies beside the program if not told otherwise. Takes some ten minutes; SHARE of the frames
// takes that share of the time. Prints every figure and writes the report.
// Times are processor time of one core.
#include "bench/frame_times.h"
#include "bench/precision/peers.h"
#include "bench/precision/precision_report.h"
#include "tests/core_time.h"
#include "tests/tag_precision/precision_trials.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

namespace {

using namespace fidservo;
using namespace fidservo::precision;

#ifdef FIDSERVO_VISP_PEER
constexpr const char* visp_program = FIDSERVO_VISP_PEER;
#else
constexpr const char* visp_program = "";
#endif

constexpr int frames_at_a_place = 50;

/// What the program does with a frame of which it knows nothing.
Estimator found_and_refined(const PrecisionCase& of) {
    const auto detector = std::make_shared<vision::TagDetector>();
    return [&of, detector](const Trial& trial) -> std::optional<Estimate> {
        for (const TagDetection& tag : detector->detect(trial.frame, 0)) {
            if (tag.tag_id != of.scene.tag_id) continue;
            const auto refined = vision::refine_tag(trial.frame, tag, of.known);
            if (refined) return Estimate{refined->centre_px, refined->centre_covariance_px2};
        }
        return std::nullopt;
    };
}

/// The machine's own frame size; refinement and detector take turns on the same frames.
bench::FrameTimes time_frames(double share) {
    PrecisionCase large = precision_cases().front();
    large.scene.camera = {1280, 960, 5000.0, {639.5, 479.5}, 20.0};
    large.scene.centre_px = {650.0, 470.0};
    large.known.camera = large.scene.camera;
    const Estimator refine = refinement(large), detect = bench::tuned_apriltag(large.scene.tag_id);
    std::vector<double> refine_ms, detect_ms;
    const auto timed = [](const Estimator& estimator, const Trial& trial, std::vector<double>& times_ms) {
        const double begin_s = core_time_s();
        estimator(trial);
        times_ms.push_back(1e3 * (core_time_s() - begin_s));
    };
    const int draws = std::max(1, static_cast<int>(std::lround(10 * share)));
    for_each_trial(large, {.shifts = 20, .draws = draws}, [&](const Trial& trial) {
        timed(refine, trial, refine_ms);
        timed(detect, trial, detect_ms);
    });
    return {bench::quantile(refine_ms, 0.5), bench::quantile(refine_ms, 0.99),
            bench::quantile(detect_ms, 0.5)};
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> words;
    for (int k = 1; k < argc; ++k)
        if (!std::string(argv[k]).starts_with("--benchmark")) words.emplace_back(argv[k]);
    const std::string report =
        words.empty() ? std::filesystem::path(argv[0]).replace_filename("precision.html").string() : words[0];
    const double share = words.size() < 2 ? 1.0 : std::atof(words[1].c_str());
    if (!(share > 0.0)) {
        std::cerr << "precision_bench: SHARE must be a number above 0, not " << words[1] << "\n";
        return 2;
    }
    cv::setNumThreads(1);
    const auto fewer = [&](int count) {
        return std::max(1, static_cast<int>(std::lround(count * std::sqrt(share))));
    };
    const auto plan = [&](int draws) { return TrialPlan{.shifts = fewer(100), .draws = fewer(draws)}; };

    const std::vector<PrecisionCase> cases = precision_cases();
    std::vector<bench::MethodFigures> methods;
    for (const PrecisionCase& of : cases) {
        std::vector<bench::Peer> all{{"fidservo, refinement alone", frames_at_a_place, refinement(of)},
                                     {"fidservo, found and refined", 5, found_and_refined(of)}};
        for (const bench::Peer& peer : bench::peers_for(of, visp_program)) all.push_back(peer);
        if (methods.empty())
            for (const bench::Peer& peer : all) methods.push_back({peer.name, {}});
        std::cout << "\n" << table_heading() << "\n";
        for (std::size_t m = 0; m < all.size(); ++m) {
            const PrecisionFigures figures = judge(of, plan(all[m].draws), all[m].locate);
            methods[m].cases.push_back(figures);
            std::cout << table_row(figures) << "  " << figures.trials << " " << all[m].name << std::endl;
        }
        for (const std::string& reproach : reproaches(methods.front().cases.back(), of.limits, false))
            std::cout << "  beyond its limit: " << reproach << "\n";
    }
    const bench::FrameTimes times = time_frames(share);
    std::cout << fmt::format(
        "\n1280 x 960: refinement {:.3f} ms (median), {:.3f} ms (p99); libapriltag tuned {:.3f} ms; ratio "
        "{:.3f}\n",
        times.refinement_ms, times.refinement_p99_ms, times.detector_ms,
        times.refinement_ms / times.detector_ms);
    std::ofstream(report) << bench::precision_page(cases, methods, times);
    std::cout << "report: " << report << "\n";
    return 0;
}

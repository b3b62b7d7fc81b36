#include "gap/diagnose.h"
#include "gap/fit.h"
#include "gap/gap_size.h"
#include "gap/polish.h"
#include <chrono>
#include "gap/score.h"
#include "plant/effects/catalogue.h"
#include "src/config/rig_file.h"
#include "src/selfcheck/campaign.h"
#include "src/selfcheck/case_draw.h"
#include <cstdio>
#include <cmath>
#include <gtest/gtest.h>
namespace fidservo::selfcheck {
TEST(Scratch, Truth) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    const std::uint64_t seed = std::strtoull(getenv("SEED"), nullptr, 10);
    const std::size_t number = std::strtoull(getenv("CASE"), nullptr, 10);
    const Case c = draw_case(rig, seed, number);
    const gap::Evidence ev(rig, record_campaign(rig, c.true_rig, c.campaign_seed));
    const auto& d = c.true_rig.departures;
    auto show = [&](const char* name, const gap::Hypothesis& h) {
        auto sq = gap::mean_squares(ev.windows(), ev.errors(h, gap::everything(ev)));
        auto g = gap::signal_gaps(ev, sq, sq);
        std::printf("%s:", name);
        for (auto& s : g) std::printf(" %s %.3f", std::string(name_of(s.signal)).c_str(), s.after / s.floor);
        std::vector<std::pair<double, std::size_t>> worst;
        for (std::size_t w = 0; w < sq.size(); ++w) if (!std::isnan(sq[w])) worst.push_back({sq[w], w});
        std::sort(worst.rbegin(), worst.rend());
        std::printf(" loss %.2f\n", gap::total_loss(sq));
        for (int k = 0; k < 4; ++k) { auto& w = ev.windows()[worst[static_cast<std::size_t>(k)].second]; std::printf("   %s %s row %zu: %.1f\n", ev.recordings()[w.run].name.c_str(), std::string(name_of(w.signal)).c_str(), w.first_row, std::sqrt(worst[static_cast<std::size_t>(k)].first)); }
    };
    gap::Hypothesis truth;
    const auto add = [&](const char* n, std::vector<double> v) { truth.push_back({plant::find_effect(n), v}); };
    if (d.mechanics.cogging_V != 0) add("cogging", {d.mechanics.cogging_V, d.mechanics.cogging_period_mm, d.mechanics.cogging_phase_rad});
    if (d.mechanics.payload != 1) add("payload", {d.mechanics.payload});
    if (d.heater.cooling_tau != 1) add("airflow", {d.heater.cooling_tau});
    if (d.friction.viscous_forward != 1) add("viscous_friction", {(d.friction.viscous_forward - 1.0) / rig.macro.velocity_gain_mm_per_s_per_V});
    if (d.drive.delay_s != 0) add("drive_delay", {1e3 * d.drive.delay_s});
    if (d.drive.gain != 1) add("drive_gain", {d.drive.gain});
    if (d.friction.patch_V != 0) add("rail_patch", {d.friction.patch_V, d.friction.patch_centre_mm, d.friction.patch_width_mm});
    if (d.mechanics.stretch) add("belt_compliance", {1e3 * d.mechanics.stretch->compliance_mm_per_V, d.mechanics.stretch->damping_ratio, d.mechanics.stretch->motor_share});
    if (d.mechanics.play_mm != 0) add("backlash", {1e3 * d.mechanics.play_mm});
    for (auto& t : truth) { std::printf("truth %s:", std::string(t.effect->name).c_str()); for (double v : t.values) std::printf(" %.8g", v); std::printf("\n"); }
    show("nominal", {});
    show("truth", truth);
    if (getenv("NODIAG")) return;
    const auto dg = gap::diagnose(ev, {.only = {}, .without = c.without, .selection = {}});
    for (auto& t : dg.hypothesis) { std::printf("found %s:", std::string(t.effect->name).c_str()); for (double v : t.values) std::printf(" %.8g", v); std::printf("\n"); }
    std::printf("diag after %.3f  ", dg.gap.after); for (auto& s : dg.signals) std::printf(" %s %.3f", std::string(name_of(s.signal)).c_str(), s.after / s.floor); std::printf("\n");
    if (dg.unexplained) std::puts(dg.unexplained->text.c_str());
    show("found (all)", dg.hypothesis);
}

TEST(Scratch, Polish) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    const std::size_t number = std::strtoull(getenv("CASE"), nullptr, 10);
    const Case c = draw_case(rig, 2044, number);
    const gap::Evidence ev(rig, record_campaign(rig, c.true_rig, c.campaign_seed));
    gap::Hypothesis h;
    const auto add = [&](const char* n, std::vector<double> v) { h.push_back({plant::find_effect(n), v}); };
    if (number == 124) { add("payload", {0.51995055}); add("cogging", {0.0028476763, 19.133619, -3.1651769}); }
    else { add("cogging", {0.0061130488, 8.6922196, 0.72792963}); add("viscous_friction", {7.1094599e-05}); }
    gap::Wanted wanted = gap::everything(ev);
    for (std::size_t w = 0; w < wanted.size(); ++w) { auto s = ev.windows()[w].signal; if (s != gap::Signal::encoder && s != gap::Signal::tag) wanted[w] = 0; }
    int n = 0;
    const gap::Predict predict = [&](const gap::Hypothesis& x) { ++n; return ev.errors(x, wanted); };
    const auto now = [] { return std::chrono::steady_clock::now(); };
    for (int round = 0; round < 6; ++round) {
        auto t = now(); n = 0;
        const bool simplex = round % 2 == 1;
        gap::Fit f = simplex ? gap::polish(predict, ev.windows(), wanted, h, {0, 1}, atof(getenv("STEP"))) : gap::fit(predict, ev.windows(), wanted, h, {.tolerance = 1e-7, .threads = gap::Threads::all, .step_scales = round < 2 ? 0.001 : 1e-4});
        h = f.hypothesis;
        std::printf("%s loss %.3f, %d predictions, %.2f s:", simplex ? "simplex" : "slopes", f.loss, n, std::chrono::duration<double>(now() - t).count());
        for (auto& s : h) for (double v : s.values) std::printf(" %.7g", v);
        std::printf("\n");
    }
}
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The loops, linear and without limits, on the file's own model: what follows the dead zone's edge is
// slope * command, and what is sampled, computed and held in a tick is exact there.
#include "core/rig.h"
#include "src/rig/finding.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

namespace fidservo {

namespace {

/// Of the farthest pole from 0: above 1 a loop runs away. Rounding, and a loop that is at the edge by design
/// (an axis that nothing holds), stay within the margin.
constexpr double edge = 1.0 + 1e-9;

/// How long an error beyond that edge takes to grow by e.
double e_fold_s(const Rig& rig, double pole) {
    return rig.tick_s / std::log(pole);
}

template <int N>
double farthest_pole(const Eigen::Matrix<double, N, N>& loop) {
    return Eigen::EigenSolver<Eigen::Matrix<double, N, N>>(loop, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// One tick of the carriage under a held command, in counts: position and speed (per tick), from
/// tau dv/dt = K V - v, dy/dt = v.
struct AxisTick {
    double pole;  ///< v+ = pole v + speed u
    double way;   ///< y+ = y + way v + push u
    double speed, push;
};

AxisTick axis_tick(const Rig& rig) {
    const MacroParameters& macro = rig.macro;
    const double pole = macro.velocity_pole, tau_ticks = -1.0 / std::log(pole);
    const double gain_count_per_tick_per_V =
        macro.velocity_gain_mm_per_s_per_V * macro.dead_zone.slope * rig.tick_s / macro.encoder_resolution_mm;
    const double way = tau_ticks * (1.0 - pole);
    return {pole, way, gain_count_per_tick_per_V * (1.0 - pole), gain_count_per_tick_per_V * (1.0 - way)};
}

/// State y, v, e[k-1]; e = -y; u = e0 e + e1 e[k-1].
double pd_pole(const AxisTick& axis, const PdGains& pd) {
    Eigen::Matrix3d loop;
    loop << 1.0 - axis.push * pd.e0_V_per_count, axis.way, axis.push * pd.e1_V_per_count,  //
        -axis.speed * pd.e0_V_per_count, axis.pole, axis.speed * pd.e1_V_per_count,        //
        -1.0, 0.0, 0.0;
    return farthest_pole(loop);
}

/// State y, v, e[k-1], I; u = kp e + I + ki T e + kd (e - e[k-1]) / T.
double pid_pole(const AxisTick& axis, const PidGains& pid, double tick_s) {
    const double integral = pid.ki_V_per_count_s * tick_s, slope = pid.kd_V_s_per_count / tick_s;
    const double now = pid.kp_V_per_count + integral + slope;
    Eigen::Matrix4d loop;
    loop << 1.0 - axis.push * now, axis.way, -axis.push * slope, axis.push,  //
        -axis.speed * now, axis.pole, -axis.speed * slope, axis.speed,       //
        -1.0, 0.0, 0.0, 0.0,                                                 //
        -integral, 0.0, 0.0, 1.0;
    return farthest_pole(loop);
}

/// Where the wire answers most: the steepest piece of the curve along which it contracts when heated.
double steepest_mm_per_degC(const FodTable& fod) {
    double steepest = 0.0;
    for (std::size_t k = 1; k < fod.nodes(); ++k)
        steepest = std::max(steepest, (fod.node_mm(k, k) - fod.node_mm(k - 1, k - 1)) / fod.step_degC());
    return steepest;
}

/// State x, I; tau dx/dt = g c - x with the faster of the two time constants; c = kp e + I, I+ = I + T ki e.
double pi_pole(const Rig& rig) {
    const MicroParameters& micro = *rig.micro;
    const double tau_s = std::min(micro.heater.heating_tau_s, micro.heater.cooling_tau_s);
    const double pole = std::exp(-rig.tick_s / tau_s);
    const double gain = (1.0 - pole) * steepest_mm_per_degC(*micro.fod) * micro.heater.gain_degC_per_V;
    Eigen::Matrix2d loop;
    loop << pole - gain * micro.pi->kp_V_per_mm, gain, -rig.tick_s * micro.pi->ki_V_per_mm_s, 1.0;
    return farthest_pole(loop);
}

/// Gains whose zero stands on the axis' pole, and that go to the setpoint with four of its time constants.
std::string usual_pd(const Rig& rig) {
    const MacroParameters& macro = rig.macro;
    const double pole = macro.velocity_pole;
    const double loop_s = 4.0 * -rig.tick_s / std::log(pole);
    const double e0 = macro.encoder_resolution_mm /
                      (macro.velocity_gain_mm_per_s_per_V * macro.dead_zone.slope * loop_s * (1.0 - pole));
    return fmt::format("stable, as with e0_V_per_count: {:.4g}, e1_V_per_count: {:.4g}", e0, -pole * e0);
}

void look_at_pd(const Rig& rig, std::vector<Finding>& findings) {
    const PdGains& pd = *rig.macro.pd;
    const DeadZone& zone = rig.macro.dead_zone;
    const std::string gains = fmt::format("{:g}, {:g}", pd.e0_V_per_count, pd.e1_V_per_count);
    if (const double pole = pd_pole(axis_tick(rig), pd); pole > edge)
        findings.push_back(
            {"macro.pd", gains,
             fmt::format("the loop is unstable on this file's model: its error grows e-fold every {:.3g} s",
                         e_fold_s(rig, pole)),
             usual_pd(rig)});
    else if (pd.e0_V_per_count + pd.e1_V_per_count <= 0.0)
        findings.push_back({"macro.pd", gains,
                            "a steady error gives no command towards the setpoint: e0 + e1 must be above 0",
                            usual_pd(rig)});
    // identify macro finds the threshold to about a hundredth of the command's limit; a controller that
    // is off by twice that sticks early, or jumps.
    if (std::abs(pd.friction_V - zone.threshold_V) > 0.02 * rig.macro.command_limit_V)
        findings.push_back(
            {"macro.pd.friction_V", fmt::format("{:g}", pd.friction_V),
             fmt::format("the controller makes up for another friction than the dead zone's: it would {}",
                         pd.friction_V < zone.threshold_V ? "stick before its goal" : "jump about its goal"),
             fmt::format("macro.dead_zone.threshold_V, {:g} V", zone.threshold_V)});
}

}  // namespace

std::vector<Finding> loop_findings(const Rig& rig) {
    std::vector<Finding> findings;
    if (rig.macro.pd) look_at_pd(rig, findings);
    if (rig.macro.pid)
        if (const double pole = pid_pole(axis_tick(rig), *rig.macro.pid, rig.tick_s); pole > edge)
            findings.push_back(
                {"macro.pid",
                 fmt::format("{:g}, {:g}, {:g}", rig.macro.pid->kp_V_per_count,
                             rig.macro.pid->ki_V_per_count_s, rig.macro.pid->kd_V_s_per_count),
                 fmt::format(
                     "the loop is unstable on this file's model: its error grows e-fold every {:.3g} s",
                     e_fold_s(rig, pole)),
                 "stable: a smaller ki_V_per_count_s or kd_V_s_per_count, or a larger kp_V_per_count"});
    if (rig.micro && rig.micro->pi)
        if (const double pole = pi_pole(rig); pole > edge)
            findings.push_back(
                {"micro.pi",
                 fmt::format("{:g}, {:g}", rig.micro->pi->kp_V_per_mm, rig.micro->pi->ki_V_per_mm_s),
                 fmt::format("the loop is unstable where this file's wire answers most: its error grows by "
                             "{:.3g} a tick",
                             pole),
                 "stable: a smaller kp_V_per_mm"});
    return findings;
}

}  // namespace fidservo

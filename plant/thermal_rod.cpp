// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/thermal_rod.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace fidservo::plant {

namespace {

RodRegime::Matrix rates_of(const ThermalPair& pair, double diffusion_s, bool heating) {
    const double tau_s = heating ? pair.heating_tau_s : pair.cooling_tau_s;
    const double s = pair.surrounding(), p = std::max(1.0, pair.taken), n = rod_parts;
    const double e = (pair.coupling - s) * (heating ? pair.heating : 1.0) / pair.cooling_tau_s;
    const double taken = n / (p * pair.mass_tau_s), lost = (p - 1.0) / (p * pair.mass_tau_s);
    const double conducted = n * n / diffusion_s;
    RodRegime::Matrix rates = RodRegime::Matrix::Zero();
    rates(0, 0) = -1.0 / tau_s - e * pair.drawn();
    rates(0, 1) = s / tau_s + e;
    rates(1, 0) = taken * p;
    rates(1, 1) = -taken;
    for (int i = 1; i <= rod_parts; ++i) {
        rates(i, i) -= lost;
        if (i == rod_parts) break;
        rates(i, i) -= conducted;
        rates(i + 1, i + 1) -= conducted;
        rates(i, i + 1) = rates(i + 1, i) = conducted;
    }
    return rates;
}

RodRegime rod_regime_of(const ThermalPair& pair, double diffusion_s, bool heating, double tick_s) {
    const RodRegime::Matrix rates = rates_of(pair, diffusion_s, heating);
    const double tau_s = heating ? pair.heating_tau_s : pair.cooling_tau_s;
    const RodRise at_last = rates.fullPivLu().solve(RodRise::Unit(0) * (-1.0 / tau_s));
    RodRise scale = RodRise::Constant(std::sqrt(rates(1, 0) / rates(0, 1)));
    scale(0) = 1.0;
    const RodRegime::Matrix symmetric = scale.cwiseInverse().asDiagonal() * rates * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<RodRegime::Matrix> solver(symmetric);
    const RodRegime::Matrix ways = scale.asDiagonal() * solver.eigenvectors();
    const RodRegime::Matrix to_ways = solver.eigenvectors().transpose() * scale.cwiseInverse().asDiagonal();
    const RodRise left = (solver.eigenvalues() * tick_s).array().exp();
    const RodRegime::Matrix tick_decay = ways * left.asDiagonal() * to_ways;
    return {thermal_regime<1 + rod_parts>(rates, at_last, tick_decay, pair.surrounding()),
            solver.eigenvalues(), ways, to_ways};
}

struct RodModel {
    const ThermalRod& rod;

    double surrounding() const { return rod.surrounding; }
    const RodRegime& regime(bool heating) const { return heating ? rod.heating : rod.cooling; }
    static RodRise decayed(const RodRegime& regime, const RodRise& deviation, double time_s) {
        const RodRise along = regime.to_ways * deviation;
        const RodRise left = (regime.decays_per_s * time_s).array().exp() * along.array();
        return regime.ways * left;
    }
};

}  // namespace

ThermalRod thermal_rod(const ThermalPair& pair, double diffusion_s, double tick_s) {
    FIDSERVO_DEMAND(pair.coupling > 0.0 && diffusion_s > 0.0 && tick_s > 0.0);
    return {tick_s, pair.surrounding(), rod_regime_of(pair, diffusion_s, true, tick_s),
            rod_regime_of(pair, diffusion_s, false, tick_s)};
}

RodRise advance(const ThermalRod& rod, const RodRise& rise_degC, double phi_degC, double time_s) {
    return through_regimes(RodModel{rod}, rise_degC, phi_degC, time_s);
}

RodRise advance(const ThermalRod& rod, const RodRise& rise_degC, double phi_degC) {
    return through_tick(RodModel{rod}, rise_degC, phi_degC, rod.tick_s);
}

}  // namespace fidservo::plant

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The normal law: what an optical blur does to edges and corners.

namespace fidservo::plant::view {

/// Density of the unit normal.
double normal_density(double x);

/// Distribution function of the unit normal.
double normal_cdf(double x);

/// Inverse of normal_cdf on 0 < p < 1.
double normal_quantile(double p);

/// P(X < h, Y < k) of two unit normals with correlation rho, |rho| <= 0.9: the blurred corner between two
/// half-planes at distances h and k (in units of the blur). Error below 1e-6.
/// Phi2 = Phi(h) Phi(k) + 1/(2 pi) int_0^rho exp(-(h^2 - 2 r h k + k^2) / (2 (1 - r^2))) / sqrt(1 - r^2) dr,
/// by Gauss-Legendre quadrature. Source: Drezner and Wesolowsky, J. Statist. Comput. Simul. 35 (1990).
double bivariate_normal_cdf(double h, double k, double rho);

}  // namespace fidservo::plant::view

// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera/lens.h"

#include "core/camera/lens_picture.h"
#include "core/demand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include <Eigen/LU>

namespace fidservo {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// d theta_d / d theta as a polynomial in theta^2, the constant first.
using AngleSlope = std::array<double, 5>;

AngleSlope angle_slope_of(const LensDistortion& lens) {
    return {1.0, 3.0 * lens.k1, 5.0 * lens.k2, 7.0 * lens.k3, 9.0 * lens.k4};
}

double value_at(std::span<const double> polynomial, double x) {
    double value = 0.0;
    for (std::size_t k = polynomial.size(); k-- > 0;) value = value * x + polynomial[k];
    return value;
}

/// Where a polynomial of degree 4 at most changes its sign between 0 and `end`, in rising order: between the
/// places where its derivative does so it is monotone.
std::vector<double> sign_changes(std::span<const double> polynomial, double end) {
    if (polynomial.size() < 2) return {};
    std::array<double, 4> derivative{};
    for (std::size_t k = 1; k < polynomial.size(); ++k)
        derivative[k - 1] = static_cast<double>(k) * polynomial[k];
    std::vector<double> ends = sign_changes(std::span(derivative).first(polynomial.size() - 1), end);
    ends.push_back(end);
    std::vector<double> changes;
    double low = 0.0;
    for (const double high : ends) {
        double inside = low, outside = high;
        const bool from = value_at(polynomial, inside) > 0.0;
        if (from != (value_at(polynomial, outside) > 0.0)) {
            constexpr int halvings = 60;
            for (int k = 0; k < halvings; ++k) {
                const double middle = 0.5 * (inside + outside);
                ((value_at(polynomial, middle) > 0.0) == from ? inside : outside) = middle;
            }
            changes.push_back(inside);
        }
        low = high;
    }
    return changes;
}

/// Whether theta_d rises all the way from 0 to an angle.
bool rises_to(const LensDistortion& lens, double theta_rad) {
    if (!(theta_rad >= 0.0 && theta_rad <= std::numbers::pi)) return false;
    const AngleSlope slope = angle_slope_of(lens);
    const double square = theta_rad * theta_rad;
    double least = slope[0], power = 1.0;
    for (std::size_t k = 1; k < slope.size(); ++k) {
        power *= square;
        least += std::min(0.0, slope[k]) * power;
    }
    return least > 0.0 || theta_rad <= domain_rad(lens);
}

double angle_pictured(const LensDistortion& lens, double theta_rad) {
    return theta_rad * angle_growth(lens.k1, lens.k2, lens.k3, lens.k4, theta_rad);
}

/// theta of theta_d by Newton's method from a lens without distortion, wherever that leads.
double angle_nearby(const LensDistortion& lens, double pictured) {
    constexpr int enough = 8;  // quadratic from an error of some per cent
    const AngleSlope slope = angle_slope_of(lens);
    double theta_rad = pictured;
    for (int k = 0; k < enough; ++k)
        theta_rad -= (angle_pictured(lens, theta_rad) - pictured) / value_at(slope, theta_rad * theta_rad);
    return theta_rad;
}

/// The angle theta, rad, within the lens's domain whose distorted angle theta_d is `pictured`; empty if there
/// is none.
std::optional<double> angle_of(const LensDistortion& lens, double pictured) {
    constexpr double rounding = 1e-14;
    const auto fits = [&](double theta_rad) {
        return std::abs(angle_pictured(lens, theta_rad) - pictured) <= rounding * pictured;
    };
    const double nearby_rad = angle_nearby(lens, pictured);
    if (fits(nearby_rad) && rises_to(lens, nearby_rad)) return nearby_rad;
    double low = 0.0, high = domain_rad(lens);
    if (!(pictured <= angle_pictured(lens, high))) return std::nullopt;
    constexpr int halvings = 60;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (angle_pictured(lens, middle) > pictured ? high : low) = middle;
    }
    return low;
}

Eigen::Matrix2d plumb_bob_slope(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
    const double x = ideal.x(), y = ideal.y(), r2 = ideal.squaredNorm();
    const double radial = 1.0 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
    const double slope = 2.0 * (lens.k1 + r2 * (2.0 * lens.k2 + r2 * 3.0 * lens.k3));
    const double mixed = slope * x * y + 2.0 * lens.p1 * x + 2.0 * lens.p2 * y;
    Eigen::Matrix2d jacobian;
    jacobian << radial + slope * x * x + 2.0 * lens.p1 * y + 6.0 * lens.p2 * x, mixed, mixed,
        radial + slope * y * y + 6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
    return jacobian;
}

/// theta_d changes along the radius with theta = atan(r), and the picture turns as (x, y) does.
Eigen::Matrix2d equidistant_slope(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
    const double r = ideal.norm();
    if (r == 0.0) return Eigen::Matrix2d::Identity();
    const double theta_rad = std::atan(r);
    const double across = angle_pictured(lens, theta_rad) / r;
    const double along = value_at(angle_slope_of(lens), theta_rad * theta_rad) / (1.0 + r * r);
    const Eigen::Vector2d outwards = ideal / r;
    return across * Eigen::Matrix2d::Identity() + (along - across) * outwards * outwards.transpose();
}

Eigen::Vector2d plumb_bob_ideal(const LensDistortion& lens, const Eigen::Vector2d& pictured) {
    if (lens.is_none()) return pictured;
    constexpr int enough = 8;  // quadratic from an error of some per cent
    Eigen::Vector2d ideal = pictured;
    for (int step = 0; step < enough; ++step)
        ideal -= plumb_bob_slope(lens, ideal).inverse() * (distort(lens, ideal) - pictured);
    return ideal;
}

Eigen::Vector3d equidistant_ray(const LensDistortion& lens, const Eigen::Vector2d& pictured) {
    const double radius = pictured.norm();
    if (radius == 0.0) return Eigen::Vector3d::UnitZ();
    const std::optional<double> theta_rad = angle_of(lens, radius);
    if (!theta_rad) return Eigen::Vector3d::Constant(no_number);
    const Eigen::Vector2d aside = std::sin(*theta_rad) / radius * pictured;
    return {aside.x(), aside.y(), std::cos(*theta_rad)};
}

}  // namespace

std::string_view name_of(LensModel model) {
    return model == LensModel::plumb_bob ? "plumb_bob" : "equidistant";
}

std::size_t coefficients_of(LensModel model) {
    return model == LensModel::plumb_bob ? 5 : 4;
}

std::vector<double> numbers_of(const LensDistortion& lens) {
    if (lens.model == LensModel::equidistant) return {lens.k1, lens.k2, lens.k3, lens.k4};
    return {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
}

LensDistortion distortion_of(LensModel model, const std::vector<double>& numbers) {
    FIDSERVO_DEMAND(numbers.size() == coefficients_of(model));
    if (model == LensModel::equidistant)
        return {.k1 = numbers[0], .k2 = numbers[1], .k3 = numbers[2], .k4 = numbers[3], .model = model};
    return {.k1 = numbers[0], .k2 = numbers[1], .p1 = numbers[2], .p2 = numbers[3], .k3 = numbers[4]};
}

Eigen::Vector2d picture_of(const LensDistortion& lens, const Eigen::Vector3d& direction) {
    if (lens.model == LensModel::plumb_bob) return distort(lens, direction.head<2>() / direction.z());
    const double theta_rad = std::atan2(direction.head<2>().norm(), direction.z());
    if (!rises_to(lens, theta_rad)) return Eigen::Vector2d::Constant(no_number);
    return fisheye_picture(lens.k1, lens.k2, lens.k3, lens.k4, direction);
}

Eigen::Vector3d ray_of(const LensDistortion& lens, const Eigen::Vector2d& pictured) {
    if (lens.model == LensModel::equidistant) return equidistant_ray(lens, pictured);
    const Eigen::Vector2d ideal = plumb_bob_ideal(lens, pictured);
    return {ideal.x(), ideal.y(), 1.0};
}

Eigen::Matrix<double, 3, 2> ray_slope(const LensDistortion& lens, const Eigen::Vector3d& ray) {
    Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
    if (lens.model == LensModel::plumb_bob) {
        slope.topRows<2>() = plumb_bob_slope(lens, ray.head<2>()).inverse();
        return slope;
    }
    const double sine = ray.head<2>().norm();
    slope.topRows<2>().setIdentity();
    if (sine == 0.0) return slope;
    const double theta_rad = std::atan2(sine, ray.z());
    const Eigen::Vector2d outwards = ray.head<2>() / sine;
    const double along = 1.0 / value_at(angle_slope_of(lens), theta_rad * theta_rad);
    const double across = sine / angle_pictured(lens, theta_rad);
    slope.topRows<2>() =
        across * Eigen::Matrix2d::Identity() + (ray.z() * along - across) * outwards * outwards.transpose();
    slope.row(2) = -sine * along * outwards.transpose();
    return slope;
}

Eigen::Vector2d distort(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
    if (lens.model == LensModel::equidistant)
        return picture_of(lens, Eigen::Vector3d(ideal.x(), ideal.y(), 1.0));
    const std::array<double, 5> numbers{lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
    return distorted(numbers.data(), ideal);
}

Eigen::Vector2d undistort(const LensDistortion& lens, const Eigen::Vector2d& distorted) {
    if (lens.model == LensModel::plumb_bob) return plumb_bob_ideal(lens, distorted);
    const Eigen::Vector3d ray = equidistant_ray(lens, distorted);
    if (!(ray.z() > 0.0)) return Eigen::Vector2d::Constant(no_number);
    return ray.head<2>() / ray.z();
}

Eigen::Matrix2d distortion_slope(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
    return lens.model == LensModel::plumb_bob ? plumb_bob_slope(lens, ideal) : equidistant_slope(lens, ideal);
}

double domain_rad(const LensDistortion& lens) {
    const AngleSlope slope = angle_slope_of(lens);
    const std::vector<double> turns = sign_changes(slope, std::numbers::pi * std::numbers::pi);
    return turns.empty() ? std::numbers::pi : std::sqrt(turns.front());
}

}  // namespace fidservo

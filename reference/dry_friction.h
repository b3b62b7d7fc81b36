// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Dry friction of the carriage, in volts at the motor.
//
//     g(v) = F_level + F_stribeck exp(-|v / v_s|^n)
//
// F_level gathers Coulomb friction, rail patch and the share of the dead zone that acts on the motion. In a
// rigid contact F = g(v) against the motion; at rest it holds up to the break-away force. A lubricated one
// holds nothing at rest and creeps, F = g(v) tanh(v / v_c). With bristles (LuGre) the contact is elastic with
// the deflection z:
//
//     dz/dt = v r |r|^(n - 1),   r = 1 - s0 z sgn(v) / g(v),     F = s0 z + s1 dz/dt
//
// At speed the bristles relax in g / (s0 |v|). Steps are cut to that time; where it is below a small share of
// the step the bristles are taken to be in equilibrium, F = g(v). Source: Canudas de Wit, Olsson, Astrom,
// Lischinsky, "A new model for control of systems with friction", IEEE Transactions on Automatic Control 40
// (1995).
#include "reference/carriage.h"

namespace fidservo::reference {

enum class Contact { rigid, lubricated, bristles, bristles_in_equilibrium };

struct DryFriction {
    double force_V;  ///< positive where it opposes motion to the right
    double bristle_mm_per_s;
};

/// The contact's law in the next step, and the step's length.
struct ContactStep {
    Contact kind;
    double length_s;
};

bool has_bristles(const FrictionDepartures& friction);

/// Whether the contact holds a carriage at rest and its force changes sign at once with the direction.
bool is_rigid(const FrictionDepartures& friction);

ContactStep contact_step(const CarriageModel& model, double position_mm, double speed_mm_per_s, double h_s);

/// @param direction  of the motion, +1 or -1; it decides the sign at zero speed
DryFriction dry_friction(const CarriageModel& model, double position_mm, double speed_mm_per_s,
                         double bristle_mm, double direction, Contact contact);

/// Force that a carriage at rest withstands, beyond that of the bristles' present deflection.
double breakaway_V(const CarriageModel& model, double position_mm);

/// Elastic force of the bristles; zero for a rigid contact.
double bristle_force_V(const CarriageModel& model, double bristle_mm);

/// g(v) / s0, the deflection at a steady speed.
double equilibrium_bristle_mm(const CarriageModel& model, double position_mm, double speed_mm_per_s);

}  // namespace fidservo::reference

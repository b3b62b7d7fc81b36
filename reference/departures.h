// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a rig may have and its file does not state. Every field's default is neutral: the rig as its file
// describes it. Forces on the carriage are in volts at the motor, as the rig file's gain is.
#include "reference/smooth_function.h"

#include <optional>

namespace fidservo::reference {

/// What lies between the commanded and the driving voltage.
struct DriveDepartures {
    double gain = 1.0;
    double offset_V = 0.0;  ///< a constant force, held by the dead zone while the carriage stands
    double delay_s = 0.0;
    double motor = 1.0;         ///< factor on the force behind the dead zone, as of another motor constant
    double fading_per_s = 0.0;  ///< share of the gain that is lost a second, as a motor warms
};

/// The elastic contact of the LuGre model (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40, 1995).
struct Bristles {
    double stiffness_V_per_mm = 100.0;
    double damping_V_s_per_mm = 0.1;
    double exponent = 1.0;  ///< with which they give way: 1 LuGre's; Dahl's law has any
};

/// Friction on the motion, opposing it.
struct FrictionDepartures {
    double coulomb_V = 0.0;
    /// The share of the file's dead zone that is dry friction on the motion instead: it acts as before while
    /// the carriage is driven, and brakes it while it coasts. 0..1.
    double dead_zone_on_motion = 0.0;
    double stribeck_V = 0.0;  ///< friction at rest in excess of that at speed
    double stribeck_speed_mm_per_s = 20.0;
    double stribeck_exponent = 2.0;         ///< of speed in the excess's decay: 2 a bell, 1 an exponential
    bool stribeck_is_rational = false;      ///< it decays as 1 / (1 + (v / v_s)^2) instead
    std::optional<Bristles> bristles = {};  ///< an elastic contact; a rigid one without
    /// A lubricated contact: dry friction times tanh(v / creep), which holds nothing at rest. 0: none.
    double creep_mm_per_s = 0.0;
    double viscous_forward = 1.0;   ///< factor on the file's damping while moving right
    double viscous_backward = 1.0;  ///< likewise while moving left
    /// Damping beyond the file's, per the file's, that goes with a power of speed; equal to linear damping at
    /// 100 mm/s.
    double viscous_power = 0.0;
    double viscous_exponent = 1.0;
    double drag_V_s2_per_mm2 = 0.0;  ///< of the square of speed, as in air
    double patch_V = 0.0;            ///< dry friction in excess at the centre of a patch of the rail
    double patch_centre_mm = 100.0;
    double patch_width_mm = 5.0;     ///< standard deviation of its bell shape
    bool patch_is_rational = false;  ///< its shape is 1 / (1 + (y / width)^2) instead
};

/// A belt between motor and carriage, as a damped spring.
struct Stretch {
    double compliance_mm_per_V = 0.05;
    double damping_ratio = 0.05;  ///< of motor and carriage swinging against each other
    double motor_share = 0.5;     ///< of the moving mass
};

/// Forces by place, which act on a carriage at rest too, the moving mass, and what moves it.
struct MechanicsDepartures {
    double payload = 1.0;  ///< factor on the moving mass
    double cogging_V = 0.0;
    double cogging_period_mm = 2.0;
    double cogging_phase_rad = 0.0;
    double cogging_second = 0.0;  ///< share of the force at half the period
    double cogging_second_phase_rad = 0.0;
    double cogging_skew = 0.0;    ///< a of sin(x + a sin x)
    double cable_V_per_mm = 0.0;  ///< a spring towards cable_centre_mm
    double cable_centre_mm = 100.0;
    double cable_cubic_per_mm2 = 0.0;  ///< of a spring that hardens: k d + k this d^3
    double cable_slack_mm = 0.0;       ///< to either side, before it pulls
    double play_mm = 0.0;  ///< between what drives the carriage and the carriage, from side to side
    std::optional<Stretch> stretch = {};
};

struct EncoderDepartures {
    double scale = 1.0;  ///< counts a count of the rig file
    double ripple_mm = 0.0;
    double ripple_period_mm = 2.0;
    double ripple_phase_rad = 0.0;
    double ripple_skew = 0.0;  ///< a of sin(x + a sin x)
    double bow_per_mm = 0.0;   ///< it reads y + bow (y - bow_centre)^2
    double bow_centre_mm = 100.0;
};

/// A rod that the wire ends in: it takes up heat, conducts it along, and gives it to the room.
struct Mount {
    double conductance_per_s = 0.0;  ///< from the wire to the rod's near end, over the wire's heat capacity
    double capacity_ratio = 4.0;     ///< heat capacity of the rod over that of the wire
    double diffusion_s = 4.0;        ///< length^2 / diffusivity
    double loss_s = 30.0;            ///< time constant of the rod's loss to the room
};

struct HeaterDepartures {
    double ambient_degC = 0.0;  ///< the room is warmer by
    double gain = 1.0;          ///< factor on the heating power
    double heating_tau = 1.0;   ///< factor
    double cooling_tau = 1.0;   ///< factor: air flow below 1
    double delay_s = 0.0;
    double curvature = 0.0;  ///< heating power times 1 + curvature (2 a - 1), a = 0 at onset, 1 at the limit
    /// Share by which the wire cools faster 60 degC above the room, growing with the fourth root of its
    /// excess as free convection does.
    double convection = 0.0;
    /// Share by which a cold wire is heated more; it falls with the wire's temperature, to nothing 200 degC
    /// above the room, as the share of a supply's power that a growing resistance takes does.
    double cold_gain = 0.0;
    Mount mount = {};
};

enum class HysteresisLaw { preisach, duhem };

struct HysteresisDepartures {
    HysteresisLaw law = HysteresisLaw::preisach;
    double stress_shift_degC = 0.0;          ///< transformation temperatures are higher by
    double stress_shift_degC_per_mm = 0.0;   ///< and by this much more with contraction, as a spring loads it
    double stress_shift_degC_per_mm2 = 0.0;  ///< with its square, as one that hardens does
    double stroke = 1.0;                     ///< factor on the contraction
    double stroke_fading_per_mm = 0.0;  ///< share of the factor's excess over 1 that is lost with contraction
};

/// The platform on its flexure, a resonator whose base is the carriage.
struct FlexureDepartures {
    double coupling = 0.0;  ///< 0 rigid; 1 all of the carriage's acceleration acts on the platform
    double frequency_hz = 25.0;
    double damping_ratio = 0.03;
};

struct HallDepartures {
    double gain = 1.0;    ///< factor on the curve about its middle voltage
    double supply = 1.0;  ///< factor on the whole voltage
    double offset_V = 0.0;
    double cubic = 0.0;  ///< added to the file's coefficient
    double cube = 0.0;   ///< of s^3, in spans
    double fifth = 0.0;  ///< of s - s^5, in spans
    double drift_V_per_s = 0.0;
    double drift_settling_s = 0.0;    ///< time constant with which it ends; 0: never
    double drift_slowing_s = 0.0;     ///< after which it goes on as a logarithm of time; 0: it does not slow
    double crosstalk_V_per_V = 0.0;   ///< of the held motor command
    double crosstalk_filter_s = 0.0;  ///< time constant of a filter that it passes; 0: none
    double warm_V_per_degC = 0.0;     ///< of the wire's temperature above the nominal room
};

struct CameraDepartures {
    double scale = 1.0;          ///< pixels a pixel of the rig file
    double aspect = 1.0;         ///< a pixel's width over its height
    double rotation_rad = 0.0;   ///< of the image about the optical axis, from u towards v
    double tilt_rad = 0.0;       ///< of the camera about an axis parallel to the image
    double tilt_axis_rad = 0.0;  ///< that axis's direction, from u towards v
    double tilt_height = 0.0;    ///< of that axis over the plate, as a share of the camera's
    double distortion = 0.0;     ///< radial, k1 of x (1 + k1 r^2) in normalised coordinates
    double division = 0.0;       ///< radial by another model, k of x / (1 - k r^2)
    double latency_s = 0.0;      ///< by which frames are stamped late
    double clock_skew = 0.0;     ///< the camera's clock gains this share
};

/// Seen in frames only (reference/tag_picture.h).
struct ImageDepartures {
    double defocus_px = 0.0;        ///< standard deviation along each axis, beyond the lens's
    bool defocus_is_disc = false;   ///< a disc of light of that deviation; otherwise a Gaussian
    double extra_exposure_s = 0.0;  ///< at the same brightness
    double readout_s = 0.0;         ///< from the first row's exposure to the last one's
    double light_u = 0.0;           ///< relative change from the centre to the right side
    double light_v = 0.0;           ///< to the lower side
    double light_falloff = 0.0;  ///< a, of 1 / (1 + a (x^2 + y^2) / 4)^2; x, y from -1 to 1 across the image
    double read_noise_e = 0.0;   ///< r.m.s., in addition
    double gain_spread = 0.0;    ///< standard deviation of the pixels' fixed gains
};

/// What a smooth function that no effect has adds to.
enum class ActsOn {
    carriage_force,     ///< V at the motor, on a carriage at rest too
    carriage_friction,  ///< V at the motor, on a moving carriage; it fades where that comes to rest
    hall_reading,       ///< V
    camera_place,       ///< mm along the stage
};

enum class DependsOn {
    carriage_speed,    ///< mm/s
    carriage_place,    ///< mm; friction by place opposes the motion
    contraction,       ///< mm, of the platform
    wire_temperature,  ///< degC above the nominal room
    time,              ///< s since the start
};

/// What remains wrong with a rig once all that has a name is known.
struct Discrepancy {
    ActsOn acts_on = ActsOn::hall_reading;
    DependsOn depends_on = DependsOn::time;
    SmoothFunction function = {};
};

struct Departures {
    DriveDepartures drive = {};
    FrictionDepartures friction = {};
    MechanicsDepartures mechanics = {};
    EncoderDepartures encoder = {};
    HeaterDepartures heater = {};
    HysteresisDepartures hysteresis = {};
    FlexureDepartures flexure = {};
    HallDepartures hall = {};
    CameraDepartures camera = {};
    ImageDepartures image = {};
    Discrepancy discrepancy = {};
};

}  // namespace fidservo::reference

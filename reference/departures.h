// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Deviations of a rig from its file's model. The default of every field is neutral: the rig as its file
// describes it. Forces on the carriage are in volts at the motor, as the rig file's gain implies.
#include "reference/smooth_function.h"

#include <optional>

namespace fidservo::reference {

/// Deviations between the commanded and the driving voltage.
struct DriveDepartures {
    double gain = 1.0;
    double offset_V = 0.0;  ///< a constant force, held by the dead zone while the carriage stands
    double delay_s = 0.0;
    double motor = 1.0;         ///< factor on the force behind the dead zone, as from another motor constant
    double fading_per_s = 0.0;  ///< fraction of the gain that is lost per second, as a motor warms
};

/// The elastic contact of the LuGre model (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40, 1995).
struct Bristles {
    double stiffness_V_per_mm = 100.0;
    double damping_V_s_per_mm = 0.1;
    /// Power of 1 - s0 z / g with which bristles yield: 1 is LuGre's law, other values are Dahl's.
    double exponent = 1.0;
};

/// Friction on the motion, opposing it.
struct FrictionDepartures {
    double coulomb_V = 0.0;
    /// The fraction of the file's dead zone that acts as dry friction on the motion instead: a driven
    /// carriage moves as before, and a coasting one is braked. 0..1.
    double dead_zone_on_motion = 0.0;
    double stribeck_V = 0.0;  ///< friction at rest beyond that at high speed
    double stribeck_speed_mm_per_s = 20.0;
    double stribeck_exponent = 2.0;         ///< exponent n of exp(-(v / v_s)^n): 1 an exponential, 2 a bell
    bool stribeck_is_rational = false;      ///< the excess decays as 1 / (1 + (v / v_s)^2) instead
    std::optional<Bristles> bristles = {};  ///< elastic contact; empty: a rigid one
    /// A lubricated contact: dry friction is multiplied by tanh(v / creep), so that nothing holds at rest. 0:
    /// none.
    double creep_mm_per_s = 0.0;
    double viscous_forward = 1.0;   ///< factor on the file's viscous damping while moving right
    double viscous_backward = 1.0;  ///< the same while moving left
    /// Additional damping by a power of speed, relative to the file's damping; it equals that at
    /// viscous_power = 1 and 100 mm/s.
    double viscous_power = 0.0;
    double viscous_exponent = 1.0;
    double drag_V_s2_per_mm2 = 0.0;  ///< coefficient of drag with the square of speed, as in air
    double patch_V = 0.0;            ///< additional dry friction at the centre of a patch of the rail
    double patch_centre_mm = 100.0;
    double patch_width_mm = 5.0;     ///< standard deviation of its bell shape
    bool patch_is_rational = false;  ///< the shape is 1 / (1 + (y / width)^2) instead
};

/// A belt between motor and carriage, as a damped spring.
struct Stretch {
    double compliance_mm_per_V = 0.05;
    double damping_ratio = 0.05;  ///< damping ratio of motor and carriage oscillating against each other
    double motor_share = 0.5;     ///< the motor's fraction of the moving mass
};

/// Forces by position, which act on a carriage at rest too; the moving mass; and the transmission.
struct MechanicsDepartures {
    double payload = 1.0;  ///< factor on the moving mass
    double cogging_V = 0.0;
    double cogging_period_mm = 2.0;
    double cogging_phase_rad = 0.0;
    double cogging_second = 0.0;  ///< amplitude at half the period, relative to cogging_V
    double cogging_second_phase_rad = 0.0;
    double cogging_skew = 0.0;    ///< a of the skewed wave sin(x + a sin x)
    double cable_V_per_mm = 0.0;  ///< stiffness of a spring towards cable_centre_mm
    double cable_centre_mm = 100.0;
    double cable_cubic_per_mm2 = 0.0;  ///< c of a hardening spring k d + k c d^3
    double cable_slack_mm = 0.0;       ///< distance to either side before the cable pulls
    double play_mm = 0.0;  ///< whole width of the play (backlash) between driving part and carriage
    std::optional<Stretch> stretch = {};
};

struct EncoderDepartures {
    double scale = 1.0;  ///< factor on the position that the encoder measures
    double ripple_mm = 0.0;
    double ripple_period_mm = 2.0;
    double ripple_phase_rad = 0.0;
    double ripple_skew = 0.0;  ///< a of the skewed wave sin(x + a sin x)
    double bow_per_mm = 0.0;   ///< the encoder measures y + bow (y - bow_centre)^2
    double bow_centre_mm = 100.0;
};

/// A rod at the wire's end, which takes up heat, conducts it along its length and loses it to the room.
struct Mount {
    /// Conductance from the wire to the rod's near end over the wire's heat capacity.
    double conductance_per_s = 0.0;
    double capacity_ratio = 4.0;  ///< heat capacity of the rod over that of the wire
    double diffusion_s = 4.0;     ///< length of the rod squared over its thermal diffusivity
    double loss_s = 30.0;         ///< time constant of the rod's loss to the room
};

struct HeaterDepartures {
    double ambient_degC = 0.0;  ///< rise of the room's temperature above the file's
    double gain = 1.0;          ///< factor on the heating power
    double heating_tau = 1.0;   ///< factor on the file's heating time constant
    double cooling_tau = 1.0;   ///< factor on the file's cooling time constant; below 1 with air flow
    double delay_s = 0.0;
    /// A factor 1 + curvature (2 a - 1) on the heating power, a = 0 at the onset and 1 at the limit.
    double curvature = 0.0;
    /// Free convection: the wire cools faster by this fraction at 60 degC above the room, and by one that
    /// grows with the fourth root of the temperature difference.
    double convection = 0.0;
    /// Additional heating, as a fraction, of a wire at room temperature; it falls linearly to nothing at 200
    /// degC above the room. So does the power from a supply whose load's resistance grows.
    double cold_gain = 0.0;
    Mount mount = {};
};

enum class HysteresisLaw { preisach, duhem };

struct HysteresisDepartures {
    HysteresisLaw law = HysteresisLaw::preisach;
    double stress_shift_degC = 0.0;  ///< rise of the transformation temperatures
    /// Further rise per mm of contraction, as a spring loads the wire.
    double stress_shift_degC_per_mm = 0.0;
    /// Further rise per mm^2 of the contraction's square, as from a hardening spring.
    double stress_shift_degC_per_mm2 = 0.0;
    double stroke = 1.0;  ///< factor on the contraction
    /// Decrease, per mm of contraction, of the difference `stroke` - 1, as a fraction of it.
    double stroke_fading_per_mm = 0.0;
};

/// The platform on its flexure, a resonator whose base is the carriage.
struct FlexureDepartures {
    double coupling = 0.0;  ///< fraction of the carriage's acceleration that acts on the platform; 0: rigid
    double frequency_hz = 25.0;
    double damping_ratio = 0.03;
};

struct HallDepartures {
    double gain = 1.0;    ///< factor on the curve about its middle voltage
    double supply = 1.0;  ///< factor on the whole voltage
    double offset_V = 0.0;
    double cubic = 0.0;  ///< added to the file's cubic coefficient
    double cube = 0.0;   ///< coefficient of an added s^3, in units of the span
    double fifth = 0.0;  ///< coefficient of an added s - s^5, in units of the span
    double drift_V_per_s = 0.0;
    double drift_settling_s = 0.0;  ///< time constant with which the drift settles; 0: it never does
    /// Time after which the drift goes on as a logarithm of time; 0: it does not slow.
    double drift_slowing_s = 0.0;
    double crosstalk_V_per_V = 0.0;   ///< fraction of the motor command that is added to the sensor's voltage
    double crosstalk_filter_s = 0.0;  ///< time constant of a low-pass on the crosstalk; 0: none
    double warm_V_per_degC = 0.0;     ///< voltage per degC of the wire's temperature above the nominal room
};

struct CameraDepartures {
    double scale = 1.0;          ///< factor on the image's scale
    double aspect = 1.0;         ///< a pixel's width over its height
    double rotation_rad = 0.0;   ///< rotation of the image about the optical axis, from u towards v
    double tilt_rad = 0.0;       ///< rotation of the camera about an axis parallel to the image
    double tilt_axis_rad = 0.0;  ///< direction of the tilt's axis in the image, from u towards v
    /// Height of the tilt's axis over the plate, as a fraction of the camera's height.
    double tilt_height = 0.0;
    double distortion = 0.0;  ///< radial: k1 of x (1 + k1 r^2) in normalised coordinates
    double division = 0.0;    ///< radial by the division model: k of x / (1 - k r^2)
    double latency_s = 0.0;   ///< by how much the time stamps are late
    double clock_skew = 0.0;  ///< fraction by which the camera's clock runs fast
};

/// Deviations that show only in rendered frames (reference/tag_picture.h).
struct ImageDepartures {
    double defocus_px = 0.0;  ///< standard deviation of the blur along each axis, in addition to the lens's
    bool defocus_is_disc = false;   ///< the blur is a disc of this standard deviation; otherwise a Gaussian
    double extra_exposure_s = 0.0;  ///< added to the exposure time, at the same brightness
    double readout_s = 0.0;         ///< time from the first row's exposure to the last one's
    double light_u = 0.0;  ///< relative change of brightness from the centre to the right side of the image
    double light_v = 0.0;  ///< the same to the lower side
    /// a of a falloff 1 / (1 + a (x^2 + y^2) / 4)^2; x, y from -1 to 1 across the image.
    double light_falloff = 0.0;
    double read_noise_e = 0.0;  ///< standard deviation of additional read noise
    double gain_spread = 0.0;   ///< standard deviation of the pixels' fixed gains
};

/// The quantity to which a smooth function is added that no named effect describes.
enum class ActsOn {
    carriage_force,     ///< V at the motor, on a carriage at rest too
    carriage_friction,  ///< V at the motor, on a moving carriage; fades out towards rest
    hall_reading,       ///< V
    camera_place,       ///< the camera's position along the stage, mm
};

enum class DependsOn {
    carriage_speed,    ///< mm/s
    carriage_place,    ///< mm; friction by place always opposes the motion
    contraction,       ///< mm, of the platform
    wire_temperature,  ///< degC above the nominal room
    time,              ///< s since the start
};

/// A smooth discrepancy that remains when all named deviations are known.
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

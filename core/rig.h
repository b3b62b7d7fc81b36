#pragma once
// What a rig is: the numbers of a rig file (assets/rig.yaml), checked, in memory. Parts that a rig does not
// have are empty. docs/notation.md states the equations that the numbers enter.
#include "core/camera_covariance.h"
#include "core/camera_geometry.h"
#include "core/hall.h"
#include "core/preisach.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

/// Friction as a dead zone on the saturated command u: the effective voltage is
/// sgn(u) (offset_V + slope (|u| - threshold_V)) for |u| >= threshold_V, else 0.
struct DeadZone {
    double threshold_V = 0.0;
    double offset_V = 0.0;
    double slope = 1.0;
};

/// u = e0 e[k] + e1 e[k-1], e in counts; then friction_V is added with the sign of u.
struct PdGains {
    double e0_V_per_count;
    double e1_V_per_count;
    double friction_V;
};

/// The benchmark controller u = kp e + ki T sum(e) + kd (e[k] - e[k-1]) / T, e in counts.
struct PidGains {
    double kp_V_per_count;
    double ki_V_per_count_s;
    double kd_V_s_per_count;
};

struct MacroParameters {
    double low_mm;  ///< travel
    double high_mm;
    double command_limit_V;
    double velocity_gain_mm_per_s_per_V;
    double velocity_pole;  ///< per tick
    DeadZone dead_zone;
    double encoder_resolution_mm;
    std::optional<PdGains> pd;
    std::optional<PidGains> pid;
};

struct HeaterParameters {
    double onset_V;
    double limit_V;
    double gain_degC_per_V;
    double heating_tau_s;
    double cooling_tau_s;
    double ambient_degC;
};

/// w = kp e + I,  c = clamp(w, low, high),  I += T (ki e + kaw (c - w)),  e in mm.
struct PiGains {
    double kp_V_per_mm;
    double ki_V_per_mm_s;
    double kaw_per_s;
    double low_V;
    double high_V;
};

struct MicroParameters {
    double low_mm;  ///< travel
    double high_mm;
    HeaterParameters heater;
    std::shared_ptr<const FodTable> fod;
    HallParameters hall;
    std::optional<PiGains> pi;
};

struct CameraParameters {
    CameraGeometry geometry;
    double frame_rate_hz;
    double exposure_s;
    double full_well_e;
    double read_noise_e;
    double blur_px;             ///< standard deviation of the optical blur
    double latency_s;           ///< from the middle of the exposure to the frame's arrival
    double corner_noise_px;     ///< of recorded detections that were not made from images
    double max_speed_mm_per_s;  ///< likewise: no tag is seen above it
    double gain_spread = 0.0;   ///< standard deviation of the pixels' gains: a fixed pattern of noise
    /// Of the geometry, as its calibration states it; zero: known to be exact, or not stated.
    CameraCovariance geometry_covariance = CameraCovariance::Zero();
};

/// The grid of fiducials printed on the plate that the rig file describes: tag first_id + column +
/// row * columns is centred at (column pitch_x, row pitch_y).
struct FiducialParameters {
    std::string family;
    double side_mm;
    double pitch_x_mm, pitch_y_mm;
    int columns, rows;
    int first_id;
};

/// An effect beyond the model that the rig is known to have, by its name in the simulator's catalogue.
struct StatedEffect {
    struct Parameter {
        std::string name;
        double value;
    };
    std::string name;
    std::vector<Parameter> parameters;
};

struct Rig {
    std::string name;
    double tick_s;
    MacroParameters macro;
    std::optional<MicroParameters> micro;
    std::optional<CameraParameters> camera;
    std::optional<FiducialParameters> fiducials;
    std::vector<StatedEffect> effects;  ///< the simulator has them; controllers know nothing of them
};

}  // namespace fidservo

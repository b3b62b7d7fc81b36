// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The ports: where a formula may act on the machine, and what it may depend on there.
//
// A formula's value is added to a quantity of the plant's equations (plant/macro_axis.h, plant/heater.h,
// plant/micro_stage.h, plant/camera.h). docs/effects.md has the list for users, made of the table here.
#include "plant/effects/part.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace fidservo::plant {

enum class Port : std::uint8_t {
    drive_voltage,
    force,
    friction,
    encoder,
    heater_power,
    heat_flow,
    transformation,
    contraction,
    platform,
    hall_voltage,
    camera_x,
    camera_y,
    camera_rotation,
    camera_tilt_u,
    camera_tilt_v,
    camera_scale,
    frame_time,
    tag_x,
    tag_y,
};
inline constexpr std::size_t port_count = 19;

/// The part of the machine in whose equations a port is. The ports of a site share its variables, which are
/// evaluated together.
enum class Site : std::uint8_t { carriage, encoder, micro, camera };

/// Indices of variables in the list that a site passes to its formulas.
namespace carriage_variable {
enum : std::size_t { time, command, voltage, place, speed, direction, way, count };
}
namespace encoder_variable {
enum : std::size_t { place, count };
}
namespace micro_variable {
enum : std::size_t {
    time,
    heater_command,
    heater_power,
    wire_temp,
    room_temp,
    contraction,
    contraction_rate,
    platform,
    place,
    speed,
    acceleration,
    drive,
    count
};
}
namespace camera_variable {
enum : std::size_t { time, camera_place, tag_x, tag_y, count };
}
inline constexpr std::size_t most_variables = 12;

struct Variable {
    std::string_view name;
    std::string_view unit;  ///< empty for a dimensionless number
    std::string_view meaning;
};

/// All variables of a site, in the order of its enumeration above.
std::span<const Variable> variables_of(Site site);

struct PortDescription {
    Port port;
    std::string_view name;
    std::string_view unit;
    Site site;
    Part part;  ///< part of the rig, from which a diagnosis knows the signals that it shows in
    std::span<const std::string_view> blocks;  ///< blocks to which effects at this port may belong
    std::span<const std::size_t> variables;    ///< indices in variables_of(site)
    double limit;                              ///< largest value that any machine has, in the port's unit
    bool may_remember;                         ///< whether formulas here may use states, play and delays
    std::string_view meaning;  ///< what a value does, with its equation and when it is evaluated
};

std::span<const PortDescription> ports();
const PortDescription& describe(Port port);
/// The port with a name, or nullptr.
const PortDescription* find_port(std::string_view name);

}  // namespace fidservo::plant

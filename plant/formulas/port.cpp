// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/formulas/port.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace fidservo::plant {

namespace {

constexpr std::array carriage_variables{
    Variable{"time", "s", "of the tick's beginning, since the recording's first tick"},
    Variable{"command", "V", "held over the tick, after saturation"},
    Variable{"voltage", "V", "what the dead zone leaves of drive and forces"},
    Variable{"place", "mm", "of the carriage, or of what drives it where there is play"},
    Variable{"speed", "mm/s", "of the same, positive to the right; sign(speed) is direction"},
    Variable{"direction", "", "1 to the right, -1 to the left; of a carriage at rest, where it is pulled"},
    Variable{"way", "mm",
             "covered until the tick began since the recording's first one, whichever way it went"},
};
static_assert(carriage_variables.size() == carriage_variable::count);

constexpr std::array encoder_variables{
    Variable{"place", "mm", "of the carriage"},
};
static_assert(encoder_variables.size() == encoder_variable::count);

constexpr std::array micro_variables{
    Variable{"time", "s", "since the recording's first tick"},
    Variable{"heater_command", "V", "held over the tick"},
    Variable{"heater_power", "degC", "phi: above the room, where the heater would bring the wire at last"},
    Variable{"wire_temp", "degC", "of the wire"},
    Variable{"room_temp", "degC", "of the room"},
    Variable{"contraction", "mm", "of the wire, as it is: while it is heated, as the last tick left it"},
    Variable{"contraction_rate", "mm/s", "of the same, mean over a tick"},
    Variable{"platform", "mm", "where the platform is"},
    Variable{"place", "mm", "of the carriage, at the end of the tick"},
    Variable{"speed", "mm/s", "of the carriage, at the end of the tick"},
    Variable{"acceleration", "mm/s2", "of the carriage, mean over the tick"},
    Variable{"drive", "V", "of the macro drive"},
};
static_assert(micro_variables.size() == micro_variable::count && micro_variable::count <= most_variables);

constexpr std::array camera_variables{
    Variable{"time", "s", "of the frame, since the recording's first tick"},
    Variable{"camera_place", "mm", "where on the plate the camera should be: carriage and platform"},
    Variable{"tag_x", "mm", "nominal place of the tag on the plate"},
    Variable{"tag_y", "mm", "likewise"},
};
static_assert(camera_variables.size() == camera_variable::count);

using std::string_view;
constexpr std::array drive_blocks{string_view("macro.drive")};
constexpr std::array force_blocks{string_view("macro.mechanics"), string_view("macro.drive"),
                                  string_view("macro.friction")};
constexpr std::array friction_blocks{string_view("macro.friction"), string_view("macro.mechanics")};
constexpr std::array encoder_blocks{string_view("macro.encoder")};
constexpr std::array heater_blocks{string_view("micro.heater")};
constexpr std::array wire_blocks{string_view("micro.hysteresis"), string_view("micro.heater"),
                                 string_view("micro.mechanics")};
constexpr std::array platform_blocks{string_view("micro.mechanics")};
constexpr std::array hall_blocks{string_view("micro.hall")};
constexpr std::array geometry_blocks{string_view("camera.geometry")};
constexpr std::array timing_blocks{string_view("camera.timing")};
constexpr std::array plate_blocks{string_view("plate")};

namespace of_carriage {
using namespace carriage_variable;
constexpr auto at_drive = std::to_array<std::size_t>({time, command, place, speed, direction, way});
constexpr auto at_friction =
    std::to_array<std::size_t>({time, command, voltage, place, speed, direction, way});
}  // namespace of_carriage

constexpr auto at_encoder = std::to_array<std::size_t>({encoder_variable::place});

namespace of_micro {
using namespace micro_variable;
constexpr auto at_heater = std::to_array<std::size_t>(
    {time, heater_command, heater_power, wire_temp, room_temp, contraction, contraction_rate});
constexpr auto at_platform =
    std::to_array<std::size_t>({time, heater_command, heater_power, wire_temp, room_temp, contraction,
                                contraction_rate, place, speed, acceleration, drive});
constexpr auto at_hall =
    std::to_array<std::size_t>({time, wire_temp, room_temp, platform, place, speed, acceleration, drive});
}  // namespace of_micro

namespace of_camera {
using namespace camera_variable;
constexpr auto at_camera = std::to_array<std::size_t>({time, camera_place});
constexpr auto at_clock = std::to_array<std::size_t>({time});
constexpr auto at_plate = std::to_array<std::size_t>({tag_x, tag_y});
}  // namespace of_camera

constexpr double half_turn_rad = std::numbers::pi;

constexpr std::array all_ports{
    PortDescription{
        Port::drive_voltage, "macro.drive_voltage", "V", Site::carriage, Part::carriage, drive_blocks,
        of_carriage::at_drive, 100.0, true,
        "Added to the amplified command, before the dead zone. Evaluated once, at the beginning of a tick, "
        "and held."},
    PortDescription{
        Port::force, "macro.force", "V", Site::carriage, Part::carriage, force_blocks, of_carriage::at_drive,
        100.0, true,
        "A force to the right on the carriage, which it feels at rest, too: added to the drive's voltage "
        "before the dead zone, so that friction holds it while the carriage stands; w = drive + f. With a "
        "belt it acts on the motor's side. Evaluated at every instant of the motion."},
    PortDescription{
        Port::friction, "macro.friction", "V", Site::carriage, Part::carriage, friction_blocks,
        of_carriage::at_friction, 100.0, true,
        "A force F against motion to the right: tau dv/dt = K (V - F) - v. What it is just beside a speed "
        "of 0, to either side, holds a carriage at rest. With a belt it acts on the carriage's side. "
        "Evaluated at every instant of the motion."},
    PortDescription{Port::encoder, "macro.encoder", "mm", Site::encoder, Part::encoder, encoder_blocks,
                    at_encoder, 10.0, false,
                    "Added to the place that the encoder reads. Evaluated when it is sampled."},
    PortDescription{
        Port::heater_power, "micro.heater_power", "degC", Site::micro, Part::wire, heater_blocks,
        of_micro::at_heater, 1000.0, true,
        "Added to phi, the temperature above the room to which the heater would bring the wire at last. "
        "Evaluated at the beginning of a tick, and held."},
    PortDescription{
        Port::heat_flow, "micro.heat_flow", "degC/s", Site::micro, Part::wire, heater_blocks,
        of_micro::at_heater, 1e5, true,
        "Added to the rate of the wire's temperature, dT/dt. Evaluated at the beginning of a tick, and "
        "held."},
    PortDescription{
        Port::transformation, "micro.transformation", "degC", Site::micro, Part::wire, wire_blocks,
        of_micro::at_heater, 200.0, true,
        "Raises the temperatures at which the wire transforms: its table is read at T - f. Evaluated at "
        "the end of a tick, once the wire is heated."},
    PortDescription{Port::contraction, "micro.contraction", "mm", Site::micro, Part::wire, wire_blocks,
                    of_micro::at_heater, 10.0, true,
                    "Added to the wire's contraction by the table. Evaluated at the end of a tick."},
    PortDescription{
        Port::platform, "micro.platform", "mm", Site::micro, Part::platform, platform_blocks,
        of_micro::at_platform, 10.0, true,
        "Added to the platform's place, beside where the wire holds it. Evaluated at the end of a tick."},
    PortDescription{Port::hall_voltage, "micro.hall_voltage", "V", Site::micro, Part::hall, hall_blocks,
                    of_micro::at_hall, 5.0, false,
                    "Added to the Hall sensor's voltage. Evaluated when it is sampled."},
    PortDescription{
        Port::camera_x, "camera.x", "mm", Site::camera, Part::view, geometry_blocks, of_camera::at_camera,
        50.0, false,
        "The camera stands that much to the right of where it should, on the plate. Evaluated in the "
        "middle of a frame's exposure, like all of the camera."},
    PortDescription{Port::camera_y, "camera.y", "mm", Site::camera, Part::view, geometry_blocks,
                    of_camera::at_camera, 50.0, false, "The same, along the plate's y axis."},
    PortDescription{Port::camera_rotation, "camera.rotation", "rad", Site::camera, Part::view,
                    geometry_blocks, of_camera::at_camera, half_turn_rad, false,
                    "Turns the picture from u towards v (plant/camera.h)."},
    PortDescription{Port::camera_tilt_u, "camera.tilt_u", "rad", Site::camera, Part::view, geometry_blocks,
                    of_camera::at_camera, 1.0, false,
                    "Turns the camera about an axis along u through the plate point that it looks at."},
    PortDescription{Port::camera_tilt_v, "camera.tilt_v", "rad", Site::camera, Part::view, geometry_blocks,
                    of_camera::at_camera, 1.0, false, "The same about an axis along v."},
    PortDescription{Port::camera_scale, "camera.scale", "", Site::camera, Part::view, geometry_blocks,
                    of_camera::at_camera, 0.9, false, "Added to the factor of the focal length, which is 1."},
    PortDescription{Port::frame_time, "camera.frame_time", "s", Site::camera, Part::view, timing_blocks,
                    of_camera::at_clock, 1.0, false, "Added to the time with which a frame is stamped."},
    PortDescription{Port::tag_x, "plate.tag_x", "mm", Site::camera, Part::view, plate_blocks,
                    of_camera::at_plate, 50.0, false,
                    "The tag lies that much to the right of where it should, on the plate."},
    PortDescription{Port::tag_y, "plate.tag_y", "mm", Site::camera, Part::view, plate_blocks,
                    of_camera::at_plate, 50.0, false, "The same, along the plate's y axis."},
};
static_assert(all_ports.size() == port_count);

}  // namespace

std::span<const Variable> variables_of(Site site) {
    switch (site) {
        case Site::carriage:
            return carriage_variables;
        case Site::encoder:
            return encoder_variables;
        case Site::micro:
            return micro_variables;
        case Site::camera:
            return camera_variables;
    }
    return {};
}

std::span<const PortDescription> ports() {
    return all_ports;
}

const PortDescription& describe(Port port) {
    return all_ports[static_cast<std::size_t>(port)];
}

const PortDescription* find_port(std::string_view name) {
    const auto found = std::ranges::find(all_ports, name, &PortDescription::name);
    return found == all_ports.end() ? nullptr : &*found;
}

}  // namespace fidservo::plant

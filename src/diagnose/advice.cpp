// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/advice.h"

#include <algorithm>
#include <iterator>

namespace fidservo::diagnose {
namespace {

constexpr Advice table[] = {
    {"drive_gain", "the motor gets another voltage than commanded, by a constant factor",
     "Block the carriage, command a steady voltage of each sign and measure it at the motor's terminals.",
     "Trim the amplifier's gain or mend its supply; otherwise let the rig file state the factor."},
    {"drive_delay", "the drive acts later than the commands are given",
     "Put command output and motor voltage on an oscilloscope and measure the time between a step on both.",
     "Look for a filter, a slow bus or a second sample-and-hold between computer and amplifier."},
    {"drive_offset", "a constant force pushes the carriage to one side",
     "Put a spirit level on the rail. With the command at 0 V measure the voltage at the motor's terminals.",
     "Level the rail; null the amplifier's output."},
    {"coulomb_friction", "dry friction brakes the carriage while it moves",
     "Let the carriage coast: it comes to a sudden stop. Pull it slowly with a spring balance; the force is "
     "the same at any slow speed.",
     "Clean and oil the rail, slacken an over-tight belt or bearing; then identify the drive again."},
    {"stribeck_friction", "friction rises when the carriage moves slowly",
     "Command a slow ramp: the carriage moves in jerks. At higher speed it runs smoothly.",
     "Clean the rail and use a lubricant made for slow motion; keep slow moves short."},
    {"viscous_friction", "the carriage is damped more than the rig file says",
     "Hold several constant commands and note the steady speeds: the loss grows with speed.",
     "Replace stiff or cold grease; check the bearings; otherwise identify the drive's gain again."},
    {"friction_asymmetry", "friction differs between motion to the right and to the left",
     "Command the same voltage both ways over the same stretch and compare the steady speeds.",
     "Align the rail, centre the belt on its pulleys; look for a wiper or cable that drags one way."},
    {"presliding", "the carriage gives elastically before it breaks away",
     "With an indicator on the carriage raise the command slowly: it moves by some micrometres and springs "
     "back when released.",
     "A stiffer bearing or less pre-load shortens this way; otherwise the rig file has to state it."},
    {"rail_patch", "friction is raised around one place of the rail",
     "Move the carriage by hand past the place that the table gives and feel for the drag.",
     "Clean the rail there and look for a dent, dried grease or a cable that rubs."},
    {"cogging", "a force that repeats along the rail pulls at the carriage",
     "Turn the motor by hand without power and feel for steps; compare the period with the pitch of motor "
     "poles, pulley or screw.",
     "Use a motor with skewed poles, a larger pulley, or compensate the force in the controller."},
    {"cable_force", "the cable harness pulls at the carriage like a spring",
     "Unclip the harness, hold it by hand and repeat a recording; the gap should go.",
     "Give the harness a longer loop or a drag chain."},
    {"payload", "the carriage's moving mass is another",
     "Weigh what rides on the carriage, and ask what was mounted or taken off since the rig file was made.",
     "Restore the load, or identify the drive's time constant again."},
    {"belt_compliance", "the belt stretches, so that carriage and motor swing against each other",
     "Pluck the belt and listen; hold the motor's pulley and push the carriage: it should not give.",
     "Tighten the belt to its specified tension or fit a stiffer one."},
    {"backlash", "there is play between motor and carriage",
     "Hold the motor's pulley and rock the carriage against an indicator.",
     "Tighten belt, coupling and grub screws; replace a worn nut."},
    {"encoder_scale", "an encoder count is not the length that the rig file says",
     "Move by a known length (a gauge block, or two tags of the plate) and compare with the counts.",
     "Correct encoder_resolution in the rig file; check the strip's mounting and tension."},
    {"encoder_ripple", "the encoder's error repeats along the rail",
     "Move slowly at constant speed and compare the counts with the tags or a gauge; the error has the "
     "period of the scale or of a screw.",
     "Clean the strip, set the reading head's distance and tilt."},
    {"ambient_temperature", "the room at the wire is warmer or colder than the rig file says",
     "Hang a thermometer next to the wire, away from the electronics, and read it during a recording.",
     "Enter the temperature that you read in the rig file, or shield the wire."},
    {"airflow", "moving air changes how fast the wire cools",
     "Cover the wire with a box and repeat a recording; the gap should change.",
     "Shield the wire from fans and draughts, or take them away."},
    {"heater_gain", "the wire gets more or less heating power than commanded",
     "Measure voltage and current at the wire's ends at a steady command, warm contacts included.",
     "Clean or re-crimp the contacts; check the supply; otherwise identify the heater again."},
    {"heating_lag", "the wire heats up with another time constant",
     "Step the heater from cold several times: the wire reaches its end at a time that the simulator misses "
     "each time in the same way, whatever the step's size.",
     "Check wire diameter and clamps against the rig file; identify the heater again."},
    {"second_thermal_mass", "the mount stores heat and slows the cooling later on",
     "Feel or measure the mount after a minute of heating: it is warm and cools slowly.",
     "Insulate the wire's ends from the mount, or let it warm up before work."},
    {"heater_delay", "the heater acts later than the commands are given",
     "Put command and heater voltage on an oscilloscope and measure the time between a step on both.",
     "Look for a slow PWM stage, a filter or a bus between computer and heater driver."},
    {"stress_shift", "the load on the wire moves its transformation temperatures",
     "Unhook the wire and measure its pull with a spring balance; compare with the bias spring's nominal.",
     "Set the bias spring again; a table of the wire taken at this load is better still."},
    {"stroke_change", "the wire contracts by another length than the rig file's table says",
     "Measure the full stroke with an indicator, cold and fully heated.",
     "Check clamps for slip; replace a fatigued wire; otherwise identify the hysteresis again."},
    {"macro_coupling", "the carriage's acceleration swings the platform on its flexures",
     "Tap the carriage with the wire cold and watch the Hall reading ring.",
     "Limit the carriage's acceleration, wait until it has rung out, or damp the flexures."},
    {"hall_gain", "the Hall sensor's slope is another",
     "Move the platform between both stops and compare the reading's span with an indicator.",
     "Set the magnet's distance; run fidservo calibrate hall."},
    {"hall_offset", "the Hall sensor's zero is another",
     "Read the sensor with the platform at rest and the wire cold, and compare with the rig file.",
     "Set the magnet's place; run fidservo calibrate hall."},
    {"hall_nonlinearity", "the Hall sensor's curve is bent in another way than the rig file says",
     "Compare the reading with an indicator or the tags at five places over the stroke: the ends agree, the "
     "quarters do not.",
     "Run fidservo calibrate hall; look for a tilted magnet or iron near the sensor."},
    {"hall_drift", "the Hall sensor's zero moves with time",
     "Record ten minutes at rest and look for a slope in the reading.",
     "Let the sensor warm up, stabilise its supply, keep it away from the heated wire."},
    {"hall_crosstalk", "the macro drive's voltage leaks into the Hall reading",
     "Block the carriage, command steps of the macro drive and watch the Hall reading jump with them.",
     "Give the sensor its own ground return, twist and shield its leads, route them away from the motor."},
    {"pixel_scale", "the image is larger or smaller than the camera file says",
     "Measure a tag's side in the image and compare with its printed side.",
     "Set focus and distance as they were at calibration; run fidservo calibrate camera."},
    {"camera_rotation", "the camera is turned about its optical axis",
     "Move the stage and look whether a tag wanders up or down in the image.",
     "Turn the camera straight in its mount, or run fidservo calibrate stage."},
    {"camera_tilt", "the camera does not look straight down",
     "Compare the sides of a tag at opposite edges of the image: one side looks larger.",
     "Shim the camera's mount; run fidservo calibrate camera."},
    {"lens_distortion", "the lens distorts the image beyond what the camera file says",
     "Photograph a straight edge along the border of the image: it looks bent.",
     "Run fidservo calibrate camera with the lens as it is used."},
    {"camera_latency", "the frames' time stamps are late",
     "Move the stage to and fro: the tags lag behind the encoder by a constant time.",
     "Enter the latency in the rig file; stamp frames at the exposure's trigger if the camera can."},
    {"clock_skew", "the camera's clock runs at another rate than the computer's",
     "Compare the time stamps of a long recording with the computer's clock at its start and its end.",
     "Use the computer's clock for stamps, or synchronise the clocks."},
    {"defocus", "the image is out of focus",
     "Look at a tag's edge in a frame: it spreads over several pixels everywhere in the image.",
     "Focus the lens and lock its ring; check the distance to the plate."},
    {"motion_blur", "frames are exposed for longer than the rig file says",
     "Compare a frame taken in motion with one at rest: only edges across the motion are blurred.",
     "Switch automatic exposure off; shorten the exposure and add light."},
    {"uneven_light", "the plate is lit unevenly",
     "Photograph white paper and compare the grey levels of centre, corners and sides.",
     "Add a diffuser or a second lamp; set the lens aperture smaller against dark corners."},
    {"sensor_noise", "the camera's image is noisier than the rig file says",
     "Take two frames of the same place and look at their difference.",
     "Add light and lower the camera's gain; cool a hot camera."},
    {"rolling_shutter", "the image's rows are exposed one after the other",
     "Compare a tag in motion with one at rest: it is sheared.",
     "Use a camera with a global shutter, or measure at rest only."},
};

struct DependenceAdvice {
    std::string_view dependence, text;
};

/// A name that begins like another one comes before it.
constexpr DependenceAdvice dependences[] = {
    {"velocity", "Friction, damping or back-EMF of another kind: look at bearings, lubricant and belt."},
    {"direction", "Something that turns over with the motion: play, a dragging wiper or cable, hysteresis."},
    {"position, periodic, times the drive's force",
     "What turns between motor and carriage: a pulley or a shaft that runs out of true once per turn."},
    {"position, periodic",
     "Something that repeats along the way: compare the period with the pitch of motor poles, pulley teeth, "
     "screw and encoder scale."},
    {"position, against the motion",
     "Friction at a place: dirt, a dent or a dry spot on the rail; clean and oil it there."},
    {"position",
     "Something that is fixed to a place: dirt or a dent on the rail, the cable harness, a bent scale."},
    {"acceleration", "Mass, or something loose or elastic that swings: look at mounts, screws and flexures."},
    {"changes of the command", "A delay between the program and the drive: buffers, a slow bus, a filter."},
    {"nothing", "A constant force or voltage: an offset of the amplifier, a tilted rail."},
    {"command, periodic", "The converter that sets the voltage: missing bits, coarse steps."},
    {"command", "The amplifier: saturation, a dead zone or a gain that is not constant."},
    {"time", "Something that drifts during a run: warming up, a sagging supply, draughts."},
    {"temperature", "Heat flow or the wire's table: supply, contacts, clamps, draughts, a tired wire."},
    {"turns between",
     "The wire's memory of partial heatings is another than the rig file's table says: identify the "
     "hysteresis "
     "again, with small loops among the large ones."},
    {"contraction before", "The wire creeps after itself: load, age, a wire that slips in its clamps."},
    {"place of the platform",
     "Something that the platform meets on its way: a stop, a spring, a stiff cable."},
    {"way since the wire turned", "Play between wire and platform: clamps, crimps, hinges."},
    {"way gone so far, against the motion",
     "Friction that changes as the stage runs in: lubricant, a new or a worn bearing; let it run for some "
     "minutes first."},
    {"whether it stands or slides",
     "Friction that holds a resting carriage for longer than it brakes a sliding one: dried lubricant, a "
     "sticky "
     "seal."},
    {"place on the plate, across the motion", "The plate is turned against the stage's axis: square it up."},
    {"which tag it is", "Tags are not where they should be: measure the print, or print the plate again."},
    {"contraction", "The Hall sensor's curve: its magnet's place and tilt, iron near by."},
    {"macro command",
     "The macro drive's current gets into a sensor: ground return, shielding, lead routing."},
    {"place in the image", "The lens or the camera's mount: run fidservo calibrate camera."},
};

}  // namespace

std::span<const Advice> all_advice() {
    return table;
}

const Advice* advice_on(std::string_view effect) {
    const auto* const found = std::ranges::find(table, effect, &Advice::effect);
    return found == std::end(table) ? nullptr : found;
}

std::string_view advice_on_dependence(std::string_view dependence) {
    const auto* const found = std::ranges::find_if(dependences, [&](const DependenceAdvice& advice) {
        return dependence.starts_with(advice.dependence);
    });
    return found == std::end(dependences) ? std::string_view{} : found->text;
}

}  // namespace fidservo::diagnose

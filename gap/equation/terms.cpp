#include "gap/equation/terms.h"

#include "core/rig.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::gap {

namespace {

Covered covered(std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty()) return {};
    constexpr double tail = 0.01;
    const auto at = [&](double share) {
        const auto place =
            values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::ranges::nth_element(values, place);
        return *place;
    };
    const double low = at(tail);
    return {low, at(1.0 - tail)};
}

/// A variable with what the recordings cover of it.
struct Known {
    const char* name;
    const char* unit;
    Covered range;
    const char* words;  ///< in a sentence

    static std::string digits(double value) { return fmt::format("{:.6g}", value); }
    /// To a hundredth of what is covered, or less.
    double rounded(double value) const {
        const double step =
            0.5 * std::pow(10.0, std::floor(std::log10(std::max(1e-9, 2.0 * range.half()))) - 1.0);
        return step * std::round(value / step) + 0.0;
    }
    std::string clipped() const {
        return fmt::format("clip({}, {}, {})", name, digits(rounded(range.low)), digits(rounded(range.high)));
    }
    /// About its middle, where it does not change sign there.
    double origin() const {
        constexpr double hardly = 0.1;
        const bool has_both_signs = std::min(-range.low, range.high) > hardly * range.half();
        return has_both_signs ? 0.0 : rounded(range.middle());
    }
    std::string centred() const {
        const double at = origin();
        return at == 0.0 ? clipped() : fmt::format("({} - {})", clipped(), digits(at));
    }
    double reach() const { return std::max({range.high - origin(), origin() - range.low, 1e-9}); }
    std::string power_unit(int power) const {
        const std::string base = unit;
        if (power == 1) return base;
        return base.find('/') == std::string::npos ? fmt::format("{}{}", base, power)
                                                   : fmt::format("({}){}", base, power);
    }
};

class Library {
  public:
    const std::vector<Term>& terms() const { return terms_; }

    void add(std::string text, std::string unit, double size, std::string words) {
        terms_.push_back({{std::move(text)}, std::move(unit), size, {}, next_family_++, std::move(words)});
    }

    void add_constant(const std::string& factor, const std::string& words) {
        add(factor.empty() ? "1" : factor, "", 1.0, words);
    }

    /// Powers of a variable about its middle, times a factor of order 1.
    void add_powers(const Known& of, int highest, const std::string& factor = {}) {
        constexpr std::array names{"in proportion to", "growing with the square of",
                                   "growing with the cube of"};
        for (int power = 1; power <= highest; ++power) {
            std::string text = of.centred();
            if (power > 1) text += fmt::format("^{}", power);
            if (!factor.empty()) text = fmt::format("{} * {}", factor, text);
            add(std::move(text), of.power_unit(power), std::pow(of.reach(), power),
                fmt::format("{} {}", names[static_cast<std::size_t>(power - 1)], of.words));
        }
    }

    void add_product(const Known& left, const Known& right) {
        add(fmt::format("{} * {}", left.centred(), right.centred()),
            fmt::format("{} {}", left.unit, right.unit), left.reach() * right.reach(),
            fmt::format("in proportion to {} times {}", left.words, right.words));
    }

    /// The same function for several values of its shape.
    /// @param texts  with `shape` in them
    void add_shaped(const std::vector<std::string>& texts, const char* shape_unit,
                    std::span<const double> values, double low, double high, const std::string& words) {
        const int family = next_family_++;
        for (const double value : values)
            terms_.push_back(
                {texts, "", 1.0, TermShape{"shape", shape_unit, value, low, high}, family, words});
    }

    void add_waves(const std::string& variable, std::span<const double> periods_mm,
                   const std::string& factor = {}) {
        const std::string start = factor.empty() ? "" : factor + " * ";
        for (const double period_mm : periods_mm) {
            const int family = next_family_++;
            terms_.push_back({{fmt::format("{}sin(2 * pi * {} / shape)", start, variable),
                               fmt::format("{}cos(2 * pi * {} / shape)", start, variable)},
                              "",
                              1.0,
                              TermShape{"shape", "mm", period_mm, 0.9 * period_mm, 1.1 * period_mm},
                              family,
                              fmt::format("a wave along the way, {:.3g} mm long", period_mm)});
        }
    }

  private:
    std::vector<Term> terms_;
    int next_family_ = 0;
};

constexpr std::array time_constants_s{3.0, 10.0, 30.0};
constexpr std::array falling_speeds_mm_per_s{3.0, 8.0, 20.0, 60.0};

/// Bells along the rail, of a twelfth of what was covered and of a quarter, side by side.
void add_bells(Library& library, const Covered& place_mm, const std::string& factor) {
    const std::string start = factor.empty() ? "" : factor + " * ";
    for (const int count : {12, 4}) {
        const double width_mm = 2.0 * place_mm.half() / count;
        for (int k = 0; k < count; ++k) {
            const double at_mm = place_mm.low + (k + 0.5) * width_mm;
            library.add_shaped({fmt::format("{}exp(-((place - shape) / {:.4g})^2)", start, width_mm)}, "mm",
                               std::array{at_mm}, at_mm - width_mm, at_mm + width_mm, "around one place");
        }
    }
}

void add_fading(Library& library, const std::string& factor, const std::string& words) {
    library.add_shaped({fmt::format("{}exp(-time / shape)", factor.empty() ? "" : factor + " * ")}, "s",
                       time_constants_s, 0.3, 300.0, words);
}

/// About the middle of what is covered.
void add_steps_and_bells(Library& library, const Known& of) {
    const double reach = of.reach();
    const std::array widths{0.2 * reach, 0.5 * reach};
    library.add_shaped({fmt::format("tanh(({} - {:.6g}) / shape)", of.name, of.origin())}, of.unit, widths,
                       0.02 * reach, 3.0 * reach, fmt::format("that steps with {}", of.words));
    library.add_shaped({fmt::format("exp(-(({} - {:.6g}) / shape)^2)", of.name, of.origin())}, of.unit,
                       widths, 0.02 * reach, 3.0 * reach, fmt::format("around the middle of {}", of.words));
}

void add_carriage_terms(Library& library, plant::Port port, const CoveredRanges& ranges,
                        std::span<const double> periods_mm) {
    const Known place{"place", "mm", ranges.place_mm, "the place on the rail"};
    const Known speed{"speed", "mm/s", ranges.speed_mm_per_s, "speed"};
    const Known command{"command", "V", ranges.command_V, "the command"};
    const Known time{"time", "s", ranges.time_s, "time"};
    const Known way{"way", "mm", ranges.way_mm, "the way gone"};
    if (port == plant::Port::force) {
        library.add_constant({}, "the same everywhere");
        library.add_powers(place, 3);
        library.add_waves("place", periods_mm);
        add_bells(library, ranges.place_mm, {});
        library.add_powers(time, 1);
        add_fading(library, {}, "fading with time");
        return;
    }
    if (port == plant::Port::drive_voltage) {
        library.add_powers(command, 1);
        library.add(fmt::format("{0} * abs({0})", command.clipped()), "V2", std::pow(command.reach(), 2),
                    "growing with the square of the command");
        library.add_powers(command, 3);
        library.add_product(command, place);
        library.add_product(command, time);
        library.add_waves("place", periods_mm, command.clipped());
        return;
    }
    library.add_constant("direction", "constant against the motion");
    library.add_powers(speed, 1);
    library.add(fmt::format("{0} * abs({0})", speed.clipped()), "mm2/s2", std::pow(speed.reach(), 2),
                "growing with the square of speed, as the drag of a fluid does");
    library.add(fmt::format("{}^3", speed.clipped()), "mm3/s3", std::pow(speed.reach(), 3),
                "growing with the cube of speed");
    library.add(fmt::format("abs({})", speed.clipped()), "mm/s", speed.reach(),
                "in proportion to speed, other ways for the other direction");
    library.add_shaped({"direction * exp(-abs(speed) / shape)"}, "mm/s", falling_speeds_mm_per_s, 0.5, 300.0,
                       "that falls with speed (Stribeck)");
    library.add_powers(place, 2, "direction");
    library.add_product(speed, place);
    library.add_waves("place", periods_mm, "direction");
    add_bells(library, ranges.place_mm, "direction");
    library.add_powers(time, 1, "direction");
    library.add_product(speed, time);
    add_fading(library, "direction", "fading with time");
    add_fading(library, speed.clipped(), "in proportion to speed, fading with time");
    library.add_powers(way, 1, "direction");
    library.add(fmt::format("direction * abs({})", command.clipped()), "V", command.reach(),
                "in proportion to what the drive pushes with, against the motion");
    library.add(fmt::format("direction * abs({0}) * abs({0})", "voltage"), "V2", std::pow(command.reach(), 2),
                "growing with the square of what the drive pushes with, against the motion");
}

void add_micro_terms(Library& library, plant::Port port, const CoveredRanges& ranges) {
    const Known wire{"wire_temp", "degC", ranges.wire_degC, "the wire's temperature"};
    const Known contraction{"contraction", "mm", ranges.contraction_mm, "contraction"};
    const Known platform{"platform", "mm", ranges.contraction_mm, "the platform's place"};
    const Known time{"time", "s", ranges.time_s, "time"};
    const Known place{"place", "mm", ranges.place_mm, "the carriage's place"};
    const Known speed{"speed", "mm/s", ranges.speed_mm_per_s, "the carriage's speed"};
    const double rise = std::max(1.0, ranges.wire_degC.high - ranges.wire_degC.low);
    const double rate = std::max(0.1, ranges.contraction_mm.high - ranges.contraction_mm.low);
    const auto add_rise = [&](int highest) {
        for (int power = 1; power <= highest; ++power)
            library.add(
                power == 1 ? "(wire_temp - room_temp)" : fmt::format("(wire_temp - room_temp)^{}", power),
                power == 1 ? "degC" : fmt::format("degC{}", power), std::pow(rise, power),
                power == 1
                    ? "in proportion to the wire's warmth above the room"
                    : fmt::format("growing with the power {} of the wire's warmth above the room", power));
    };
    switch (port) {
        case plant::Port::heater_power:
            library.add("heater_power", "degC", rise, "in proportion to the heater's power");
            library.add("heater_power^2", "degC2", rise * rise,
                        "growing with the square of the heater's power");
            library.add_constant("(heater_power > 0)", "the same whenever it is heated");
            library.add("heater_power * time", "degC s", rise * ranges.time_s.high,
                        "in proportion to power and time");
            add_steps_and_bells(library, {"heater_power", "degC", {0.0, rise}, "the heater's power"});
            return;
        case plant::Port::heat_flow:
            library.add_constant({}, "the same at all times");
            add_rise(3);
            library.add("contraction_rate", "mm/s", rate,
                        "in proportion to the rate of contraction, as latent heat is");
            library.add("abs(contraction_rate)", "mm/s", rate,
                        "in proportion to the speed of transformation");
            library.add_powers(contraction, 2);
            library.add("(wire_temp - room_temp) * clip(contraction, 0, 5)", "degC mm", rise * 2.0,
                        "in proportion to warmth times contraction");
            add_steps_and_bells(library, wire);
            add_steps_and_bells(library, contraction);
            return;
        case plant::Port::transformation:
            library.add_constant({}, "the same always");
            library.add_powers(contraction, 3);
            library.add("contraction_rate", "mm/s", rate, "in proportion to the rate of contraction");
            library.add("sign(contraction_rate)", "", 1.0,
                        "of one sign in contraction, the other in extension");
            library.add_powers(time, 1);
            add_steps_and_bells(library, contraction);
            return;
        case plant::Port::contraction:
            library.add_powers(contraction, 3);
            add_steps_and_bells(library, contraction);
            library.add_powers(wire, 2);
            add_steps_and_bells(library, wire);
            library.add("contraction_rate", "mm/s", rate, "in proportion to its rate, as a lag is");
            library.add("clip(contraction, 0, 5) * time", "mm s", 2.0 * ranges.time_s.high,
                        "in proportion to contraction and time");
            return;
        case plant::Port::platform:
            library.add("acceleration", "mm/s2", 1e3, "in proportion to the carriage's acceleration");
            library.add_powers(speed, 1);
            library.add_powers(place, 2);
            return;
        case plant::Port::hall_voltage:
            library.add_constant({}, "the same always");
            library.add_powers(platform, 3);
            add_steps_and_bells(library, platform);
            library.add_powers(time, 1);
            add_fading(library, {}, "fading with time");
            library.add("drive", "V", 3.0, "in proportion to the drive's voltage");
            library.add_powers(place, 2);
            library.add("acceleration", "mm/s2", 1e3, "in proportion to the carriage's acceleration");
            return;
        default:
            return;
    }
}

void add_camera_terms(Library& library, plant::Port port, const CoveredRanges& ranges,
                      std::span<const double> periods_mm) {
    const Known camera{"camera_place", "mm", ranges.place_mm, "the camera's place"};
    const Known tag{"tag_x", "mm", ranges.place_mm, "the tag's place"};
    const Known time{"time", "s", ranges.time_s, "time"};
    switch (port) {
        case plant::Port::tag_x:
        case plant::Port::tag_y:
            library.add_powers(tag, 3);
            add_steps_and_bells(library, tag);
            library.add_waves("tag_x", periods_mm);
            return;
        case plant::Port::frame_time:
            library.add_constant({}, "constant");
            library.add_powers(time, 2);
            return;
        default:
            library.add_constant({}, "constant");
            library.add_powers(camera, 3);
            add_steps_and_bells(library, camera);
            library.add_powers(time, 2);
            add_fading(library, {}, "fading with time");
            return;
    }
}

}  // namespace

CoveredRanges covered_ranges(const Evidence& evidence) {
    std::vector<double> time_s, command_V, place_mm, speed_mm_per_s, way_mm, wire_degC, contraction_mm;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run) {
        const std::vector<StageRow>& rows = evidence.recordings()[run].rows;
        const Course& course = evidence.course(run);
        double way = 0.0;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            time_s.push_back(seconds(rows[k].time_ns - rows.front().time_ns));
            command_V.push_back(rows[k].macro_command_V);
            place_mm.push_back(course.position_mm[k]);
            speed_mm_per_s.push_back(course.velocity_mm_per_s[k]);
            if (std::isfinite(course.velocity_mm_per_s[k]))
                way += std::abs(static_cast<double>(course.velocity_mm_per_s[k])) * evidence.rig().tick_s;
            way_mm.push_back(way);
            wire_degC.push_back(course.temperature_degC[k]);
            contraction_mm.push_back(course.contraction_mm[k]);
        }
    }
    return {covered(std::move(time_s)),         covered(std::move(command_V)), covered(std::move(place_mm)),
            covered(std::move(speed_mm_per_s)), covered(std::move(way_mm)),    covered(std::move(wire_degC)),
            covered(std::move(contraction_mm))};
}

std::vector<Term> terms_of(plant::Port port, const CoveredRanges& ranges,
                           std::span<const double> periods_mm) {
    Library library;
    switch (plant::describe(port).site) {
        case plant::Site::carriage:
            add_carriage_terms(library, port, ranges, periods_mm);
            break;
        case plant::Site::encoder:
            library.add_powers({"place", "mm", ranges.place_mm, "the place on the rail"}, 3);
            library.add_waves("place", periods_mm);
            break;
        case plant::Site::micro:
            add_micro_terms(library, port, ranges);
            break;
        case plant::Site::camera:
            add_camera_terms(library, port, ranges, periods_mm);
            break;
    }
    return library.terms();
}

}  // namespace fidservo::gap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/chain_drawing.h"

#include "core/rig.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using gap::Signal;
using report::escaped;

constexpr double drawing_width = 1180.0, drawing_margin = 6.0;
constexpr double block_width = 121.0, boundary_width = 206.0, part_height = 82.0;
constexpr double part_gap = 20.0;           ///< between two parts
constexpr double stage_row_height = 146.0;  ///< from one row of parts to the next
constexpr double first_row = 46.0;
constexpr double accused_from = 0.5, suspect_from = 0.05;

struct Block {
    std::string_view name;   ///< as gap::BlockProbability has it
    std::string_view title;  ///< in the drawing
};

/// A stage: from its controller to its sensor.
struct PartsOfStage {
    std::string_view title;
    Signal command, sensor;
    std::vector<Block> blocks;
    bool is_controlled;
};

/// Appends to an SVG, from left to right or from right to left.
class Drawing {
  public:
    Drawing(const Rig& rig, const gap::Diagnosis& diagnosis) : rig_(rig), diagnosis_(diagnosis) {}

    void block(double x, double y, const Block& block) {
        const double probability = probability_of(block.name);
        const std::string_view state = probability >= accused_from   ? " accused"
                                       : probability >= suspect_from ? " suspect"
                                                                     : "";
        svg_ += fmt::format(
            "<g class=\"block{}\" data-block=\"{}\"><rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{}\" "
            "height=\"{}\" rx=\"7\"/>",
            state, escaped(block.name), x, y, block_width, part_height);
        const double centre = x + block_width / 2;
        text(centre, y + 24, "title", block.title);
        const std::vector<std::string> effects = effects_in(block.name);
        for (std::size_t k = 0; k < std::min<std::size_t>(effects.size(), 2); ++k)
            text(centre, y + 42 + 15 * static_cast<double>(k), "effect", readable(effects[k]));
        if (!state.empty()) text(centre, y + part_height - 8, "share", probability_words(probability));
        svg_ += "</g>";
    }

    void boundary(double x, double y, Signal signal, std::string_view title) {
        const auto found = std::ranges::find(diagnosis_.signals, signal, &gap::SignalGap::signal);
        const bool is_judged = found != diagnosis_.signals.end();
        const int size = is_judged ? size_class(found->before / found->floor) : 0;
        const int left = is_judged ? size_class(found->after / found->floor) : 0;
        svg_ += fmt::format(
            "<g class=\"boundary {}\" data-signal=\"{}\"><rect class=\"outline\" x=\"{:.0f}\" y=\"{:.0f}\" "
            "width=\"{}\" height=\"{}\" rx=\"12\"/>",
            is_judged ? fmt::format("size-{}", size) : "unjudged", gap::name_of(signal), x, y, boundary_width,
            part_height);
        const double centre = x + boundary_width / 2;
        text(centre, y + 20, "title", title);
        if (is_judged) {
            const bool is_explained = !diagnosis_.effects.empty();
            line_of_gap(x, y + (is_explained ? 30 : 42), size, is_explained ? "before" : "gap", found->before,
                        found->floor, signal);
            if (is_explained) line_of_gap(x, y + 54, left, "after", found->after, found->floor, signal);
        } else {
            text(centre, y + 44, "note", "fed in as recorded,");
            text(centre, y + 61, "note", "not judged");
        }
        svg_ += "</g>";
    }

    void arrow(const std::string& path, std::string_view kind = "wire") {
        svg_ += fmt::format("<path class=\"{}\" d=\"{}\" marker-end=\"url(#chain-tip)\"/>", kind, path);
    }

    void line(const std::string& path) { svg_ += fmt::format("<path class=\"wire\" d=\"{}\"/>", path); }

    void text(double x, double y, std::string_view kind, std::string_view words,
              std::string_view anchor = "middle") {
        svg_ += fmt::format("<text class=\"{}\" x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"{}\">{}</text>", kind,
                            x, y, anchor, escaped(words));
    }

    std::string finished(double height) const {
        return fmt::format(
                   "<div class=\"scroll\"><svg class=\"chain\" viewBox=\"0 0 {} {:.0f}\" role=\"img\" "
                   "aria-label=\"The signal chain with the gap at each measured boundary\"><defs><marker "
                   "id=\"chain-tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" "
                   "markerHeight=\"8\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\"/></marker></defs>",
                   drawing_width, height) +
               svg_ + "</svg></div>\n";
    }

  private:
    double probability_of(std::string_view block) const {
        const auto found = std::ranges::find(diagnosis_.where, block, &gap::BlockProbability::block);
        return found == diagnosis_.where.end() ? 0.0 : found->probability;
    }

    std::vector<std::string> effects_in(std::string_view block) const {
        std::vector<std::string> names;
        for (const gap::FoundEffect& effect : diagnosis_.effects)
            if (effect.block == block) names.push_back(effect.effect);
        return names;
    }

    /// A bar in the colour of a gap's size, and the gap in floors and in the unit that people read.
    void line_of_gap(double x, double y, int size, std::string_view when, double own_unit, double floor,
                     Signal signal) {
        svg_ += fmt::format(
            "<rect class=\"gap size-{}\" x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"21\" rx=\"4\"/>",
            size, x + 6, y, boundary_width - 12);
        text(x + 12, y + 15, "when", when, "start");
        text(x + boundary_width - 12, y + 15, "value",
             fmt::format("{} fl \u00b7 {}", floors_words(own_unit / floor),
                         shown_size(rig_, signal, own_unit)),
             "end");
    }

    const Rig& rig_;
    const gap::Diagnosis& diagnosis_;
    std::string svg_;
};

std::string straight(double x, double y, double to_x) {
    return fmt::format("M{:.0f} {:.0f}H{:.0f}", x, y, to_x);
}

/// Returns where the sensor's boundary ends.
double draw_stage(Drawing& drawing, const PartsOfStage& row, double y) {
    const double middle = y + part_height / 2;
    drawing.text(drawing_margin, y - 26, "row", row.title, "start");
    double x = drawing_margin;
    if (row.is_controlled) drawing.block(x, y, {"controller", "Controller"});
    const double controller = x + block_width / 2;
    x += block_width;
    if (row.is_controlled) drawing.arrow(straight(x, middle, x + part_gap));
    x += part_gap;
    drawing.boundary(x, y, row.command, row.command == Signal::macro_command ? "Command" : "Heater command");
    x += boundary_width;
    for (const Block& block : row.blocks) {
        drawing.arrow(straight(x, middle, x + part_gap));
        x += part_gap;
        drawing.block(x, y, block);
        x += block_width;
    }
    const double sensor = drawing_width - drawing_margin - boundary_width - part_gap;
    drawing.arrow(straight(x, middle, sensor));
    drawing.boundary(sensor, y, row.sensor,
                     row.sensor == Signal::encoder ? "Encoder reading" : "Hall reading");
    if (row.is_controlled)
        drawing.arrow(fmt::format("M{:.0f} {:.0f}V{:.0f}H{:.0f}V{:.0f}", sensor + boundary_width / 2, y,
                                  y - 16, controller, y),
                      "feedback");
    return sensor + boundary_width;
}

void draw_camera(Drawing& drawing, double y, bool has_looks) {
    constexpr Block blocks[] = {{"plate", "Plate of tags"},
                                {"camera.geometry", "Lens, mounting"},
                                {"camera.timing", "Frame times"},
                                {"camera.image", "Image quality"}};
    const double middle = y + part_height / 2;
    drawing.text(drawing_width - drawing_margin - part_gap, y - 12, "row", "Camera over the plate", "end");
    double x = drawing_width - drawing_margin - part_gap;
    drawing.arrow(fmt::format("M{:.0f} {:.0f}H{:.0f}", drawing_width - drawing_margin, middle, x));
    for (const Block& block : blocks) {
        x -= block_width;
        drawing.block(x, y, block);
        drawing.arrow(straight(x, middle, x - part_gap));
        x -= part_gap;
    }
    x -= boundary_width;
    drawing.boundary(x, y, Signal::tag, "Tags in the image");
    if (!has_looks) return;
    drawing.arrow(straight(x, middle, x - part_gap));
    drawing.boundary(x - part_gap - boundary_width, y, Signal::image, "Blur, light, noise");
}

}  // namespace

std::string chain_drawing_svg(const Rig& rig, const gap::Diagnosis& diagnosis) {
    Drawing drawing(rig, diagnosis);
    const bool has_camera = rig.camera && rig.fiducials;
    double y = first_row;
    std::vector<std::pair<double, double>> ends;
    const auto add = [&](const PartsOfStage& row) {
        ends.emplace_back(draw_stage(drawing, row, y), y + part_height / 2);
        y += stage_row_height;
    };
    add({"Macro stage",
         Signal::macro_command,
         Signal::encoder,
         {{"macro.drive", "Drive"},
          {"macro.friction", "Friction"},
          {"macro.mechanics", "Mechanics"},
          {"macro.encoder", "Encoder"}},
         rig.macro.pd || rig.macro.pid});
    if (rig.micro)
        add({"Micro stage",
             Signal::micro_command,
             Signal::hall,
             {{"micro.heater", "Heater, cooling"},
              {"micro.hysteresis", "Wire"},
              {"micro.mechanics", "Platform"},
              {"micro.hall", "Hall sensor"}},
             rig.micro->pi.has_value()});
    if (has_camera) {
        const double bus = drawing_width - drawing_margin;
        for (const auto& [x, middle] : ends) drawing.line(straight(x, middle, bus));
        drawing.line(fmt::format("M{0:.0f} {1:.0f}V{2:.0f}", bus, ends.front().second, y + part_height / 2));
        const bool has_looks = std::ranges::find(diagnosis.signals, Signal::image, &gap::SignalGap::signal) !=
                               diagnosis.signals.end();
        draw_camera(drawing, y, has_looks);
        y += stage_row_height;
    }
    return drawing.finished(y - stage_row_height + part_height + 8);
}

}  // namespace fidservo::diagnose

// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/comedi/wiring.h"

#include "core/input_error.h"
#include "core/rig.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

namespace fidservo::control::comedi {

namespace {

constexpr double slack_V = 1e-6;  ///< what ranges may differ by: Comedi has them in uV

std::string text_of(const VoltageRange& range) {
    return fmt::format("[{:g}, {:g}]", range.low_V, range.high_V);
}

std::string text_of(const std::vector<VoltageRange>& ranges) {
    std::string text;
    for (const VoltageRange& range : ranges)
        if (range.low_V < range.high_V) text += (text.empty() ? "" : ", ") + text_of(range);
    return text.empty() ? "none in volts" : text;
}

bool holds(const VoltageRange& range, const VoltageRange& needed) {
    return range.low_V <= needed.low_V + slack_V && range.high_V >= needed.high_V - slack_V;
}

double width_V(const VoltageRange& range) {
    return range.high_V - range.low_V;
}

/// One key of the map against the board.
class Check {
  public:
    Check(std::string key, const ChannelChoice& choice, const BoardLink& board)
        : key_("stage.comedi." + std::move(key)), choice_(choice), board_(board) {}

    SubdeviceKind demand(std::initializer_list<SubdeviceKind> allowed) const {
        const SubdeviceKind kind = board_.kind(choice_.subdevice);
        if (std::ranges::find(allowed, kind) == allowed.end()) {
            std::string words;
            for (const SubdeviceKind one : allowed)
                words += (words.empty() ? "" : " or ") + std::string(name_of(one));
            fail("subdevice", fmt::format("{}", choice_.subdevice),
                 fmt::format("is {} on {}; must be {}", name_of(kind), board_.name(), words));
        }
        if (const int count = board_.channels(choice_.subdevice); choice_.channel >= count)
            fail("channel", fmt::format("{}", choice_.channel),
                 fmt::format("subdevice {} of {} has channels 0 to {}", choice_.subdevice, board_.name(),
                             count - 1));
        return kind;
    }

    Terminal plain() const {
        return {{choice_.subdevice, choice_.channel, 0},
                {},
                board_.max_value(choice_.subdevice, choice_.channel)};
    }

    /// In the range chosen, or in the narrowest one that suffices.
    Terminal in_volts(const VoltageRange& needed, std::string_view what) const {
        const auto ranges = board_.ranges(choice_.subdevice, choice_.channel);
        const VoltageRange* best = nullptr;
        for (const VoltageRange& range : ranges) {
            if (choice_.range ? !same(range, *choice_.range) : !holds(range, needed)) continue;
            if (best == nullptr || width_V(range) < width_V(*best)) best = &range;
        }
        const std::string chosen = choice_.range ? text_of(*choice_.range) : "none given";
        if (best == nullptr)
            fail("range_V", chosen,
                 fmt::format("the board's channel has {}; needed for {}: {} V", text_of(ranges), what,
                             text_of(needed)));
        if (!holds(*best, needed))
            fail("range_V", chosen, fmt::format("does not hold {}, {} V", what, text_of(needed)));
        Terminal terminal = plain();
        terminal.at.range = static_cast<int>(best - ranges.data());
        terminal.range = *best;
        return terminal;
    }

    [[noreturn]] void fail(std::string_view key, std::string_view value, std::string_view message) const {
        throw InputError(fmt::format("{}.{}: {}: {}", key_, key, value, message));
    }

  private:
    static bool same(const VoltageRange& a, const VoltageRange& b) { return holds(a, b) && holds(b, a); }

    std::string key_;
    const ChannelChoice& choice_;
    const BoardLink& board_;
};

void wire_macro(const MacroChannel& macro, const BoardLink& board, const Rig& rig, Wiring& wiring) {
    const double limit_V = rig.macro.command_limit_V;
    const Check output("macro", macro.output, board);
    output.demand({SubdeviceKind::analogue_out});
    wiring.macro =
        output.in_volts({macro.direction ? 0.0 : -limit_V, limit_V}, "macro.command_limit_V either way");
    wiring.macro_reversed = macro.reversed;
    if (!macro.direction) return;
    const Check line("macro.direction", *macro.direction, board);
    line.demand({SubdeviceKind::digital_out, SubdeviceKind::digital_io});
    wiring.direction = line.plain();
}

void wire_hall(const ChannelChoice& hall, const BoardLink& board, const Rig& rig, Wiring& wiring) {
    const MicroParameters& micro = rig.micro.value();
    const double ends_V[] = {hall_voltage_V(micro.hall, micro.low_mm),
                             hall_voltage_V(micro.hall, micro.high_mm)};
    const Check input("hall", hall, board);
    input.demand({SubdeviceKind::analogue_in});
    wiring.hall = input.in_volts({std::min(ends_V[0], ends_V[1]), std::max(ends_V[0], ends_V[1])},
                                 "the Hall sensor over the travel");
    wiring.hall_lsb_V = hall_lsb_V(micro.hall);
}

void wire_encoder(const EncoderChannel& encoder, const BoardLink& board, const Rig& rig, Wiring& wiring) {
    const Check input("encoder", encoder.input, board);
    wiring.encoder_reversed = encoder.reversed;
    if (!encoder.mm_per_V) {
        input.demand({SubdeviceKind::counter});
        wiring.encoder = input.plain();
        return;
    }
    input.demand({SubdeviceKind::analogue_in});
    const double travel_V = (rig.macro.high_mm - rig.macro.low_mm) / *encoder.mm_per_V;
    wiring.encoder = input.in_volts({0.0, 0.0}, "a position");
    if (width_V(wiring.encoder.range) < travel_V - slack_V)
        input.fail("mm_per_V", fmt::format("{:g}", *encoder.mm_per_V),
                   fmt::format("the travel takes {:g} V, and the board's range {} V", travel_V,
                               text_of(wiring.encoder.range)));
    const double step_mm = *encoder.mm_per_V * width_V(wiring.encoder.range) / wiring.encoder.max_value;
    if (step_mm > rig.macro.encoder_resolution_mm)
        input.fail("mm_per_V", fmt::format("{:g}", *encoder.mm_per_V),
                   fmt::format("a step of the board's is {:.3g} mm; must not be above "
                               "macro.encoder_resolution_mm, {:g} mm",
                               step_mm, rig.macro.encoder_resolution_mm));
    wiring.counts_per_V = *encoder.mm_per_V / rig.macro.encoder_resolution_mm;
}

}  // namespace

std::string_view name_of(SubdeviceKind kind) {
    switch (kind) {
        case SubdeviceKind::none:
            return "not there";
        case SubdeviceKind::analogue_in:
            return "an analogue input";
        case SubdeviceKind::analogue_out:
            return "an analogue output";
        case SubdeviceKind::digital_in:
            return "a digital input";
        case SubdeviceKind::digital_out:
            return "a digital output";
        case SubdeviceKind::digital_io:
            return "digital lines";
        case SubdeviceKind::counter:
            return "a counter";
        case SubdeviceKind::other:
            return "something else";
    }
    return "";
}

std::uint32_t number_of(const Terminal& terminal, double volts) {
    const double share = (volts - terminal.range.low_V) / width_V(terminal.range);
    return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * terminal.max_value));
}

double volts_of(const Terminal& terminal, std::uint32_t number) {
    return terminal.range.low_V + width_V(terminal.range) * number / terminal.max_value;
}

Wiring wire(const ChannelMap& map, const BoardLink& board, const Rig& rig) {
    Wiring wiring;
    wire_macro(map.macro, board, rig, wiring);
    const Check micro("micro", map.micro, board);
    micro.demand({SubdeviceKind::analogue_out});
    wiring.micro = micro.in_volts({0.0, rig.micro.value().heater.limit_V}, "micro.heater.limit_V");
    if (map.micro.subdevice == map.macro.output.subdevice && map.micro.channel == map.macro.output.channel)
        micro.fail("channel", fmt::format("{}", map.micro.channel), "is the macro stage's as well");
    wire_hall(map.hall, board, rig, wiring);
    wire_encoder(map.encoder, board, rig, wiring);
    return wiring;
}

}  // namespace fidservo::control::comedi

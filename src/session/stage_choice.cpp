// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/stage_choice.h"

#include "control/comedi/comedi_board.h"
#include "control/comedi/libcomedi_link.h"
#include "control/watchdog.h"
#include "core/input_error.h"
#include "src/files/rig/stage_keys.h"

#include <cmath>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

namespace comedi = control::comedi;

constexpr std::string_view comedi_prefix = "comedi:";

std::filesystem::path node_of(const SessionOptions& options) {
    const auto refuse = [&](std::string_view why) {
        throw InputError(
            fmt::format("--stage {}: {}; allowed: sim, comedi:/dev/comedi0", options.stage, why));
    };
    if (!options.stage.starts_with(comedi_prefix)) refuse("no such stage");
    const std::filesystem::path node = options.stage.substr(comedi_prefix.size());
    std::error_code error;
    if (!std::filesystem::is_character_file(node, error)) refuse("no such device");
    return node;
}

}  // namespace

bool stage_is_simulated(const SessionOptions& options) {
    return options.stage == "sim";
}

struct ComediChoice::Impl {
    std::filesystem::path node;
    comedi::Wiring wiring;
    control::WatchdogParams watchdog;
};

ComediChoice::ComediChoice(const SessionOptions& options, const Rig& rig) : impl_(std::make_unique<Impl>()) {
    const std::string file = options.rig_file.string();
    const StageKeys keys = load_stage_keys(options.rig_file);
    impl_->node = node_of(options);
    if (!keys.comedi)
        throw InputError(
            fmt::format("{}: stage.comedi: missing; --stage {} needs to know what the stage's "
                        "channels are: macro, micro, hall, encoder",
                        file, options.stage));
    const auto board = comedi::open_board(impl_->node);
    try {
        impl_->wiring = comedi::wire(*keys.comedi, *board, rig);
    } catch (const InputError& wrong) {
        throw InputError(fmt::format("{}: {}", file, wrong.what()));
    }
    impl_->watchdog = watchdog_params(rig, keys.watchdog);
    spdlog::info("{}: {}", impl_->node.string(), board->name());
}

ComediChoice::~ComediChoice() = default;

control::BoardFactory ComediChoice::outputs() const {
    return [node = impl_->node, wiring = impl_->wiring] {
        return std::make_unique<comedi::ComediOutputs>(comedi::open_board(node), wiring);
    };
}

std::chrono::milliseconds ComediChoice::patience() const {
    return std::chrono::milliseconds(std::lround(1e3 * impl_->watchdog.late_ticks * impl_->watchdog.tick_s));
}

std::shared_ptr<control::Stage> ComediChoice::stage(std::shared_ptr<control::Guardian> guardian) const {
    return std::make_shared<comedi::ComediStage>(comedi::open_board(impl_->node), impl_->wiring,
                                                 std::move(guardian));
}

const control::WatchdogParams& ComediChoice::watchdog() const {
    return impl_->watchdog;
}

}  // namespace fidservo

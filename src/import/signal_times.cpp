// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/signal_times.h"

#include "core/input_error.h"
#include "src/files/text/key_names.h"
#include "src/import/clock_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::imports {
namespace {

void demand_rising(const std::vector<TimeNs>& times, const Log& log, const std::string& signal,
                   bool may_repeat) {
    for (std::size_t k = 1; k < times.size(); ++k)
        if (times[k] < times[k - 1] || (!may_repeat && times[k] == times[k - 1]))
            throw InputError(fmt::format("{}: {}: its times do not rise: {} ns at sample {}, then {} ns",
                                         log.file.string(), signal, times[k - 1], k, times[k]));
}

/// Samples without a number are left out.
MotionTrack track_of(const std::vector<TimeNs>& times, const std::vector<double>& values, TimeNs origin_ns) {
    MotionTrack track;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!std::isfinite(values[k])) continue;
        track.time_s.push_back(seconds(times[k] - origin_ns));
        track.value.push_back(values[k]);
    }
    return track;
}

}  // namespace

SignalSource::SignalSource(const std::vector<Log>& logs, const ImportMap& map) : logs_(&logs), map_(&map) {
    for (const ClockChoice& clock : map.clocks) shifts_.push_back({clock.offset_s, clock.rate_ppm, {}});
    for (std::size_t k = 0; k < map.clocks.size(); ++k)
        if (map.clocks[k].fit)
            fit(k);
        else if (map.clocks[k].rate_ppm != 0.0)
            find_first_time(k);
}

const ClockChoice* SignalSource::clock_of(const std::string& name) const {
    return name.empty() && !map_->clocks.empty() ? &map_->clocks.front() : map_->clock(name);
}

void SignalSource::find_first_time(std::size_t k) {
    const ClockChoice& clock = map_->clocks[k];
    std::optional<TimeNs>& first_ns = shifts_[k].first_ns;
    const auto consider = [&](const std::vector<TimeNs>& times) {
        if (!times.empty()) first_ns = std::min(first_ns.value_or(times.front()), times.front());
    };
    for (const auto* choices : {&map_->columns, &map_->detections})
        for (const auto& [name, choice] : *choices)
            if (clock_of(choice.clock) == &clock)
                consider(raw_times(find(choice.signal, *choice.where), &clock, *choice.where));
    if (!map_->camera || clock_of(map_->camera->clock) != &clock) return;
    for (const Log& log : *logs_)
        for (const LoggedCamera& camera : log.cameras)
            if (camera.name == map_->camera->images) consider(camera.times_ns);
}

SignalSource::Found SignalSource::find(const std::string& name, const YamlValue& where) const {
    std::vector<Found> found;
    std::vector<std::string> names;
    for (const Log& log : *logs_) {
        const std::string path = log.file.string(), file = log.file.filename().string(),
                          stem = log.file.stem().string();
        for (const LoggedSignal& signal : log.signals) {
            names.push_back(signal.name);
            if (signal.name == name || path + ":" + signal.name == name || file + ":" + signal.name == name ||
                stem + ":" + signal.name == name)
                found.push_back({&log, &signal});
        }
    }
    if (found.empty()) {
        std::vector<std::string_view> numbered;
        std::ranges::copy_if(names, std::back_inserter(numbered),
                             [&](const std::string& one) { return one.starts_with(name + "#"); });
        if (!numbered.empty())
            where.fail(fmt::format("{}: {} columns have this title; say which: {}", name, numbered.size(),
                                   fmt::join(numbered, ", ")));
        const std::string_view meant = nearest_word(name, {names.begin(), names.end()});
        where.fail(fmt::format("{}: there is no such signal{}; fidservo import FILE without --map lists them",
                               name, meant.empty() ? "" : fmt::format(", did you mean {}?", meant)));
    }
    if (found.size() > 1) {
        const std::filesystem::path &one = found[0].log->file, &other = found[1].log->file;
        const bool tells = one.filename() != other.filename();
        where.fail(fmt::format("{}: is in {} and in {}; say which, as {}:{}", name,
                               (tells ? one.filename() : one).string(),
                               (tells ? other.filename() : other).string(),
                               (tells ? one.filename() : one).string(), found[0].signal->name));
    }
    if (!found.front().signal->fault.empty())
        throw InputError(
            fmt::format("{}: {}: {}", found.front().log->file.string(), name, found.front().signal->fault));
    return found.front();
}

std::vector<TimeNs> SignalSource::raw_times(const Found& found, const ClockChoice* clock,
                                            const YamlValue& where) const {
    const LoggedSignal& signal = *found.signal;
    if (clock != nullptr && clock->rate_hz) {
        if (!signal.times.empty())
            clock->times.where->fail(fmt::format(
                "rate_hz: {}: {} of {} has times of its own, {}: rate_hz is for signals that have none",
                *clock->rate_hz, signal.name, found.log->file.string(), signal.times));
        std::vector<TimeNs> times(signal.values.size());
        for (std::size_t k = 0; k < times.size(); ++k)
            times[k] = nanoseconds(static_cast<double>(k) / *clock->rate_hz);
        return times;
    }
    const bool is_stated = clock != nullptr && !clock->times.signal.empty();
    if (!is_stated && signal.times.empty())
        where.fail(fmt::format(
            "{}: {} does not tell its times; give time: SIGNAL [UNIT], or time: {{ rate_hz: HZ }}",
            signal.name, found.log->file.string()));
    const YamlValue& at = is_stated ? *clock->times.where : where;
    const Found times =
        is_stated ? find(clock->times.signal, at) : Found{found.log, found.log->find(signal.times)};
    if (times.signal == nullptr) where.fail(fmt::format("{}: its times are missing", signal.name));
    if (times.signal->values.size() != signal.values.size())
        at.fail(fmt::format("{} has {} values, but {} has {} times", signal.name, signal.values.size(),
                            times.signal->name, times.signal->values.size()));
    return times_of(*times.signal, *times.log, is_stated ? clock->times.unit : std::string(), at);
}

std::vector<TimeNs> SignalSource::on_recording_clock(std::vector<TimeNs> times, const std::string& name) {
    const ClockChoice* clock = clock_of(name);
    if (clock == nullptr || times.empty()) return times;
    ClockShift& shift = shifts_[static_cast<std::size_t>(clock - map_->clocks.data())];
    const TimeNs offset_ns = nanoseconds(shift.offset_s);
    for (TimeNs& time : times) {
        const auto drift_ns =
            std::llround(static_cast<double>(time - shift.first_ns.value_or(time)) * shift.rate_ppm * 1e-6);
        time += offset_ns + drift_ns;
    }
    return times;
}

TimedSignal SignalSource::timed(const SignalChoice& choice, std::string_view target_unit, bool may_repeat) {
    const Found found = find(choice.signal, *choice.where);
    if (found.signal->values.empty())
        throw InputError(fmt::format("{}: {}: is empty", found.log->file.string(), choice.signal));
    const ClockChoice* clock = clock_of(choice.clock);
    std::vector<TimeNs> times = raw_times(found, clock, *choice.where);
    demand_rising(times, *found.log, choice.signal, may_repeat);
    return {found.signal, found.log, on_recording_clock(std::move(times), choice.clock),
            converted(*found.signal, *found.log, choice, target_unit)};
}

void SignalSource::fit(std::size_t k) {
    const ClockChoice& clock = map_->clocks[k];
    const Found mine = find(clock.fit->signal, *clock.where), other = find(clock.fit->to, *clock.where);
    const std::vector<TimeNs> times = raw_times(mine, &clock, *clock.where);
    const std::vector<TimeNs> to = raw_times(other, map_->clocks.data(), *clock.where);
    demand_rising(times, *mine.log, mine.signal->name, false);
    demand_rising(to, *other.log, other.signal->name, false);
    if (times.empty() || to.empty()) clock.where->fail("fit: one of the two signals is empty");
    const auto fitted = fit_clock(track_of(times, mine.signal->values, times.front()),
                                  track_of(to, other.signal->values, to.front()));
    if (!fitted)
        clock.where->fail(fmt::format("fit: {} to {}: {}", clock.fit->signal, clock.fit->to, fitted.error()));
    // Each track counts from its own first time, so that seconds since 1970 lose no digits.
    const double between_s = seconds(to.front() - times.front());
    shifts_[k] = {between_s + fitted->offset_s, fitted->rate_ppm, times.front()};
    notes_.push_back(fmt::format(
        "clock {}: fitted by {} to {}: offset {:.6f} s (std {:.6f} s) at its first time, rate {:+.2f} ppm "
        "(std {:.2f}), correlation {:.4f}",
        clock.name, clock.fit->signal, clock.fit->to, shifts_[k].offset_s, fitted->offset_std_s,
        fitted->rate_ppm, fitted->rate_std_ppm, fitted->correlation));
}

}  // namespace fidservo::imports

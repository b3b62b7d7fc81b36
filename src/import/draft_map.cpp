// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/draft_map.h"

#include "src/identify/column_units.h"
#include "src/import/import_map.h"
#include "src/import/resample.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::imports {
namespace {

constexpr std::size_t most_listed = 200;

/// Words in a signal's name by which a column may be meant; the first column whose word is there is taken.
struct Hint {
    std::string_view column, unit;
    std::array<std::string_view, 6> words;
};
constexpr std::array hints{
    Hint{"macro_setpoint", "mm", {"setpoint", "reference", "ref", "desired", "target", "qg"}},
    Hint{"macro_command", "V", {"command", "cmd", "voltage", "drive", "vir", "u"}},
    Hint{"hall", "adc", {"hall", "adc", "", "", "", ""}},
    Hint{"encoder", "count", {"encoder", "enc", "counts", "ticks", "", ""}},
    Hint{"position", "mm", {"position", "pos", "qm", "displacement", "x", "y"}}};

constexpr std::array<std::string_view, 8> time_words{"time",    "timestamp", "t",     "tout",
                                                     "seconds", "clock",     "stamp", "received"};

/// The letters of a name between those that are none, in small letters.
std::set<std::string> words_of(std::string_view name) {
    std::set<std::string> words;
    std::string word;
    for (const char letter : name) {
        if (std::isalpha(static_cast<unsigned char>(letter)) != 0)
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        else if (!word.empty())
            words.insert(std::exchange(word, {}));
    }
    if (!word.empty()) words.insert(word);
    return words;
}

bool is_time(const LoggedSignal& signal) {
    const Unit* unit = find_unit(signal.unit);
    if (unit != nullptr && unit->quantity != "time") return false;
    const std::set<std::string> words = words_of(signal.name);
    return std::ranges::any_of(time_words,
                               [&](std::string_view word) { return words.contains(std::string(word)); });
}

bool rises(const std::vector<double>& values) {
    return values.size() > 1 && std::ranges::adjacent_find(values, std::greater_equal<>()) == values.end();
}

/// In quotes where YAML would read it as something else.
std::string quoted(const std::string& name) {
    const bool is_plain = std::ranges::all_of(name, [](char letter) {
        return std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
               std::string_view("_./").find(letter) != std::string_view::npos;
    });
    if (is_plain && !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0) return name;
    std::string text = "'";
    for (const char letter : name) text += letter == '\'' ? std::string("''") : std::string(1, letter);
    return text + "'";
}

std::string on_one_line(std::string text) {
    for (char& letter : text)
        if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
    return text;
}

/// Samples a second, where the times are known.
std::string rate_of(const Log& log, const LoggedSignal& signal) {
    const LoggedSignal* times = signal.times.empty() ? nullptr : log.find(signal.times);
    const Unit* unit = times == nullptr ? nullptr : find_unit(times->unit);
    if (unit == nullptr || times->values.size() < 2) return "-";
    const double span = (times->values.back() - times->values.front()) * unit->size;
    return span > 0.0 ? fmt::format("{:.6g}", static_cast<double>(times->values.size() - 1) / span) : "-";
}

std::string range_of(const LoggedSignal& signal) {
    double low = INFINITY, high = -INFINITY;
    for (const double value : signal.values) {
        if (std::isnan(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    return low > high ? std::string("-") : fmt::format("{:.6g} .. {:.6g}", low, high);
}

void list_signals(const Log& log, std::string& text) {
    text += fmt::format("# {}\n", on_one_line(log.file.string()));
    for (const std::string& note : log.notes) text += fmt::format("#   {}\n", on_one_line(note));
    std::size_t width = 10;
    for (const LoggedSignal& signal : log.signals)
        width = std::max(width, std::min<std::size_t>(40, signal.name.size()));
    if (!log.signals.empty())
        text += fmt::format("#   {:<{}}  {:>9}  {:>10}  {:<8}  range\n", "signal", width, "count",
                            "rate [Hz]", "unit");
    for (std::size_t k = 0; k < std::min(most_listed, log.signals.size()); ++k) {
        const LoggedSignal& signal = log.signals[k];
        text += fmt::format("#   {:<{}}  {:>9}  {:>10}  {:<8}  {}\n", on_one_line(signal.name), width,
                            signal.values.size(), rate_of(log, signal),
                            signal.unit.empty() ? "-" : on_one_line(signal.unit),
                            signal.fault.empty() ? range_of(signal) : on_one_line(signal.fault));
    }
    if (log.signals.size() > most_listed)
        text += fmt::format("#   and {} more\n", log.signals.size() - most_listed);
    for (const LoggedCamera& camera : log.cameras)
        text += fmt::format("#   camera {}: {} frames\n", on_one_line(camera.name), camera.times_ns.size());
}

struct Guess {
    const LoggedSignal* time = nullptr;
    std::size_t rows = 0;  ///< of the signals that share the time
    std::vector<std::pair<const Hint*, const LoggedSignal*>> columns;
};

/// A recording has one of the columns that do.
bool says_where(const Hint& hint) {
    return hint.column == "encoder" || hint.column == "position";
}

Guess guess(const std::vector<Log>& logs) {
    Guess made;
    for (const Log& log : logs)
        for (const LoggedSignal& signal : log.signals) {
            const bool is_clock = is_time(signal) && rises(signal.values);
            if (is_clock && made.time == nullptr) made.time = &signal;
            if (is_clock || signal.values.size() < 2) continue;
            const std::set<std::string> words = words_of(signal.name);
            for (const Hint& hint : hints) {
                const bool is_meant = std::ranges::any_of(hint.words, [&](std::string_view word) {
                    return !word.empty() && words.contains(std::string(word));
                });
                const bool is_taken = std::ranges::any_of(made.columns, [&](const auto& pair) {
                    return pair.first == &hint || (says_where(hint) && says_where(*pair.first));
                });
                if (!is_meant) continue;
                if (!is_taken) made.columns.emplace_back(&hint, &signal);
                break;
            }
        }
    return made;
}

}  // namespace

std::string draft_map(const std::vector<Log>& logs) {
    std::string text;
    for (const Log& log : logs) list_signals(log, text);
    const Guess made = guess(logs);
    text += fmt::format("format: {}\n", map_format);
    const std::string name = logs.front().file.stem().string();
    text += fmt::format(
        "recording: {{ name: {}, rig: my-rig, experiment: {} }}  # SAY: rig is the name in the rig file\n",
        quoted(name), quoted(name));
    const bool have_own = !made.columns.empty() && !made.columns.front().second->times.empty();
    if (!have_own && made.time != nullptr)
        text += fmt::format("time: {{ signal: {}, unit: {} }}  # GUESS\n", quoted(made.time->name),
                            made.time->unit.empty() ? "s" : quoted(made.time->unit));
    if (!have_own && made.time == nullptr)
        text += "time: { rate_hz: 1000 }  # SAY: samples a second, or signal and unit\n";
    if (made.columns.empty()) {
        text +=
            "columns:  # SAY: which signal is which; also macro_setpoint, encoder, micro_setpoint, "
            "micro_command, hall\n"
            "#  macro_command: { signal: NAME, unit: V }\n#  position: { signal: NAME, unit: mm }\n";
    } else {
        text +=
            "columns:  # also macro_setpoint, macro_command, encoder, position, micro_setpoint, "
            "micro_command, hall\n";
        for (const auto& [hint, signal] : made.columns)
            text +=
                fmt::format("  {}: {{ signal: {}, unit: {} }}  # GUESS\n", hint->column, quoted(signal->name),
                            signal->unit.empty() ? std::string(hint->unit) : quoted(signal->unit));
    }
    for (const Log& log : logs)
        if (!log.cameras.empty()) {
            text += fmt::format("camera: {{ images: {}", quoted(log.cameras.front().name));
            for (const auto& [topic, info] : log.texts)
                if (info.starts_with("# CameraInfo")) {
                    text += fmt::format(", info: {}", quoted(topic));
                    break;
                }
            text += " }\n";
            break;
        }
    return text;
}

}  // namespace fidservo::imports

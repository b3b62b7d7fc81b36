// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The signals of the logs that a map names, converted to the recording's units and clock.
#include "src/import/import_map.h"
#include "src/import/log.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::imports {

/// A signal on the recording's clock.
struct TimedSignal {
    const LoggedSignal* signal = nullptr;
    const Log* log = nullptr;
    std::vector<TimeNs> time_ns;  ///< rising
    std::vector<double> values;
};

/// The conversion of a clock's times t, s, to the recording's clock: t + offset + rate 1e-6 (t - first).
struct ClockShift {
    double offset_s = 0.0, rate_ppm = 0.0;
    std::optional<TimeNs> first_ns;  ///< earliest time among the map's signals on this clock
};

/// Gives the signals of the logs of one run, by the map.
class SignalSource {
  public:
    /// Fits the clocks for which the map asks; notes() tells the results. Throws InputError.
    SignalSource(const std::vector<Log>& logs, const ImportMap& map);

    /// @param target_unit  the recording's; empty: values are not converted
    /// @param may_repeat  whether a time may occur more than once
    /// @throws InputError with the map's line, or with the file and the row
    TimedSignal timed(const SignalChoice& choice, std::string_view target_unit, bool may_repeat = false);
    /// Transforms times of a clock to the recording's.
    std::vector<TimeNs> on_recording_clock(std::vector<TimeNs> time_ns, const std::string& clock);
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    struct Found {
        const Log* log;
        const LoggedSignal* signal;
    };
    Found find(const std::string& name, const YamlValue& where) const;
    std::vector<TimeNs> raw_times(const Found& found, const ClockChoice* clock, const YamlValue& where) const;
    /// The map's clock with this name; nullptr if the signal has its own times, or none.
    const ClockChoice* clock_of(const std::string& name) const;
    void fit(std::size_t clock);
    void find_first_time(std::size_t clock);

    const std::vector<Log>* logs_;
    const ImportMap* map_;
    std::vector<ClockShift> shifts_;
    std::vector<std::string> notes_;
};

/// Values converted to another unit, from the unit that the map or the file states. Throws InputError at
/// `choice.where`.
std::vector<double> converted(const LoggedSignal& signal, const Log& log, const SignalChoice& choice,
                              std::string_view target_unit);

/// Times in ns. Throws InputError: not finite, or out of range.
std::vector<TimeNs> times_of(const LoggedSignal& signal, const Log& log, const std::string& asked_unit,
                             const YamlValue& where);

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Signals of logs as the map asks for them: found, in the recording's unit, with times on its clock.
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

/// What a clock's times are moved by: t + offset + rate 1e-6 (t - first).
struct ClockShift {
    double offset_s = 0.0, rate_ppm = 0.0;
    std::optional<TimeNs> first_ns;  ///< of its first signal that was asked for
};

/// The logs of one run and what the map says of them.
class SignalSource {
  public:
    /// Fits the clocks that are to be fitted, which is said in notes(). Throws InputError.
    SignalSource(const std::vector<Log>& logs, const ImportMap& map);

    /// @param target_unit  the recording's; empty: the values as they are
    /// @param may_repeat  whether one time may be there more than once
    /// Throws InputError that names the map's line, or the file and the row.
    TimedSignal timed(const SignalChoice& choice, std::string_view target_unit, bool may_repeat = false);
    /// Moves times from a clock to the recording's.
    std::vector<TimeNs> on_recording_clock(std::vector<TimeNs> time_ns, const std::string& clock);
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    struct Found {
        const Log* log;
        const LoggedSignal* signal;
    };
    Found find(const std::string& name, const YamlValue& where) const;
    std::vector<TimeNs> raw_times(const Found& found, const ClockChoice* clock, const YamlValue& where) const;
    void fit(std::size_t clock);

    const std::vector<Log>* logs_;
    const ImportMap* map_;
    std::vector<ClockShift> shifts_;
    std::vector<std::string> notes_;
};

/// Values in another unit, by the units that the map and the file state. Throws InputError at `choice.where`.
std::vector<double> converted(const LoggedSignal& signal, const Log& log, const SignalChoice& choice,
                              std::string_view target_unit);

/// Times in ns. Throws InputError: not finite, or out of range.
std::vector<TimeNs> times_of(const LoggedSignal& signal, const Log& log, const std::string& asked_unit,
                             const YamlValue& where);

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The content of another program's data file in any format: signals, cameras, texts.
#include "core/time.h"
#include "vision/images/image_file.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace fidservo::imports {

/// The largest number of values that is read from one file (2 GiB).
inline constexpr std::uint64_t most_values = std::uint64_t{1} << 28U;
inline constexpr std::size_t most_signals = 10'000;
/// The largest number of columns of an array whose columns become signals.
inline constexpr std::size_t most_columns = 1'000;

struct LoggedSignal {
    std::string name{};                 ///< "u", "out.time", "/joint_states/position[axis]"
    std::string unit{};                 ///< as the file states it; empty: not stated
    std::vector<double> values{};       ///< NaN where a value is missing
    std::vector<std::int64_t> whole{};  ///< the same values exactly, if the file has 64-bit integers
    std::string times{};                ///< name of the signal with its times, if the file states it
    int decimals = -1;                  ///< decimals that all its numbers have; -1: unknown
    std::string fault{};                ///< why it cannot be used; it then has no values
};

/// A frame: a grey image of 8 or 16 bits, or the encoded image's bytes as in the log.
struct LoggedFrame {
    vision::StoredImage image{};
    std::string bytes{};
    std::string ending{};  ///< file ending for the bytes' format: ".png", ".jpg"
};

struct LoggedCamera {
    std::string name{};
    std::vector<TimeNs> times_ns{};  ///< rising
    std::function<tl::expected<LoggedFrame, std::string>(std::size_t)> frame{};
    bool is_deep = false;  ///< its frames may have 16 bits: full scale is decided for all of them together
    std::string info{};    ///< intrinsics as the text of a camera_info file; empty: none
};

struct Log {
    std::filesystem::path file{};
    std::vector<LoggedSignal> signals{};
    std::vector<LoggedCamera> cameras{};
    std::map<std::string, std::string> texts{};
    std::vector<std::string> notes{};  ///< sentences for the user

    const LoggedSignal* find(const std::string& signal) const;
};

/// The result of a reader; the error is a sentence without the file's name.
using LogOrFault = tl::expected<Log, std::string>;

/// The names under which exports carry the map and the plate file.
inline constexpr const char* map_text = "fidservo_map";
inline constexpr const char* plate_text = "fidservo_plate";

/// The message for an array of `count` numbers that is skipped, because the file would exceed most_values.
std::string too_many_numbers(std::uint64_t count);

/// The text with control characters, which move a terminal's cursor or break a line, written as \x1B.
std::string with_visible_controls(std::string_view text);

/// The unit that a name ends in, as a table's title does (title_parts()); a number in brackets is an index.
std::string unit_of_name(std::string_view name);

/// Removes units in brackets from the ends of signals' names, as the reader of tables does: "/log/x [mm]"
/// becomes "/log/x", and "/log/x [mm][2]" becomes "/log/x[2]". Signals whose names would become equal keep
/// them, and so do signals with a fault.
void take_units_off_names(Log& log);

/// Adds the columns of an array as signals NAME[1], NAME[2], ..; a single column as NAME.
/// @param like  name and other properties of the signals
/// @param append  appends the value of a row and column to a signal
void add_columns(Log& log, const LoggedSignal& like, std::size_t rows, std::size_t columns,
                 const std::function<void(LoggedSignal&, std::size_t row, std::size_t column)>& append);

}  // namespace fidservo::imports

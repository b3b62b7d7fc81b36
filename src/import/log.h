// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What another program's file of measurements holds, whatever its format: signals, cameras, texts.
#include "core/time.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <tl/expected.hpp>

namespace fidservo::imports {

/// Most numbers that are read from one file: 2 GiB of them.
inline constexpr std::uint64_t most_values = std::uint64_t{1} << 28U;
inline constexpr std::size_t most_signals = 10'000;
/// Columns of one array that are taken as signals.
inline constexpr std::size_t most_columns = 1'000;

struct LoggedSignal {
    std::string name{};                 ///< "u", "out.time", "/joint_states/position[axis]"
    std::string unit{};                 ///< as the file states it; empty: it does not
    std::vector<double> values{};       ///< NaN where the file has none
    std::vector<std::int64_t> whole{};  ///< the same, exactly, where the file has integers of 64 bits
    std::string times{};                ///< the signal with its times, where the file tells
    int decimals = -1;                  ///< digits behind the point that all its numbers have; -1: not known
    std::string fault{};                ///< why it cannot be used; there are no values then
};

/// A frame: a grey image, or the bytes of an image file as the log has them.
struct LoggedFrame {
    cv::Mat grey{};
    std::string bytes{};
    std::string ending{};  ///< of the bytes' format: ".png", ".jpg"
};

struct LoggedCamera {
    std::string name{};
    std::vector<TimeNs> times_ns{};  ///< rising
    std::function<tl::expected<LoggedFrame, std::string>(std::size_t)> frame{};
    std::string info{};  ///< its intrinsics as the text of a camera_info file; empty: none
};

struct Log {
    std::filesystem::path file{};
    std::vector<LoggedSignal> signals{};
    std::vector<LoggedCamera> cameras{};
    std::map<std::string, std::string> texts{};
    std::vector<std::string> notes{};  ///< sentences for the user

    const LoggedSignal* find(const std::string& signal) const;
};

/// What a reader answers; the error is a sentence without the file's name.
using LogOrFault = tl::expected<Log, std::string>;

/// How exports name the map and the plate file that they carry.
inline constexpr const char* map_text = "fidservo_map";
inline constexpr const char* plate_text = "fidservo_plate";

/// Adds the columns of an array as signals NAME[1], NAME[2], ..; of one column as NAME.
/// @param at  the value of row i in column k
void add_columns(Log& log, const LoggedSignal& like, std::size_t rows, std::size_t columns,
                 const std::function<void(LoggedSignal&, std::size_t row, std::size_t column)>& append);

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Logs as other programs write them, made with the formats' own libraries.
#include "core/recording.h"
#include "src/files/recording/layout.h"
#include "src/files/table/table_structure.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace fidservo::imports::testing {

/// How read_log() reads a table where a map says nothing of it.
inline const TableOptions no_table_options{.are_offered = false};

/// A signal of a log, or a topic of a bag.
struct MadeSignal {
    std::string name;
    std::vector<double> values;
    std::string unit = {};  ///< as an attribute, if the format has them
};

/// The columns that a recording has, by name.
inline std::vector<MadeSignal> signals_of(const Recording& recording) {
    std::vector<MadeSignal> signals;
    for (const StageColumn& column : stage_columns) {
        if (!(recording.columns.*column.present)) continue;
        MadeSignal signal{std::string(column.title.substr(0, column.title.find(" ["))), {}};
        for (const StageRow& row : recording.rows) signal.values.push_back(row.*column.value);
        signals.push_back(std::move(signal));
    }
    return signals;
}

inline std::vector<double> seconds_of(const Recording& recording) {
    std::vector<double> time_s;
    for (const StageRow& row : recording.rows) time_s.push_back(seconds(row.time_ns));
    return time_s;
}

enum class MatFormat { five, seven_three };

/// Simulink's structure with time, named `out`: time, and signals with values and label.
void make_simulink_mat(const std::filesystem::path& file, MatFormat format, std::vector<double> time_s,
                       std::vector<MadeSignal> signals);
/// Variables of one column each.
void make_plain_mat(const std::filesystem::path& file, MatFormat format, std::vector<MadeSignal> signals);
/// The bytes of a file of format 5 with one opaque object, as MATLAB writes them.
std::string opaque_mat(const std::string& variable, const std::string& matlab_class);

/// A dataset for each signal, with its unit.
void make_hdf5(const std::filesystem::path& file, const std::vector<MadeSignal>& signals);
/// A table of one compound type, as h5py and PyTables write structured arrays.
void make_hdf5_table(const std::filesystem::path& file, const std::string& name,
                     const std::vector<MadeSignal>& columns);

/// Bytes in CDR, little-endian.
class CdrBytes {
  public:
    CdrBytes() : bytes_("\0\1\0\0", 4) {}
    CdrBytes& header(std::int64_t stamp_ns);
    CdrBytes& text(const std::string& value);
    CdrBytes& octets(const std::string& value);
    CdrBytes& doubles(const std::vector<double>& values);
    template <class Number>
    CdrBytes& number(Number value) {
        while ((bytes_.size() - 4) % sizeof value != 0) bytes_ += '\0';
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

struct BagTopic {
    std::string name, type;
    std::vector<std::pair<std::int64_t, std::string>> messages;  ///< time of reception, bytes
    std::string serialization = "cdr";
};
void make_bag(const std::filesystem::path& file, const std::vector<BagTopic>& topics);

/// sensor_msgs/JointState of joints with one position each.
std::string joint_state(std::int64_t stamp_ns, const std::vector<std::string>& joints,
                        const std::vector<double>& positions);
std::string float64(double value);
std::string mono8_image(std::int64_t stamp_ns, std::uint32_t width, std::uint32_t height,
                        const std::string& pixels, const std::string& encoding = "mono8");

}  // namespace fidservo::imports::testing

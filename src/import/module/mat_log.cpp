// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/mat_log.h"

#include "src/import/module/mat73_variables.h"
#include "src/import/module/mat_objects.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <hdf5.h>
#include <matio.h>

namespace fidservo::imports {
namespace {

constexpr int most_depth = 16;

struct CloseMat {
    void operator()(mat_t* mat) const { Mat_Close(mat); }
};
/// The number of elements, or nothing if it is more than are read.
std::optional<std::uint64_t> elements_of(const matvar_t& variable) {
    std::uint64_t count = variable.rank > 0 && variable.dims != nullptr ? 1 : 0;
    for (int k = 0; k < variable.rank && variable.dims != nullptr; ++k) {
        if (variable.dims[k] != 0 && count > most_values / variable.dims[k]) return std::nullopt;
        count *= variable.dims[k];
    }
    return count;
}

template <class Number>
void append_number(LoggedSignal& signal, const matvar_t& variable, std::size_t at) {
    const Number value = static_cast<const Number*>(variable.data)[at];
    signal.values.push_back(static_cast<double>(value));
    if constexpr (sizeof(Number) == sizeof(std::int64_t) && std::is_integral_v<Number>)
        if (value <= static_cast<Number>(std::numeric_limits<std::int64_t>::max()))
            signal.whole.push_back(static_cast<std::int64_t>(value));
}

using Append = void (*)(LoggedSignal&, const matvar_t&, std::size_t);

/// By the class; nullptr for what is no array of real numbers.
Append append_of(const matvar_t& variable) {
    switch (variable.class_type) {
        case MAT_C_DOUBLE:
            return append_number<double>;
        case MAT_C_SINGLE:
            return append_number<float>;
        case MAT_C_INT8:
            return append_number<std::int8_t>;
        case MAT_C_UINT8:
            return append_number<std::uint8_t>;
        case MAT_C_INT16:
            return append_number<std::int16_t>;
        case MAT_C_UINT16:
            return append_number<std::uint16_t>;
        case MAT_C_INT32:
            return append_number<std::int32_t>;
        case MAT_C_UINT32:
            return append_number<std::uint32_t>;
        case MAT_C_INT64:
            return append_number<std::int64_t>;
        case MAT_C_UINT64:
            return append_number<std::uint64_t>;
        default:
            return nullptr;
    }
}

class MatReader {
  public:
    explicit MatReader(Log& log) : log_(&log) {}

    void add(const matvar_t* variable, const std::string& name, const std::string& times, int depth) {
        if (variable == nullptr || is_full_) return;
        is_full_ = log_->signals.size() >= most_signals;
        if (is_full_)
            log_->notes.push_back(fmt::format(
                "{} and what follows it are passed over: more than {} signals are not read from one file",
                name, most_signals));
        else if (depth > most_depth)
            log_->signals.push_back(
                {.name = name,
                 .fault =
                     fmt::format("is passed over: it is in more than {} structures and cells", most_depth)});
        else if (append_of(*variable) != nullptr)
            add_array(*variable, name, times);
        else if (variable->class_type == MAT_C_STRUCT)
            add_struct(*variable, name, times, depth);
        else if (variable->class_type == MAT_C_CELL)
            add_cells(*variable, name, depth);
        else if (variable->class_type == MAT_C_CHAR)
            add_text(*variable, name);
        else if (variable->class_type == MAT_C_EMPTY && depth == 0)
            log_->signals.push_back({.name = name, .fault = "is of no class that is known, or is damaged"});
        else if (variable->class_type != MAT_C_EMPTY)
            log_->signals.push_back({.name = name, .fault = advice_on_object(name, class_name(*variable))});
    }

    std::uint64_t values() const { return values_; }

  private:
    static std::string class_name(const matvar_t& variable) {
        if (variable.class_type == MAT_C_FUNCTION) return "function_handle";
        return variable.class_type == MAT_C_SPARSE ? "sparse" : "";
    }

    void add_array(const matvar_t& variable, const std::string& name, const std::string& times) {
        const std::uint64_t count = elements_of(variable).value_or(most_values + 1);
        LoggedSignal like{
            .name = name, .unit = unit_of_name(name.substr(name.rfind('.') + 1)), .times = times};
        if (count == 0) {
            log_->signals.push_back(like);
            return;
        }
        if (variable.isComplex != 0)
            like.fault = "is complex: save its real and imaginary parts";
        else if (count > most_values - values_)
            like.fault = too_many_numbers(count);
        else if (variable.data == nullptr || variable.nbytes < count * Mat_SizeOfClass(variable.class_type))
            like.fault = "has no data that can be read";
        // Samples run along the last of three dimensions, else along the longer of two.
        std::size_t rows = variable.dims[0], columns = count / std::max<std::size_t>(1, rows);
        std::size_t row_step = 1, column_step = rows;
        if (variable.rank > 2 || rows < columns) {
            std::swap(row_step, column_step);
            rows = variable.rank > 2 ? variable.dims[variable.rank - 1] : columns;
            columns = count / std::max<std::size_t>(1, rows);
            row_step = columns;
            column_step = 1;
        }
        if (columns > most_columns)
            like.fault = fmt::format("has {} columns; at most {} are read", columns, most_columns);
        if (!like.fault.empty()) {
            log_->signals.push_back(like);
            return;
        }
        values_ += count;
        const Append append = append_of(variable);
        add_columns(*log_, like, rows, columns,
                    [&](LoggedSignal& signal, std::size_t row, std::size_t column) {
                        append(signal, variable, row * row_step + column * column_step);
                    });
        for (std::size_t k = log_->signals.size() - columns; k < log_->signals.size(); ++k)
            if (log_->signals[k].whole.size() != log_->signals[k].values.size())
                log_->signals[k].whole.clear();
    }

    void add_text(const matvar_t& variable, const std::string& name) {
        const std::uint64_t count = elements_of(variable).value_or(0);
        if (variable.data == nullptr || count == 0 || variable.rank != 2 || variable.dims[0] != 1) return;
        std::string& text = log_->texts[name];
        const std::size_t width = variable.nbytes / count;
        for (std::uint64_t k = 0; k < count; ++k) {
            if (width == 1) text += static_cast<const char*>(variable.data)[k];
            if (width == 2) {
                const auto letter = static_cast<const std::uint16_t*>(variable.data)[k];
                text += letter < 0x80 ? static_cast<char>(letter) : '?';
            }
        }
    }

    /// Simulink's structure with time: a field `time`, and `signals` with `values` and `label`.
    static const matvar_t* time_of_simulink(const matvar_t& variable) {
        const matvar_t* time = Mat_VarGetStructFieldByName(const_cast<matvar_t*>(&variable), "time", 0);
        const matvar_t* signals = Mat_VarGetStructFieldByName(const_cast<matvar_t*>(&variable), "signals", 0);
        if (time == nullptr || signals == nullptr || signals->class_type != MAT_C_STRUCT) return nullptr;
        return append_of(*time) != nullptr && elements_of(*time).value_or(0) > 0 ? time : nullptr;
    }

    void add_simulink(const matvar_t& variable, const matvar_t& time, const std::string& name) {
        const std::string times = name + ".time";
        const std::size_t first = log_->signals.size();
        add_array(time, times, "");
        if (log_->signals.size() != first + 1) return;
        log_->signals.back().unit = "s";
        auto* signals = Mat_VarGetStructFieldByName(const_cast<matvar_t*>(&variable), "signals", 0);
        for (std::uint64_t k = 0; k < elements_of(*signals).value_or(0); ++k) {
            const matvar_t* values = Mat_VarGetStructFieldByName(signals, "values", k);
            const matvar_t* label = Mat_VarGetStructFieldByName(signals, "label", k);
            std::string signal = fmt::format("signals[{}]", k + 1);
            if (label != nullptr && label->class_type == MAT_C_CHAR) {
                add_text(*label, signal);
                if (auto text = log_->texts.extract(signal); !text.empty() && !text.mapped().empty())
                    signal = text.mapped();
            }
            if (values != nullptr && append_of(*values) != nullptr)
                add_array(*values, fmt::format("{}.{}", name, signal), times);
        }
    }

    void add_struct(const matvar_t& variable, const std::string& name, const std::string& times, int depth) {
        const std::uint64_t count = elements_of(variable).value_or(0);
        char* const* fields = Mat_VarGetStructFieldnames(&variable);
        if (count == 0 || variable.data == nullptr || fields == nullptr) return;
        if (const matvar_t* time = count == 1 ? time_of_simulink(variable) : nullptr; time != nullptr) {
            add_simulink(variable, *time, name);
            return;
        }
        const unsigned number_of_fields = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&variable));
        for (std::uint64_t k = 0; k < std::min<std::uint64_t>(count, most_columns); ++k) {
            const std::string element = count == 1 ? name : fmt::format("{}[{}]", name, k + 1);
            for (unsigned field = 0; field < number_of_fields; ++field)
                add(Mat_VarGetStructFieldByIndex(const_cast<matvar_t*>(&variable), field, k),
                    fmt::format("{}.{}", element, fields[field]), times, depth + 1);
        }
        if (count > most_columns) pass_over_rest(fmt::format("{}[{}]", name, most_columns + 1), count);
    }

    void add_cells(const matvar_t& variable, const std::string& name, int depth) {
        const std::uint64_t count = elements_of(variable).value_or(0);
        if (variable.data == nullptr) {
            if (count > 0) log_->signals.push_back({.name = name, .fault = "has no data that can be read"});
            return;
        }
        for (std::uint64_t k = 0; k < std::min<std::uint64_t>(count, most_columns); ++k)
            add(Mat_VarGetCell(const_cast<matvar_t*>(&variable), static_cast<int>(k)),
                fmt::format("{}{{{}}}", name, k + 1), "", depth + 1);
        if (count > most_columns) pass_over_rest(fmt::format("{}{{{}}}", name, most_columns + 1), count);
    }

    /// Of an array of structures or cells.
    void pass_over_rest(std::string name, std::uint64_t count) {
        log_->signals.push_back(
            {.name = std::move(name),
             .fault = fmt::format("and what follows it are passed over: of {} elements {} are read", count,
                                  most_columns)});
    }

    Log* log_;
    bool is_full_ = false;
    std::uint64_t values_ = 0;
};

void pass_over_messages(int, char*) {}

/// Format 5. What is wrong with the file, or nothing.
std::string read_mat5_variables(const char* file, const MatContents& contents, MatReader& reader, Log& log) {
    const std::unique_ptr<mat_t, CloseMat> mat(Mat_Open(file, MAT_ACC_RDONLY));
    if (mat == nullptr) return "libmatio cannot open it as a MAT file: it is damaged or cut off";
    std::set<std::string> left(contents.variables.begin(), contents.variables.end());
    while (const Variable variable{Mat_VarReadNextInfo(mat.get())}) {
        const std::string name = variable->name == nullptr ? "" : variable->name;
        left.erase(name);
        if (name.empty() || contents.faults.contains(name)) continue;
        const std::uint64_t count = elements_of(*variable).value_or(most_values + 1);
        if (count > most_values - reader.values()) {
            log.signals.push_back({.name = name, .fault = too_many_numbers(count)});
            continue;
        }
        if (Mat_VarReadDataAll(mat.get(), variable.get()) != 0)
            return fmt::format("{}: libmatio cannot read it: the file is damaged there", name);
        reader.add(variable.get(), name, "", 0);
    }
    for (const std::string& name : left)
        log.signals.push_back({.name = name, .fault = "libmatio does not find it: the file is damaged"});
    return {};
}

}  // namespace

LogOrFault read_mat_file(const char* file) {
    Mat_LogInitFunc("fidservo", pass_over_messages);
    const bool is_hdf5 = H5Fis_hdf5(file) > 0;
    const MatContents contents = is_hdf5 ? look_into_mat73(file) : look_into_mat5(file);
    if (!contents.damage.empty()) return tl::make_unexpected(contents.damage);
    Log log;
    for (const auto& [variable, fault] : contents.faults)
        log.signals.push_back({.name = variable, .fault = fault});
    MatReader reader(log);
    const std::string damage =
        is_hdf5 ? read_mat73_variables(file,
                                       [&](const std::string& name, const matvar_t& variable) {
                                           if (!contents.faults.contains(name))
                                               reader.add(&variable, name, "", 0);
                                       })
                : read_mat5_variables(file, contents, reader, log);
    if (!damage.empty()) return tl::make_unexpected(damage);
    if (log.signals.empty() && log.texts.empty())
        return tl::make_unexpected(std::string("holds no variable that can be read"));
    const bool is_of_no_use =
        log.texts.empty() &&
        std::ranges::all_of(log.signals, [](const LoggedSignal& signal) { return !signal.fault.empty(); });
    if (is_of_no_use) return tl::make_unexpected(log.signals.front().name + ": " + log.signals.front().fault);
    take_units_off_names(log);
    return log;
}

}  // namespace fidservo::imports

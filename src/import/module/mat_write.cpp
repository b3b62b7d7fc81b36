// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/mat_log.h"

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <matio.h>

namespace fidservo::imports {
namespace {

struct Close {
    void operator()(mat_t* mat) const { Mat_Close(mat); }
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using OwnedVariable = std::unique_ptr<matvar_t, Close>;

/// libmatio copies what it is given, and says so nowhere in its types.
OwnedVariable variable_of(const char* name, matio_classes of, matio_types type,
                          std::array<std::size_t, 2> size, const void* data) {
    return OwnedVariable(Mat_VarCreate(name, of, type, 2, size.data(), const_cast<void*>(data), 0));
}

OwnedVariable array_of(const LoggedSignal& signal) {
    const std::array<std::size_t, 2> size{signal.values.size(), 1};
    return signal.whole.empty() ? variable_of(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, size, signal.values.data())
                                : variable_of(nullptr, MAT_C_INT64, MAT_T_INT64, size, signal.whole.data());
}

}  // namespace

std::string write_mat_file(const char* file, const Log& log) {
    const std::unique_ptr<mat_t, Close> mat(Mat_CreateVer(file, nullptr, MAT_FT_MAT5));
    if (mat == nullptr) return "cannot be made";
    std::map<std::string, std::vector<const LoggedSignal*>> groups;
    for (const LoggedSignal& signal : log.signals)
        groups[signal.name.substr(0, signal.name.find('.'))].push_back(&signal);
    bool is_written = true;
    for (const auto& [group, signals] : groups) {
        std::vector<std::string> names;
        names.reserve(signals.size());
        for (const LoggedSignal* signal : signals) names.push_back(signal->name.substr(group.size() + 1));
        std::vector<const char*> fields;
        fields.reserve(names.size() + 1);
        for (const std::string& name : names) fields.push_back(name.c_str());
        fields.push_back(nullptr);
        const std::array<std::size_t, 2> one{1, 1};
        const OwnedVariable structure(Mat_VarCreateStruct2(group.c_str(), 2, one.data(), fields.data()));
        if (structure == nullptr) return "libmatio cannot make a structure";
        for (std::size_t k = 0; k < signals.size(); ++k)
            Mat_VarSetStructFieldByIndex(structure.get(), k, 0, array_of(*signals[k]).release());
        is_written = Mat_VarWrite(mat.get(), structure.get(), MAT_COMPRESSION_ZLIB) == 0 && is_written;
    }
    for (const auto& [name, text] : log.texts) {
        const OwnedVariable letters =
            variable_of(name.c_str(), MAT_C_CHAR, MAT_T_UTF8, {1, text.size()}, text.data());
        is_written = letters != nullptr &&
                     Mat_VarWrite(mat.get(), letters.get(), MAT_COMPRESSION_NONE) == 0 && is_written;
    }
    return is_written ? std::string() : "libmatio could not write all of it";
}

}  // namespace fidservo::imports

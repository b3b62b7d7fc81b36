// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/import/made_files.h"

#include <array>
#include <fstream>

#include <gtest/gtest.h>
#include <matio.h>

namespace fidservo::imports::testing {
namespace {

matvar_t* column_variable(const char* name, std::vector<double>& values) {
    std::array<std::size_t, 2> size{values.size(), 1};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), 0);
}

mat_t* new_mat(const std::filesystem::path& file, MatFormat format) {
    mat_t* mat = Mat_CreateVer(file.c_str(), nullptr, format == MatFormat::five ? MAT_FT_MAT5 : MAT_FT_MAT73);
    EXPECT_NE(mat, nullptr);
    return mat;
}

/// A data element whose data are padded to eight bytes.
std::string element(std::uint32_t type, const std::string& data) {
    const auto size = static_cast<std::uint32_t>(data.size());
    std::string bytes(reinterpret_cast<const char*>(&type), sizeof type);
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes += data;
    bytes.append((8 - data.size() % 8) % 8, '\0');
    return bytes;
}

}  // namespace

void make_plain_mat(const std::filesystem::path& file, MatFormat format, std::vector<MadeSignal> signals) {
    mat_t* mat = new_mat(file, format);
    for (MadeSignal& signal : signals) {
        matvar_t* variable = column_variable(signal.name.c_str(), signal.values);
        EXPECT_EQ(Mat_VarWrite(mat, variable, MAT_COMPRESSION_ZLIB), 0);
        Mat_VarFree(variable);
    }
    Mat_Close(mat);
}

void make_simulink_mat(const std::filesystem::path& file, MatFormat format, std::vector<double> time_s,
                       std::vector<MadeSignal> signals) {
    mat_t* mat = new_mat(file, format);
    const std::array<const char*, 3> fields{"time", "signals", nullptr};
    const std::array<const char*, 3> of_signals{"values", "label", nullptr};
    const std::array<std::size_t, 2> one{1, 1}, many{1, signals.size()};
    matvar_t* out = Mat_VarCreateStruct2("out", 2, one.data(), fields.data());
    matvar_t* array = Mat_VarCreateStruct2(nullptr, 2, many.data(), of_signals.data());
    for (std::size_t k = 0; k < signals.size(); ++k) {
        std::array<std::size_t, 2> length{1, signals[k].name.size()};
        Mat_VarSetStructFieldByIndex(array, 0, k, column_variable(nullptr, signals[k].values));
        Mat_VarSetStructFieldByIndex(
            array, 1, k,
            Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF8, 2, length.data(), signals[k].name.data(), 0));
    }
    Mat_VarSetStructFieldByIndex(out, 0, 0, column_variable(nullptr, time_s));
    Mat_VarSetStructFieldByIndex(out, 1, 0, array);
    EXPECT_EQ(Mat_VarWrite(mat, out, MAT_COMPRESSION_NONE), 0);
    Mat_VarFree(out);
    Mat_Close(mat);
}

std::string opaque_mat(const std::string& variable, const std::string& matlab_class) {
    constexpr std::uint32_t int8 = 1, uint32 = 6, matrix = 14, opaque = 17;
    std::string header = "MATLAB 5.0 MAT-file, Platform: GLNXA64";
    header.resize(124, ' ');
    header += std::string("\x00\x01IM", 4);
    const std::array<std::uint32_t, 2> flags{opaque, 0};
    const std::array<std::uint32_t, 6> reference{0xDD000000, 2, 1, 1, 1, 1};
    const std::string data(reinterpret_cast<const char*>(reference.data()), sizeof reference);
    const std::string numbers =
        element(uint32, std::string(reinterpret_cast<const char*>(flags.data()), sizeof flags));
    return header + element(matrix, numbers + element(int8, variable) + element(int8, "MCOS") +
                                        element(int8, matlab_class) + element(matrix, element(uint32, data)));
}

}  // namespace fidservo::imports::testing

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Columns of the shared text tables. Tests skip where the data are absent, unless FIDSERVO_REQUIRE_DATA is
// set.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::testing {

/// Rows of numbers, separated by blanks or commas, below `header_lines`; empty if the file is absent.
inline std::vector<std::vector<double>> shared_table(const std::string& name, int header_lines) {
    std::ifstream file(std::filesystem::path(FIDSERVO_DATA_DIR) / name);
    if (!file) {
        EXPECT_EQ(std::getenv("FIDSERVO_REQUIRE_DATA"), nullptr) << "the shared data are absent: " << name;
        return {};
    }
    std::vector<std::vector<double>> rows;
    std::string line;
    for (int i = 0; i < header_lines; ++i) std::getline(file, line);
    while (std::getline(file, line)) {
        for (char& c : line)
            if (c == ',') c = ' ';
        std::istringstream text(line);
        std::vector<double> row;
        for (double value = 0.0; text >> value;) row.push_back(value);
        rows.push_back(std::move(row));
    }
    return rows;
}

inline std::vector<double> column(const std::vector<std::vector<double>>& rows, std::size_t index) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const auto& row : rows) values.push_back(row.at(index));
    return values;
}

}  // namespace fidservo::testing

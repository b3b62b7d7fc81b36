// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/fod_file.h"

#include "core/input_error.h"
#include "src/files/text/csv_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

namespace fidservo {

namespace {

struct FodRow {
    double peak_degC;
    double temp_degC;
    double contraction_mm;
    int line;
};

std::vector<FodRow> read_rows(CsvText& csv) {
    constexpr std::string_view header = "peak_temp_degC,temp_degC,contraction_mm";
    if (!csv.next() || fmt::format("{}", fmt::join(csv.fields(), ",")) != header)
        csv.fail(fmt::format("the header must be {}", header));
    std::vector<FodRow> rows;
    while (csv.next()) {
        csv.expect_fields(3);
        rows.push_back({csv.number(0), csv.number(1), csv.number(2), csv.line()});
        if (rows.back().temp_degC > rows.back().peak_degC)
            csv.fail(fmt::format("temp_degC: {}: must not be above peak_temp_degC, {}", rows.back().temp_degC,
                                 rows.back().peak_degC));
    }
    return rows;
}

std::vector<double> equally_spaced_nodes(const std::vector<FodRow>& rows, const std::filesystem::path& file) {
    std::set<double> distinct;
    for (const FodRow& row : rows) distinct.insert(row.peak_degC);
    std::vector<double> nodes(distinct.begin(), distinct.end());
    if (nodes.size() < 2)
        throw InputError(fmt::format("{}: at least two peak temperatures are needed", file.string()));
    const double step = (nodes.back() - nodes.front()) / static_cast<double>(nodes.size() - 1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (std::abs(nodes[i] - (nodes.front() + step * static_cast<double>(i))) > 1e-6 * step)
            throw InputError(fmt::format("{}: peak_temp_degC: {}: the temperatures must be equally spaced",
                                         file.string(), nodes[i]));
    return nodes;
}

}  // namespace

FodTable load_fod(const std::filesystem::path& file) {
    CsvText csv = CsvText::load(file);
    const std::vector<FodRow> rows = read_rows(csv);
    const std::vector<double> nodes = equally_spaced_nodes(rows, file);

    const auto fail = [&](int line, const std::string& message) {
        throw InputError(fmt::format("{}:{}: {}", file.string(), line, message));
    };
    const auto index_of = [&](double temp_degC, int line) {
        const auto found = std::find(nodes.begin(), nodes.end(), temp_degC);
        if (found == nodes.end())
            fail(line, fmt::format("temp_degC: {}: must be one of the peak temperatures", temp_degC));
        return static_cast<std::size_t>(found - nodes.begin());
    };
    std::vector<double> triangle(nodes.size() * (nodes.size() + 1) / 2,
                                 std::numeric_limits<double>::quiet_NaN());
    for (const FodRow& row : rows) {
        const std::size_t peak = index_of(row.peak_degC, row.line);
        double& cell = triangle[peak * (peak + 1) / 2 + index_of(row.temp_degC, row.line)];
        if (!std::isnan(cell))
            fail(row.line, fmt::format("{},{}: is given twice", row.peak_degC, row.temp_degC));
        cell = row.contraction_mm;
    }
    for (std::size_t peak = 0, next = 0; peak < nodes.size(); ++peak)
        for (std::size_t temp = 0; temp <= peak; ++temp, ++next)
            if (std::isnan(triangle[next]))
                throw InputError(fmt::format("{}: peak_temp_degC {}, temp_degC {}: the row is missing",
                                             file.string(), nodes[peak], nodes[temp]));
    return {nodes, std::move(triangle)};
}

std::string fod_text(const FodTable& table) {
    std::string text = "peak_temp_degC,temp_degC,contraction_mm\n";
    const auto node_degC = [&](std::size_t i) {
        return table.low_degC() + table.step_degC() * static_cast<double>(i);
    };
    for (std::size_t peak = 0; peak < table.nodes(); ++peak)
        for (std::size_t temp = 0; temp <= peak; ++temp)
            text += fmt::format("{:.9g},{:.9g},{:.5f}\n", node_degC(peak), node_degC(temp),
                                table.node_mm(peak, temp));
    return text;
}

}  // namespace fidservo

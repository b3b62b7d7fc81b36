// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as many instruments, libraries and spreadsheets would write the same numbers.
#include "core/input_error.h"
#include "src/identify/text_table.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace fidservo {
namespace {

constexpr std::size_t columns = 3;  ///< time, input, output

/// Draws how a table is written, writes it, and knows its numbers.
class WrittenTable {
  public:
    explicit WrittenTable(std::mt19937_64& random) : random_(&random) {
        separator_ = one_of<std::string>({",", ";", "\t", "|", " ", "  ", ", "});
        comma_ = chance(0.4);
        grouping_ = chance(0.2) ? one_of<std::string>({comma_ ? "." : ",", "'", "\xC2\xA0"}) : "";
        decimals_ = pick(1, 5);
        exponent_ = chance(0.2) ? one_of<std::string>({"e", "E", "D"}) : "";
        quotes_ = separator_.size() == 1 && separator_ != " " && chance(0.2);
        trailing_ = separator_.size() == 1 && separator_ != " " && chance(0.2);
        fill();
        damage();
        header();
        body();
        if (chance(0.2)) lines_.emplace_back("End of data");
        encode();
    }

    const std::string& bytes() const { return bytes_; }
    bool must_be_refused() const { return must_be_refused_; }
    const std::vector<std::vector<double>>& numbers() const { return numbers_; }
    std::string choice() const {
        return has_titles_ && choose_by_title_ ? "time=Time,input=Drive,output=Position"
                                               : "time=1,input=2,output=3";
    }

  private:
    int pick(int low, int high) { return std::uniform_int_distribution(low, high)(*random_); }
    bool chance(double share) { return std::bernoulli_distribution(share)(*random_); }
    template <class T>
    T one_of(const std::vector<T>& all) {
        return all[static_cast<std::size_t>(pick(0, static_cast<int>(all.size()) - 1))];
    }

    void fill() {
        const int rows = pick(3, 40);
        const double size = std::pow(10.0, pick(-1, 4)), step = std::pow(10.0, pick(-2, 3));
        std::uniform_real_distribution<double> around(-size, size);
        const int base = pick(0, 1) * pick(1, 5000);
        for (int k = 0; k < rows; ++k)
            numbers_.push_back({base + step * k, around(*random_), around(*random_)});
    }

    std::string digits_grouped(std::string whole) {
        for (int at = static_cast<int>(whole.size()) - 3; at > 0 && !grouping_.empty(); at -= 3)
            whole.insert(static_cast<std::size_t>(at), grouping_);
        return whole;
    }
    /// Writes a number, and keeps what is written of it.
    std::string written(double& number) {
        std::string text = exponent_.empty() ? fmt::format("{:.{}f}", number, decimals_)
                                             : fmt::format("{:.{}e}", number, decimals_);
        number = std::stod(text);
        if (exponent_.empty()) {
            const bool negative = text.starts_with('-');
            const auto point = text.find('.');
            text = (negative ? "-" : "") + digits_grouped(text.substr(negative, point - (negative ? 1 : 0))) +
                   text.substr(point);
        }
        const auto point = text.rfind('.');
        if (comma_) text[point] = ',';
        if (const auto e = text.find('e'); e != std::string::npos) text.replace(e, 1, exponent_);
        return quotes_ ? '"' + text + '"' : text;
    }

    void damage() {
        if (!chance(0.25)) return;
        damaged_row_ = pick(1, static_cast<int>(numbers_.size()) - 2);
        damaged_field_ = pick(0, columns - 1);
        damage_ = one_of<std::string>({"NaN", "", "ERR", "inf", "ragged", "longer", "text line"});
        must_be_refused_ = true;
    }

    void title_lines(const std::vector<std::string>& titles, const std::vector<std::string>& units) {
        has_titles_ = separator_.find_first_not_of(' ') != std::string::npos || units.empty();
        if (separator_.size() > 1 && separator_ != ", ") has_titles_ = false;
        std::vector<std::string> both;
        const int style = pick(0, 3);
        for (std::size_t k = 0; k < titles.size(); ++k)
            both.push_back(style == 0   ? titles[k] + " [" + units[k] + "]"
                           : style == 1 ? titles[k] + " (" + units[k] + ")"
                           : style == 2 ? titles[k] + "/" + units[k]
                                        : titles[k]);
        if (separator_.find_first_not_of(' ') == std::string::npos) both = titles;
        lines_.push_back((chance(0.2) ? "# " : "") + joined(both) + (trailing_ ? separator_ : ""));
        if (style == 3 && separator_.find_first_not_of(' ') != std::string::npos &&
            !lines_.back().starts_with('#'))
            lines_.push_back(joined(units) + (trailing_ ? separator_ : ""));
        choose_by_title_ = chance(0.5);
    }

    void header() {
        const std::string& s = separator_;
        switch (pick(0, 6)) {
            case 0:
                break;
            case 1:
                title_lines({"Time", "Drive", "Position"}, {"s", "V", "mm"});
                break;
            case 2:
                lines_ = {"Acme DAQ 3000", "Date" + s + "2020-03-16 17:04:51", "Interval" + s + "0.001",
                          "Samples" + s + "1024"};
                title_lines({"Time", "Drive", "Position"}, {"s", "V", "mm"});
                break;
            case 3:
                lines_ = {"% exported, by hand", "% in 2020"};
                title_lines({"Time", "Drive", "Position"}, {"s", "V", "mm"});
                break;
            case 4:
                lines_ = {"LabVIEW Measurement", "Separator" + s + "Tab", "***End_of_Header***", ""};
                title_lines({"Time", "Drive", "Position"}, {"s", "V", "mm"});
                break;
            case 5:
                lines_ = {"Run 17 of 24", ""};
                break;
            default:
                lines_ = {"Interval" + s + "0.5" + s + "0.5", "Channel" + s + "A" + s + "B"};
                title_lines({"Time", "Drive", "Position"}, {"s", "V", "mm"});
        }
    }

    std::string joined(const std::vector<std::string>& fields) const {
        return fmt::format("{}", fmt::join(fields, separator_));
    }

    void body() {
        for (std::size_t k = 0; k < numbers_.size(); ++k) {
            std::vector<std::string> fields;
            for (double& number : numbers_[k]) fields.push_back(written(number));
            const bool is_damaged = static_cast<int>(k) == damaged_row_;
            if (is_damaged && damage_ == "ragged")
                fields.pop_back();
            else if (is_damaged && damage_ == "longer")
                fields.push_back(fields.back());
            else if (is_damaged && damage_ == "text line")
                lines_.emplace_back("new block");
            else if (is_damaged)
                fields[static_cast<std::size_t>(damaged_field_)] = damage_;
            lines_.push_back(joined(fields) + (trailing_ ? separator_ : ""));
            if (chance(0.03)) lines_.emplace_back("");
            if (chance(0.02)) lines_.emplace_back("# a comment");
        }
    }

    void encode() {
        const std::string end = one_of<std::string>({"\n", "\r\n", "\r"});
        std::string text = fmt::format("{}", fmt::join(lines_, end));
        if (chance(0.8)) text += end;
        const int encoding = pick(0, 4);
        if (encoding == 1) text = "\xEF\xBB\xBF" + text;
        if (encoding >= 2 && encoding <= 3 && text.find('\xC2') == std::string::npos) {
            bytes_ = encoding == 2 ? "\xFF\xFE" : "\xFE\xFF";
            for (const char letter : text)
                bytes_.append(encoding == 2 ? std::string{letter, '\0'} : std::string{'\0', letter});
            return;
        }
        bytes_ = text;
    }

    std::mt19937_64* random_;
    std::string separator_, grouping_, exponent_, damage_, bytes_;
    bool comma_, quotes_, trailing_, must_be_refused_ = false, has_titles_ = false, choose_by_title_ = false;
    int decimals_, damaged_row_ = -1, damaged_field_ = 0;
    std::vector<std::vector<double>> numbers_;
    std::vector<std::string> lines_;
};

Outcome judge(const WrittenTable& written, const TextTable& table) {
    if (written.must_be_refused()) return Outcome::wrong("damage was passed over:\n" + written.bytes());
    if (table.rows() != written.numbers().size())
        return Outcome::wrong(
            fmt::format("{} of {} rows:\n{}", table.rows(), written.numbers().size(), written.bytes()));
    for (std::size_t row = 0; row < table.rows(); ++row)
        for (std::size_t k = 0; k < columns; ++k)
            if (table.columns[k].values[row] != written.numbers()[row][k])
                return Outcome::wrong(fmt::format("row {}, column {}: {} in place of {}:\n{}", row + 1, k + 1,
                                                  table.columns[k].values[row], written.numbers()[row][k],
                                                  written.bytes()));
    return Outcome::right();
}

TEST(TableVariations, InstrumentsTables_AreReadRightOrRefused) {
    const testing::TemporaryFolder folder;
    constexpr std::array<std::string_view, 3> roles{"time", "input", "output"};
    expect_right_or_refused("tables of instruments", 300, [&](std::mt19937_64& random) {
        const WrittenTable written(random);
        try {
            return judge(written, read_text_table(folder.write("table.csv", written.bytes()),
                                                  parse_columns(written.choice(), roles, roles.size())));
        } catch (const InputError& error) {
            return Outcome::refused(error.what());
        }
    });
}

}  // namespace
}  // namespace fidservo

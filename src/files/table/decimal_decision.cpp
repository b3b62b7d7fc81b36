// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/decimal_decision.h"

#include <algorithm>

namespace fidservo {

namespace {

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Whether a column of fields between commas could belong to the column before it.
class ContinuationWatch {
  public:
    void saw(std::string_view before, std::string_view field) {
        const std::string_view digits = field.substr(0, field.find_first_not_of("0123456789"));
        const std::string_view behind = field.substr(digits.size());
        are_digits_ = are_digits_ && !digits.empty() && !behind.starts_with('.');
        is_one_width_ = is_one_width_ && (rows_ == 0 || digits.size() == width_);
        differs_ = differs_ || (rows_ > 0 && field != last_);
        // A number that stands alone is not written like this.
        is_no_number_alone_ = is_no_number_alone_ || (digits.size() > 1 && digits.front() == '0') ||
                              before == "-0" ||
                              (digits.size() > 1 && !behind.empty() && behind.front() != '.');
        const std::string_view size =
            before.substr(before.starts_with('-') || before.starts_with('+') ? 1 : 0);
        is_thousands_ = is_thousands_ && is_digits(size) && size.size() <= 3 && size.front() != '0' &&
                        digits.size() == 3 && (behind.empty() || behind.front() == '.');
        width_ = digits.size();
        last_ = field;
        ++rows_;
    }
    bool could_be_decimals(bool every_number_has_decimals) const {
        const bool by_width =
            are_digits_ && is_one_width_ && (every_number_has_decimals || (differs_ && width_ > 1));
        return by_width || is_no_number_alone_;
    }
    bool could_be_thousands() const { return is_thousands_; }

  private:
    bool are_digits_ = true, is_one_width_ = true, differs_ = false, is_no_number_alone_ = false,
         is_thousands_ = true;
    std::size_t width_ = 0, rows_ = 0;
    std::string last_;
};

}  // namespace

DecimalEvidence decimal_evidence_of(const PlainTable& table, char separator, std::size_t columns) {
    DecimalEvidence evidence;
    std::vector<ContinuationWatch> watches(separator == ',' ? columns : 0);
    table.for_each_row([&](const TableRow& row) {
        for (std::size_t k = 0; k < row.fields.size(); ++k) {
            const std::string_view field = row.fields[k];
            const FieldLook look = look_at(field);
            const SignEvidence told = look.evidence;
            evidence.has_point_between_commas = evidence.has_point_between_commas ||
                                                (told == SignEvidence::point_or_group && separator == ',' &&
                                                 field.find('.') != std::string_view::npos);
            if (told == SignEvidence::point && evidence.point.line == 0)
                evidence.point = {row.line, std::string(field)};
            if (told == SignEvidence::comma && evidence.comma.line == 0)
                evidence.comma = {row.line, std::string(field)};
            if (k > 0 && k < watches.size()) watches[k].saw(row.fields[k - 1], field);
        }
    });
    for (std::size_t k = watches.size(); k-- > 1;) {
        if (watches[k].could_be_decimals(columns % 2 == 0)) evidence.could_be_decimals = k;
        if (watches[k].could_be_thousands()) evidence.could_be_thousands = k;
    }
    return evidence;
}

}  // namespace fidservo

#include "src/table/decimal_decision.h"

#include <algorithm>

namespace fidservo {

namespace {

/// Whether a column of fields between commas could be the decimals of the column before it.
class DecimalsWatch {
  public:
    void saw(std::string_view field) {
        // Programs that leave out the point, as in 1e-05, write one digit in front of the exponent.
        const std::size_t digits_in_front = field.find_first_not_of("0123456789");
        has_long_mantissa_ =
            has_long_mantissa_ ||
            (digits_in_front != std::string_view::npos && digits_in_front > 1 &&
             std::string_view("eEdD").find(field[digits_in_front]) != std::string_view::npos);
        const bool digits = !field.empty() && field.find_first_not_of("0123456789") == std::string_view::npos;
        are_digits_ = are_digits_ && digits;
        if (!digits) return;
        leads_with_zero_ = leads_with_zero_ || (field.size() > 1 && field.front() == '0');
        is_one_width_ = is_one_width_ && (rows_ == 0 || field.size() == width_);
        differs_ = differs_ || (rows_ > 0 && field != last_);
        width_ = field.size();
        last_ = field;
        ++rows_;
    }
    bool leads_with_zero() const { return are_digits_ && leads_with_zero_; }
    bool has_long_mantissa() const { return has_long_mantissa_; }
    bool has_one_width() const { return are_digits_ && is_one_width_ && differs_ && width_ > 1; }

  private:
    bool are_digits_ = true, leads_with_zero_ = false, is_one_width_ = true, differs_ = false;
    bool has_long_mantissa_ = false;
    std::size_t width_ = 0, rows_ = 0;
    std::string last_;
};

}  // namespace

DecimalEvidence decimal_evidence_of(const PlainTable& table, char separator, std::size_t columns) {
    DecimalEvidence evidence;
    std::vector<DecimalsWatch> watches(separator == ',' ? columns : 0);
    table.for_each_row([&](const TableRow& row) {
        for (std::size_t k = 0; k < row.fields.size(); ++k) {
            const std::string_view field = row.fields[k];
            const FieldLook look = look_at(field);
            const bool has_point = field.find('.') != std::string_view::npos;
            SignEvidence told = look.evidence;
            // No program writes commas between fields and points between thousands.
            if (told == SignEvidence::point_or_group && separator == ',' && has_point)
                told = SignEvidence::point;
            if (told == SignEvidence::point && evidence.point.line == 0)
                evidence.point = {row.line, std::string(field)};
            if (told == SignEvidence::comma && evidence.comma.line == 0)
                evidence.comma = {row.line, std::string(field)};
            if (k < watches.size()) watches[k].saw(field);
        }
    });
    for (std::size_t k = 1; k < watches.size() && !evidence.could_be_decimals; ++k)
        if (watches[k].leads_with_zero() || watches[k].has_one_width() || watches[k].has_long_mantissa())
            evidence.could_be_decimals = k;
    return evidence;
}

}  // namespace fidservo

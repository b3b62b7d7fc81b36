// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Splits a line of a table into fields.
#include <string_view>
#include <vector>

namespace fidservo {

/// Splits a line without copies. The separator ' ' stands for any run of blanks and tabs. Quotes (" or ')
/// that begin and end a field are taken off, and what stands between " is not split.
void split_line(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Whether a line is a comment of a table with this separator: begins with #, %, //, !, or a semicolon that
/// does not separate.
bool is_comment(std::string_view line, char separator);

/// A comment without its comment sign.
std::string_view without_comment_mark(std::string_view line);

}  // namespace fidservo

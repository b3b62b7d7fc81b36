// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numbers of the diagnosis, and the list of them in docs/constants.md.
//
// A number is a literal in a file of gap/ other than 0, 1, 2 and 0.5. It is written in one of three places:
//
// - in the value of a named constant: a constexpr, or a member's default in a struct;
// - in the rows or columns of a matrix's or an array's type;
// - in a statement, or a function, of which the comment before it says "Mathematics:" and what it is: the
//   coefficients of a formula in closed form, which nobody could choose otherwise.
//
// A constexpr is a constant if its value has any literal at all. One whose value only combines names, with no
// numbers but those four, follows from these and is none.
#include "tests/house/house_rules.h"

#include <string>
#include <tuple>
#include <vector>

namespace fidservo::house {

struct Constant {
    std::string file;   ///< from the top of the repository
    std::string name;   ///< of a member with that of its struct: Struct::member
    std::string value;  ///< as it is written, with single spaces

    bool operator==(const Constant& other) const = default;
    bool operator<(const Constant& other) const {
        return std::tie(file, name, value) < std::tie(other.file, other.name, other.value);
    }
};

std::vector<Constant> constants_of(const SourceFile& file);

/// A line of the list: | `file` | `name` | `value` | kind | why |, below the heading of its folder.
struct ListedConstant {
    Constant constant;
    std::string kind, why;
};

std::vector<ListedConstant> listed_constants(const SourceFile& list);

/// Numbers of the diagnosis that have no name.
Findings nameless_numbers(const SourceFile& file);

/// Constants of the diagnosis that the list lacks, or of which it says another value; and lines of the list
/// for which there is no constant, or that state no reason or none of the kinds of constants.
Findings constants_off_the_list(const std::vector<SourceFile>& house, const SourceFile& list);

/// Kinds of which the list's introduction does not say how many lines there are: | kind | what it is | number
/// |.
Findings miscounted_kinds(const SourceFile& list);

}  // namespace fidservo::house

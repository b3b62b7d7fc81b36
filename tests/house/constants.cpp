// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/house/constants.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace fidservo::house {
namespace {

constexpr std::string_view mathematics = "Mathematics:";
constexpr std::array<std::string_view, 8> kinds{"derived", "level", "measured", "numerical",
                                                "effort",  "grid",  "range",    "chosen"};

/// A range of a text, up to, not including, `end`.
struct Part {
    std::size_t begin, end;
    bool has(std::size_t at) const { return begin <= at && at < end; }
};

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

void blank(std::string& code, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < std::min(end, code.size()); ++k)
        if (code[k] != '\n') code[k] = ' ';
}

/// The text, as long, without comments, literals of text, and lines for the preprocessor.
std::string code_of(const std::string& text) {
    std::string code = text;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const std::size_t begin = k;
        const bool is_separator = text[k] == '\'' && k > 0 && is_word(text[k - 1]);
        if (text.compare(k, 2, "//") == 0 || (text[k] == '#' && (k == 0 || text[k - 1] == '\n'))) {
            k = std::min(text.find('\n', k), text.size());
        } else if ((text[k] == '"' || text[k] == '\'') && !is_separator) {
            for (++k; k < text.size() && text[k] != text[begin]; ++k)
                if (text[k] == '\\') ++k;
            ++k;
        } else {
            continue;
        }
        blank(code, begin, k);
        --k;
    }
    return code;
}

/// Literals of numbers, without the digits of names.
std::vector<Part> literals(const std::string& code) {
    std::vector<Part> found;
    for (std::size_t k = 0; k < code.size(); ++k) {
        if (is_word(code[k]) && std::isdigit(static_cast<unsigned char>(code[k])) == 0) {
            while (k + 1 < code.size() && is_word(code[k + 1])) ++k;
        } else if (std::isdigit(static_cast<unsigned char>(code[k])) != 0) {
            const std::size_t begin = k;
            const auto goes_on = [&](std::size_t at) {
                const char before = code[at - 1], c = code[at];
                return is_word(c) || c == '.' || c == '\'' ||
                       ((c == '-' || c == '+') && (before == 'e' || before == 'E'));
            };
            while (k + 1 < code.size() && goes_on(k + 1)) ++k;
            found.push_back({begin, k + 1});
        }
    }
    return found;
}

std::string written(const std::string& code, const Part& part) {
    return code.substr(part.begin, part.end - part.begin);
}

bool is_plain(std::string literal) {
    std::erase(literal, '\'');
    const double value = std::strtod(literal.c_str(), nullptr);
    return value == 0.0 || value == 0.5 || value == 1.0 || value == 2.0;
}

/// Where brackets that are open at `at` are closed, or something that ends an expression stands outside of
/// all of them.
std::size_t end_of_expression(const std::string& code, std::size_t at, std::string_view ends) {
    int depth = 0;
    for (; at < code.size(); ++at) {
        const char c = code[at];
        if (depth == 0 && ends.find(c) != std::string_view::npos) break;
        if (c == '(' || c == '{' || c == '[') ++depth;
        if (c == ')' || c == '}' || c == ']')
            if (--depth < 0) break;
    }
    return at;
}

/// The next statement, or function with its body.
std::size_t end_of_statement(const std::string& code, std::size_t at) {
    const std::size_t end = end_of_expression(code, at, ";{");
    if (end >= code.size() || code[end] != '{') return end;
    const std::size_t body = end_of_expression(code, end + 1, "");
    const std::size_t after = code.find_first_not_of(" \n", body + 1);
    const bool goes_on =
        after != std::string::npos && std::string_view(";,.").find(code[after]) != std::string_view::npos;
    return goes_on ? end_of_expression(code, body + 1, ";") : body;
}

/// Statements whose comments say that they are mathematics.
std::vector<Part> formulas(const std::string& text, const std::string& code) {
    std::vector<Part> found;
    for (std::size_t at = text.find(mathematics); at != std::string::npos;
         at = text.find(mathematics, at + 1)) {
        const std::size_t begin = code.find_first_not_of(" \n", at);
        if (begin != std::string::npos) found.push_back({begin, end_of_statement(code, begin)});
    }
    return found;
}

/// Rows and columns of types.
std::vector<Part> sizes_of_types(const std::string& code) {
    std::vector<Part> found;
    for (const std::string_view type : {"Matrix<", "array<"})
        for (std::size_t at = code.find(type); at != std::string::npos; at = code.find(type, at + 1)) {
            std::size_t end = at + type.size();
            for (int open = 1; open > 0 && end < code.size(); ++end)
                open += code[end] == '<' ? 1 : code[end] == '>' ? -1 : 0;
            found.push_back({at, end});
        }
    return found;
}

/// A name, and the part of the code that gives it a value.
struct Definition {
    std::string name;
    Part value;
};

/// The definitions of a declaration that begins with its type; none of a function.
std::vector<Definition> definitions(const std::string& code, std::size_t at) {
    std::vector<Definition> found;
    int angles = 0;  // that are open in the type
    for (std::size_t name_end = at; name_end < code.size(); ++name_end) {
        const char c = code[name_end];
        if (c == '<') ++angles;
        if (c == '>') --angles;
        if (angles > 0 || std::string_view("={(;)").find(c) == std::string_view::npos) continue;
        if (c != '=' && c != '{') break;
        std::size_t last = name_end;
        while (last > at && !is_word(code[last - 1])) --last;
        std::size_t first = last;
        while (first > at && is_word(code[first - 1])) --first;
        const std::size_t begin = c == '=' ? code.find_first_not_of(" \n", name_end + 1) : name_end;
        const std::size_t end = end_of_expression(code, begin, ",;");
        found.push_back({code.substr(first, last - first), {begin, end}});
        if (end >= code.size() || code[end] != ',') break;
        name_end = end;
    }
    return found;
}

std::size_t past_word(const std::string& code, std::size_t at) {
    while (at < code.size() && is_word(code[at])) ++at;
    return at;
}

std::vector<std::size_t> places_of(const std::string& code, std::string_view word) {
    std::vector<std::size_t> found;
    for (std::size_t at = code.find(word); at != std::string::npos; at = code.find(word, at + 1)) {
        const bool begins = at == 0 || !is_word(code[at - 1]);
        if (begins && past_word(code, at) == at + word.size()) found.push_back(at);
    }
    return found;
}

bool has_numbers(const std::string& code) {
    return std::ranges::any_of(literals(code),
                               [&](const Part& part) { return !is_plain(written(code, part)); });
}

/// Whether a value combines names: has a word that is none of a literal and no cast or limit.
bool has_names(std::string value) {
    for (const Part& part : literals(value)) blank(value, part.begin, part.end);
    static const std::regex named(R"re(\.\w+ =|[A-Za-z_]\w*)re");
    static const std::set<std::string> no_names{"true", "false"};
    for (std::sregex_iterator match(value.begin(), value.end(), named), end; match != end; ++match)
        if (match->str().front() != '.' && !no_names.contains(match->str())) return true;
    return false;
}

bool is_constant(const std::string& value) {
    if (value.find(';') != std::string::npos || literals(value).empty())
        return false;  // a function; no number
    return has_numbers(value) || !has_names(value);
}

/// All definitions of constants.
std::vector<Definition> constants_in(const std::string& code) {
    std::vector<Definition> found;
    for (const std::size_t at : places_of(code, "constexpr"))
        for (Definition& one : definitions(code, past_word(code, at)))
            if (is_constant(written(code, one.value))) found.push_back(std::move(one));
    for (const std::string_view word : {"struct", "class"})
        for (const std::size_t at : places_of(code, word)) {
            const std::size_t open = code.find_first_of(";{(<>,)", at);
            if (open == std::string::npos || code[open] != '{') continue;
            const std::size_t name = code.find_first_not_of(' ', at + word.size());
            const std::string owner = code.substr(name, past_word(code, name) - name);
            const std::size_t close = end_of_expression(code, open + 1, "");
            for (std::size_t k = open + 1; k < close; k = end_of_statement(code, k) + 1) {
                const std::size_t end = end_of_statement(code, k);
                const std::string statement = code.substr(k, end - k);
                if (end < code.size() && code[end] != ';') continue;
                if (!places_of(statement, "constexpr").empty() || !places_of(statement, "struct").empty())
                    continue;
                for (Definition& one : definitions(code, k))
                    if (has_numbers(written(code, one.value)) &&
                        written(code, one.value).find(';') == std::string::npos)
                        found.push_back({owner + "::" + one.name, one.value});
            }
        }
    return found;
}

bool is_of_diagnosis(const SourceFile& file) {
    return file.path.starts_with("gap/");
}

std::string with_single_spaces(const std::string& text) {
    std::istringstream words(text);
    std::string all;
    for (std::string word; words >> word;) all += (all.empty() ? "" : " ") + word;
    return all;
}

std::string without_quotes(std::string cell) {
    std::erase(cell, '`');
    return with_single_spaces(cell);
}

}  // namespace

std::vector<Constant> constants_of(const SourceFile& file) {
    std::vector<Constant> found;
    const std::string code = code_of(file.text);
    for (const Definition& one : constants_in(code))
        found.push_back({file.path, one.name, with_single_spaces(written(code, one.value))});
    return found;
}

std::vector<ListedConstant> listed_constants(const SourceFile& list) {
    std::vector<ListedConstant> found;
    std::istringstream lines(list.text);
    std::string folder;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) folder = without_quotes(line.substr(3));
        if (!line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        std::istringstream rest(line.substr(1));
        for (std::string cell; std::getline(rest, cell, '|');) cells.push_back(cell);
        cells.resize(5);
        found.push_back(
            {{folder + "/" + without_quotes(cells[0]), without_quotes(cells[1]), without_quotes(cells[2])},
             without_quotes(cells[3]),
             with_single_spaces(cells[4])});
    }
    return found;
}

Findings nameless_numbers(const SourceFile& file) {
    if (!is_of_diagnosis(file)) return {};
    const std::string code = code_of(file.text);
    std::vector<Part> allowed = formulas(file.text, code);
    std::ranges::move(sizes_of_types(code), std::back_inserter(allowed));
    for (const Definition& one : constants_in(code)) allowed.push_back(one.value);
    Findings findings;
    for (const Part& literal : literals(code)) {
        const bool is_allowed =
            std::ranges::any_of(allowed, [&](const Part& part) { return part.has(literal.begin); });
        if (is_allowed || is_plain(written(code, literal))) continue;
        const auto line =
            1 + std::count(code.begin(), code.begin() + static_cast<std::ptrdiff_t>(literal.begin), '\n');
        findings.push_back(file.path + ":" + std::to_string(line) +
                           ": a number without a name: " + written(code, literal));
    }
    return findings;
}

Findings constants_off_the_list(const std::vector<SourceFile>& house, const SourceFile& list) {
    std::set<Constant> there, listed;
    for (const SourceFile& file : house)
        if (is_of_diagnosis(file))
            for (Constant& constant : constants_of(file)) there.insert(std::move(constant));
    Findings findings;
    const auto find = [&](const Constant& constant, const std::string& what) {
        findings.push_back(constant.file + ": `" + constant.name + "` = `" + constant.value + "`: " + what);
    };
    for (const ListedConstant& line : listed_constants(list)) {
        if (!listed.insert(line.constant).second) find(line.constant, "is listed twice");
        if (!there.contains(line.constant)) find(line.constant, "is listed, but not in the code");
        if (std::ranges::find(kinds, line.kind) == kinds.end() || line.why.empty())
            find(line.constant, "is listed without its kind or reason");
    }
    for (const Constant& constant : there)
        if (!listed.contains(constant)) find(constant, "is not in " + list.path);
    return findings;
}

Findings miscounted_kinds(const SourceFile& list) {
    std::map<std::string, std::size_t> counts;
    for (const ListedConstant& line : listed_constants(list)) ++counts[line.kind];
    Findings findings;
    for (const auto& [kind, count] : counts) {
        const std::regex line("\\| " + kind + " \\|[^|\n]*\\| (\\d+) \\|");
        std::smatch found;
        if (!std::regex_search(list.text, found, line) || found[1] != std::to_string(count))
            findings.push_back(list.path + ": there are " + std::to_string(count) + " of the kind " + kind);
    }
    return findings;
}

}  // namespace fidservo::house

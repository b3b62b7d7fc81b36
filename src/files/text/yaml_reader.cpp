// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/text/yaml_reader.h"

#include "core/input_error.h"
#include "src/files/text/key_names.h"
#include "src/files/text/plain_number.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {

struct YamlValue::Impl {
    YAML::Node node;
    std::filesystem::path file;
    std::string path;  ///< empty at the root
    int line;          ///< from 1

    std::string child_path(std::string_view key) const {
        return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
    }
    std::string_view key() const {
        const auto dot = path.find_last_of('.');
        std::string_view last = path;
        if (dot != std::string::npos) last.remove_prefix(dot + 1);
        return last.substr(0, last.find('['));
    }
};

namespace {

int line_of(const YAML::Mark& mark, int otherwise) {
    return mark.is_null() ? otherwise : mark.line + 1;
}

std::string shown(const YAML::Node& node) {
    if (node.IsMap()) return "a map";
    if (node.IsSequence()) return "a list";
    if (!node.IsScalar()) return "nothing";
    constexpr std::size_t longest = 60;
    std::string text = node.Scalar().substr(0, longest);
    std::replace_if(
        text.begin(), text.end(), [](unsigned char letter) { return letter < ' '; }, ' ');
    return node.Scalar().size() > longest ? text + "..." : text;
}

[[noreturn]] void fail_at(const std::filesystem::path& file, int line, std::string_view message) {
    throw InputError(fmt::format("{}:{}: {}", file.string(), line, message));
}

/// Keys written twice, and aliases that make a document deeper or larger than its text.
class StructureCheck {
  public:
    StructureCheck(const std::filesystem::path& file, std::size_t text_size)
        : file_(file), most_(text_size + 16) {}

    void visit(const YAML::Node& node, int line, int depth = 0) {
        constexpr int deepest = 40;
        const int here = line_of(node.Mark(), line);
        if (depth > deepest || ++visited_ > most_) fail_at(file_, here, "nested too deeply");
        if (node.IsSequence())
            for (const auto& item : node) visit(item, here, depth + 1);
        if (!node.IsMap()) return;
        std::vector<std::string> seen;
        for (const auto& entry : node) {
            const int key_line = line_of(entry.first.Mark(), here);
            if (!entry.first.IsScalar()) fail_at(file_, key_line, "a key must be a word");
            seen.push_back(entry.first.Scalar());
            visit(entry.second, key_line, depth + 1);
        }
        std::sort(seen.begin(), seen.end());
        const auto twice = std::adjacent_find(seen.begin(), seen.end());
        if (twice != seen.end()) fail_at(file_, here, fmt::format("{}: the key is given twice", *twice));
    }

  private:
    const std::filesystem::path& file_;
    std::size_t most_;
    std::size_t visited_ = 0;
};

std::string allowed_numbers(const NumberRange& range) {
    const bool low = std::isfinite(range.low);
    const bool high = std::isfinite(range.high);
    if (low && high)
        return fmt::format(" {} {} and at most {}", range.open_low ? "above" : "of at least", range.low,
                           range.high);
    if (low) return fmt::format(" {} {}", range.open_low ? "above" : "of at least", range.low);
    if (high) return fmt::format(" of at most {}", range.high);
    return "";
}

/// How many bytes the UTF-8 character that begins here has; 0 if it is none that a text holds. (RFC 3629;
/// control characters but for tab and line ends are none either.)
std::size_t character_at(std::string_view text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return first >= ' ' || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
    const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xc0) != 0x80) return 0;
    const bool too_long = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
    const bool no_character = (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);
    return too_long || no_character ? 0 : length;
}

/// The YAML library never returns from some bytes that are no text.
void demand_text(std::string_view text, const std::filesystem::path& file) {
    int line = 1;
    while (!text.empty()) {
        const std::size_t length = character_at(text);
        if (length == 0) fail_at(file, line, "holds bytes that are not text in UTF-8");
        line += text.front() == '\n';
        text.remove_prefix(length);
    }
}

/// Ends the parse where a second document begins. Some texts, such as one that opens with a comma, are
/// documents without end to the YAML library, so that they must not all be loaded.
class OneDocument : public YAML::EventHandler {
  public:
    explicit OneDocument(const std::filesystem::path& file) : file_(file) {}

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++begun_ > 1)
            fail_at(file_, line_of(mark, 1),
                    "the file must hold one map of keys and values; it ends before here");
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
    void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}

  private:
    const std::filesystem::path& file_;
    int begun_ = 0;
};

/// Text in which OpenCV's first line is a comment, with UTF-8's byte order mark left out.
std::string as_yaml(std::string text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF", opencv = "%YAML:1.0";
    if (text.starts_with(mark)) text.erase(0, mark.size());
    if (text.starts_with(opencv)) text.front() = '#';
    return text;
}

YAML::Node load_document(const std::string& text, const std::filesystem::path& file) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    for (OneDocument check(file); parser.HandleNextDocument(check);) {
    }
    return YAML::Load(text);
}

/// A plain scalar; quotes make text of a number.
bool is_plain_scalar(const YAML::Node& node) {
    return node.IsScalar() && node.Tag() != "!";
}

}  // namespace

YamlValue YamlValue::load(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw InputError(fmt::format("{}: is a folder; a YAML file is needed", file.string()));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be opened", file.string()));
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    return parse(text, file);
}

YamlValue YamlValue::parse(const std::string& text, const std::filesystem::path& file) {
    demand_text(text, file);
    try {
        const YAML::Node document = load_document(as_yaml(text), file);
        if (!document.IsMap()) fail_at(file, 1, "the file must hold keys and values (key: value)");
        StructureCheck(file, text.size()).visit(document, 1);
        return YamlValue(std::make_shared<const Impl>(Impl{document, file, "", 1}));
    } catch (const YAML::Exception& error) {
        fail_at(file, line_of(error.mark, 1), fmt::format("not YAML: {}", error.msg));
    }
}

YamlValue YamlValue::at(std::string_view key) const {
    if (auto value = find(key)) return *std::move(value);
    const std::string unit = unit_of_key(key);
    fail_at(impl_->file, impl_->line,
            fmt::format("{}: missing: this key must be given{}", impl_->child_path(key),
                        unit.empty() ? "" : fmt::format(", in {}", unit)));
}

std::optional<YamlValue> YamlValue::find(std::string_view key) const {
    if (!is_map()) fail("must be a map of keys and values");
    for (const auto& entry : impl_->node)
        if (entry.first.Scalar() == key)
            return YamlValue(
                std::make_shared<const Impl>(Impl{entry.second, impl_->file, impl_->child_path(key),
                                                  line_of(entry.first.Mark(), impl_->line)}));
    return std::nullopt;
}

bool YamlValue::is_map() const {
    return impl_->node.IsMap();
}
bool YamlValue::is_list() const {
    return impl_->node.IsSequence();
}
bool YamlValue::is_scalar() const {
    return impl_->node.IsScalar();
}

void YamlValue::allow_only(std::initializer_list<std::string_view> keys) const {
    const std::vector<std::string> given = this->keys();
    const auto is_known = [&](const std::string& key) {
        return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    const auto unknown = std::find_if_not(given.begin(), given.end(), is_known);
    if (unknown == given.end()) return;
    const auto known = static_cast<std::size_t>(std::count_if(given.begin(), given.end(), is_known));
    const bool is_of_this_kind = !impl_->path.empty() || 2 * known >= given.size();
    const std::vector<std::string_view> allowed(keys.begin(), keys.end());
    at(*unknown).fail(is_of_this_kind
                          ? explain_unknown_key(*unknown, allowed)
                          : fmt::format("unknown key; allowed here: {}", fmt::join(allowed, ", ")));
}

std::vector<YamlValue> YamlValue::items() const {
    if (!is_list()) fail("must be a list");
    std::vector<YamlValue> result;
    result.reserve(impl_->node.size());
    for (const auto& item : impl_->node)
        result.push_back(YamlValue(std::make_shared<const Impl>(
            // NOLINTNEXTLINE(cppcoreguidelines-slicing): yaml-cpp's iterator hands out nodes like this
            Impl{item, impl_->file, fmt::format("{}[{}]", impl_->path, result.size()),
                 line_of(item.Mark(), impl_->line)})));
    return result;
}

std::vector<std::string> YamlValue::keys() const {
    if (!is_map()) fail("must be a map of keys and values");
    std::vector<std::string> result;
    for (const auto& entry : impl_->node) result.push_back(entry.first.Scalar());
    return result;
}

double YamlValue::number(const NumberRange& range) const {
    const std::string unit = unit_of_key(impl_->key());
    const std::string in_unit = unit.empty() ? "" : " in " + unit;
    double value = 0.0;
    if (!is_plain_scalar(impl_->node) || !parse_all(impl_->node.Scalar(), value) || !std::isfinite(value))
        fail(fmt::format("must be a number{}{}{}", in_unit, allowed_numbers(range),
                         unit.empty() ? "" : "; the unit stands in the key alone"));
    if (value < range.low || value > range.high || (range.open_low && value == range.low))
        fail(fmt::format("must be a number{}{}", in_unit, allowed_numbers(range)));
    return value;
}

int YamlValue::integer(int low, int high) const {
    int value = 0;
    if (!is_plain_scalar(impl_->node) || !parse_all(impl_->node.Scalar(), value) || value < low ||
        value > high)
        fail(fmt::format("must be a whole number from {} to {}", low, high));
    return value;
}

std::int64_t YamlValue::whole_number() const {
    std::int64_t value = 0;
    if (!is_plain_scalar(impl_->node) || !parse_all(impl_->node.Scalar(), value))
        fail("must be a whole number");
    return value;
}

bool YamlValue::boolean() const {
    if (is_plain_scalar(impl_->node)) {
        if (impl_->node.Scalar() == "true") return true;
        if (impl_->node.Scalar() == "false") return false;
    }
    fail("must be true or false");
}

std::string YamlValue::text() const {
    if (!is_scalar() || impl_->node.Scalar().empty()) fail("must be text");
    return impl_->node.Scalar();
}

std::string YamlValue::text_or_empty() const {
    const bool is_empty = impl_->node.IsNull() || (is_scalar() && impl_->node.Scalar().empty());
    return is_empty ? "" : text();
}

std::size_t YamlValue::one_of(std::initializer_list<std::string_view> words) const {
    const auto found =
        is_scalar() ? std::find(words.begin(), words.end(), impl_->node.Scalar()) : words.end();
    if (found == words.end()) fail(fmt::format("must be one of: {}", fmt::join(words, ", ")));
    return static_cast<std::size_t>(found - words.begin());
}

std::vector<double> YamlValue::numbers(std::size_t count, const NumberRange& range) const {
    const std::string unit = unit_of_key(impl_->key());
    if (!is_list() || impl_->node.size() != count)
        fail(fmt::format("must be a list of {} numbers{}", count, unit.empty() ? "" : " in " + unit));
    std::vector<double> result;
    for (const YamlValue& item : items()) result.push_back(item.number(range));
    return result;
}

std::filesystem::path YamlValue::file() const {
    return (impl_->file.parent_path() / text()).lexically_normal();
}

const std::filesystem::path& YamlValue::source() const {
    return impl_->file;
}

std::string YamlValue::place() const {
    return fmt::format("{}:{}: {}", impl_->file.string(), impl_->line, impl_->path);
}

void YamlValue::fail(std::string_view message) const {
    const std::string where = impl_->path.empty() ? "" : impl_->path + ": ";
    fail_at(impl_->file, impl_->line, fmt::format("{}{}: {}", where, shown(impl_->node), message));
}

}  // namespace fidservo

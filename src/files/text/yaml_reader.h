// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strict reading of YAML: every mistake is an InputError that names file, line, key, value and what is
// allowed. Unknown keys are mistakes too.
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

/// Allowed range of a number, both ends included unless `open_low`.
struct NumberRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool open_low = false;
};

inline constexpr NumberRange any_number{};
inline constexpr NumberRange positive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr NumberRange not_negative{0.0, std::numeric_limits<double>::infinity(), false};

/// A value somewhere in a YAML file. Remembers its file and its path, e.g. "macro.dead_zone.slope".
class YamlValue {
  public:
    /// Reads and parses a file; the root must be a map. OpenCV's first line "%YAML:1.0", which is no YAML, is
    /// passed over.
    static YamlValue load(const std::filesystem::path& file);
    /// The same from text, for tests and fuzzing; `file` only appears in messages.
    static YamlValue parse(const std::string& text, const std::filesystem::path& file);

    YamlValue at(std::string_view key) const;  ///< the key must exist
    std::optional<YamlValue> find(std::string_view key) const;
    bool is_map() const;
    bool is_list() const;
    bool is_scalar() const;
    /// Throws if this is not a map, or if it has a key that is not in the list. Call it once for every map. A
    /// key that was probably meant is only named where most of a file's keys are known: else it is a file of
    /// another kind.
    void allow_only(std::initializer_list<std::string_view> keys) const;

    std::vector<YamlValue> items() const;   ///< of a list
    std::vector<std::string> keys() const;  ///< of a map
    double number(const NumberRange& range = any_number) const;
    int integer(int low, int high) const;
    std::int64_t whole_number() const;  ///< any 64-bit integer
    bool boolean() const;
    std::string text() const;
    std::string text_or_empty() const;  ///< the same, or empty where "" or nothing is given
    /// A word out of a list; the result is its index.
    std::size_t one_of(std::initializer_list<std::string_view> words) const;
    std::vector<double> numbers(std::size_t count, const NumberRange& range = any_number) const;
    /// A path relative to the folder of this file.
    std::filesystem::path file() const;

    const std::filesystem::path& source() const;  ///< the file that this is read from

    std::string place() const;  ///< "FILE:LINE: KEY"

    /// Throws InputError "FILE:LINE: KEY: VALUE: message".
    [[noreturn]] void fail(std::string_view message) const;

  private:
    struct Impl;
    explicit YamlValue(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<const Impl> impl_;
};

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <utility>

namespace fidservo {

namespace {

constexpr std::size_t digits_of_ns_since_1970 = 19, digits_of_us_since_1970 = 16,
                      digits_of_ms_since_1970 = 13, digits_of_s_since_1970 = 10;

constexpr std::array<std::pair<std::string_view, NameTimes>, 6> words_of_name_times{
    {{"", NameTimes::automatic},
     {"none", NameTimes::none},
     {"s", NameTimes::s},
     {"ms", NameTimes::ms},
     {"us", NameTimes::us},
     {"ns", NameTimes::ns}}};

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

bool is_number_of(std::string_view text, std::size_t digits) {
    return text.size() == digits && std::ranges::all_of(text, is_digit);
}

bool has_ending(const std::filesystem::path& file, const std::vector<std::string_view>& endings) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return std::ranges::find(endings, ending) != endings.end();
}

TimeNs ns_of(NameTimes unit) {
    switch (unit) {
        case NameTimes::s:
            return ns_per_s;
        case NameTimes::ms:
            return ns_per_ms;
        case NameTimes::us:
            return ns_per_ms / 1000;
        default:
            return 1;
    }
}

/// The digits at `at` as a number, without leading zeros.
std::string_view take_number(std::string_view text, std::size_t& at) {
    while (at < text.size() && text[at] == '0') ++at;
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return text.substr(begin, at - begin);
}

}  // namespace

std::optional<NameTimes> name_times_of(std::string_view word) {
    const auto known =
        std::ranges::find(words_of_name_times, word, [](const auto& one) { return one.first; });
    if (known == words_of_name_times.end()) return std::nullopt;
    return known->second;
}

std::string_view word_for(NameTimes unit) {
    return std::ranges::find(words_of_name_times, unit, [](const auto& one) { return one.second; })->first;
}

const std::vector<std::string_view>& image_endings() {
    static const std::vector<std::string_view> endings{
        ".png", ".jpg", ".jpeg", ".jpe", ".tif", ".tiff", ".btf", ".tf8", ".bmp", ".dib", ".webp", ".pgm",
        ".ppm", ".pbm", ".pnm",  ".pam", ".jp2", ".j2k",  ".ras", ".sr",  ".pfm", ".hdr", ".pic",  ".exr"};
    return endings;
}

const std::vector<std::string_view>& video_endings() {
    static const std::vector<std::string_view> endings{
        ".mp4",  ".m4v", ".avi",  ".mkv", ".mov", ".webm", ".mjpg", ".mjpeg", ".mpg",  ".mpeg",
        ".ts",   ".mts", ".m2ts", ".wmv", ".asf", ".flv",  ".ogv",  ".3gp",   ".h264", ".264",
        ".h265", ".265", ".hevc", ".y4m", ".ivf", ".mxf",  ".nut",  ".vob",   ".dv"};
    return endings;
}

bool is_named_as_image(const std::filesystem::path& file) {
    return has_ending(file, image_endings());
}

bool is_named_as_video(const std::filesystem::path& file) {
    return has_ending(file, video_endings());
}

bool natural_less(std::string_view a, std::string_view b) {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() && j < b.size()) {
        if (!is_digit(a[i]) || !is_digit(b[j])) {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
            continue;
        }
        const std::string_view m = take_number(a, i);
        const std::string_view n = take_number(b, j);
        if (m.size() != n.size()) return m.size() < n.size();
        if (m != n) return m < n;
    }
    if (i < a.size() || j < b.size()) return i == a.size() && j < b.size();
    return a < b;  // they differ in leading zeros at most
}

std::optional<TimeNs> time_in_name(std::string_view stem, NameTimes unit) {
    constexpr TimeNs most = std::numeric_limits<TimeNs>::max();
    const TimeNs unit_ns = ns_of(unit);
    const std::size_t dot = stem.find('.');
    const std::string_view whole = stem.substr(0, dot);
    if (whole.empty() || !std::ranges::all_of(whole, is_digit)) return std::nullopt;
    TimeNs time_ns = 0;
    for (const char letter : whole) {
        const TimeNs digit = letter - '0';
        if (time_ns > (most - digit) / 10) return std::nullopt;
        time_ns = 10 * time_ns + digit;
    }
    if (time_ns > most / unit_ns) return std::nullopt;
    time_ns *= unit_ns;
    if (dot == std::string_view::npos) return time_ns;
    const std::string_view fraction = stem.substr(dot + 1);
    if (unit_ns == 1 || fraction.empty() || !std::ranges::all_of(fraction, is_digit)) return std::nullopt;
    TimeNs fraction_ns = 0;
    TimeNs place_ns = unit_ns;
    for (const char digit : fraction) {
        place_ns /= 10;
        fraction_ns += (digit - '0') * place_ns;
    }
    if (time_ns > most - fraction_ns) return std::nullopt;
    return time_ns + fraction_ns;
}

NameTimes names_unit(const std::vector<std::string>& stems) {
    const auto in_seconds = [](const std::string& stem) {
        return stem.size() > digits_of_s_since_1970 + 1 && stem[digits_of_s_since_1970] == '.' &&
               stem.front() != '0' && time_in_name(stem, NameTimes::s);
    };
    const auto in_nanoseconds = [](const std::string& stem) {
        return is_number_of(stem, digits_of_ns_since_1970) && stem.front() != '0' &&
               time_in_name(stem, NameTimes::ns);
    };
    if (stems.empty()) return NameTimes::none;
    if (std::ranges::all_of(stems, in_nanoseconds)) return NameTimes::ns;
    if (std::ranges::all_of(stems, in_seconds)) return NameTimes::s;
    return NameTimes::none;
}

bool could_be_times(const std::vector<std::string>& stems) {
    const auto all_of = [&](std::size_t digits) {
        return std::ranges::all_of(stems, [&](const std::string& stem) {
            return is_number_of(stem, digits) && stem.front() != '0';
        });
    };
    return !stems.empty() && (all_of(digits_of_ms_since_1970) || all_of(digits_of_us_since_1970));
}

}  // namespace fidservo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/log.h"
#include "src/import/module/mat_objects.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

namespace fidservo::imports {
namespace {

constexpr std::size_t header_bytes = 128, tag_bytes = 8;
constexpr std::size_t looked_at = 2048;  ///< the beginning of each element, which describes it
/// Of an element: the numbers that are read from one file, and what describes them.
constexpr std::uint64_t most_element_bytes = most_values * sizeof(double) + (std::uint64_t{1} << 20U);
constexpr std::uint32_t matrix_element = 14, compressed_element = 15, opaque_class = 17;

struct Tag {
    std::uint32_t type = 0, bytes = 0;
    std::size_t data = 0, next = 0;  ///< offsets
};

/// The elements inside of a variable's beginning.
class Elements {
  public:
    Elements(std::string_view bytes, bool is_swapped) : bytes_(bytes), is_swapped_(is_swapped) {}

    std::uint32_t number(std::size_t at) const {
        std::uint32_t value = 0;
        if (at + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + at, sizeof value);
        return is_swapped_ ? __builtin_bswap32(value) : value;
    }
    /// Elements of up to four bytes have their data in the tag.
    std::optional<Tag> tag(std::size_t at) const {
        if (at + tag_bytes > bytes_.size()) return std::nullopt;
        constexpr std::uint32_t half = 16, low_half = 0xFFFF, most_in_tag = 4;
        const std::uint32_t first = number(at);
        if (first >> half != 0) {
            if (first >> half > most_in_tag) return std::nullopt;
            return Tag{first & low_half, first >> half, at + 4, at + tag_bytes};
        }
        const std::uint32_t bytes = number(at + 4);
        const std::size_t padded = (std::size_t{bytes} + tag_bytes - 1) / tag_bytes * tag_bytes;
        return Tag{first, bytes, at + tag_bytes, at + tag_bytes + padded};
    }
    std::string text(const Tag& tag) const {
        return std::string(bytes_.substr(std::min(bytes_.size(), tag.data), tag.bytes));
    }

  private:
    std::string_view bytes_;
    bool is_swapped_;
};

/// A compressed element.
struct Inflated {
    std::string beginning{};
    std::uint64_t bytes = 0;
    std::string damage{};
};

/// Decompresses count bytes at the stream's place to their end, which has the checksum, or to the largest
/// size that is read.
Inflated inflate_to_end(std::istream& from, std::size_t count) {
    constexpr std::size_t chunk = std::size_t{1} << 16U;
    constexpr std::size_t most_padding = tag_bytes - 1;
    Inflated made;
    z_stream zlib{};
    if (inflateInit(&zlib) != Z_OK) return {.damage = "zlib cannot begin"};
    std::vector<char> in(chunk), out(chunk);
    int state = Z_OK;
    while (state == Z_OK && made.bytes <= most_element_bytes) {
        if (zlib.avail_in == 0 && count > 0) {
            const std::size_t part = std::min(count, chunk);
            if (!from.read(in.data(), static_cast<std::streamsize>(part))) break;
            count -= part;
            zlib.next_in = reinterpret_cast<Bytef*>(in.data());
            zlib.avail_in = static_cast<uInt>(part);
        }
        zlib.next_out = reinterpret_cast<Bytef*>(out.data());
        zlib.avail_out = static_cast<uInt>(out.size());
        state = inflate(&zlib, Z_NO_FLUSH);
        const std::size_t given = out.size() - zlib.avail_out;
        if (made.beginning.size() < looked_at)
            made.beginning.append(out.data(), std::min(given, looked_at - made.beginning.size()));
        made.bytes += given;
    }
    if (state == Z_STREAM_END && count + zlib.avail_in > most_padding)
        made.damage = "they end before the element does";
    else if (state != Z_STREAM_END && made.bytes <= most_element_bytes)
        made.damage = zlib.msg != nullptr ? zlib.msg : "they break off";
    inflateEnd(&zlib);
    return made;
}

/// What a matrix element begins with.
struct Described {
    std::uint32_t matlab_class = 0;
    std::string name{};
    std::string object_class{};  ///< of MATLAB's objects
};

/// Of a matrix element whose tag is at 0: flags, dimensions and name; of objects flags, name, type system,
/// class.
Described described(const Elements& elements) {
    constexpr std::size_t flags_element = 2 * tag_bytes;
    constexpr std::uint32_t class_mask = 0xFF;
    if (elements.number(0) != matrix_element) return {};
    Described made{.matlab_class = elements.number(flags_element) & class_mask};
    std::size_t at = flags_element + tag_bytes;
    std::array<std::string, 3> texts;
    for (std::string& text : texts) {
        const auto tag = elements.tag(at);
        if (!tag) break;
        text = elements.text(*tag);
        at = tag->next;
    }
    const bool is_object = made.matlab_class == opaque_class;
    made.name = texts[is_object ? 0 : 1];
    if (is_object) made.object_class = texts[2];
    return made;
}

void note_variable(const Described& variable, std::uint64_t bytes, MatContents& contents) {
    if (variable.name.empty()) return;
    if (variable.matlab_class == opaque_class)
        contents.faults[variable.name] = advice_on_object(variable.name, variable.object_class);
    else if (bytes > most_element_bytes)
        contents.faults[variable.name] = fmt::format(
            "is passed over: it has more than the {} numbers that are read from one file", most_values);
    else
        contents.variables.push_back(variable.name);
}

}  // namespace

MatContents look_into_mat5(const char* file) {
    std::ifstream stream(file, std::ios::binary);
    MatContents contents;
    stream.seekg(0, std::ios::end);
    const auto size = static_cast<std::size_t>(std::max<std::streamoff>(0, stream.tellg()));
    const auto read_at = [&](std::size_t at, std::size_t count) {
        std::string bytes(std::min(count, size - at), '\0');
        stream.clear();
        stream.seekg(static_cast<std::streamoff>(at));
        stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return bytes;
    };
    if (size < header_bytes) return {.damage = "breaks off in its header"};
    const bool is_swapped = read_at(header_bytes - 2, 2) != "IM";
    int element = 1;
    for (std::size_t at = header_bytes; at < size; ++element) {
        std::string beginning = read_at(at, looked_at);
        const auto tag = Elements(beginning, is_swapped).tag(0);
        if (!tag || std::size_t{tag->bytes} > size - at - tag_bytes)
            return {.damage =
                        fmt::format("breaks off: its element {} has more bytes than the file", element)};
        if (tag->type != matrix_element && tag->type != compressed_element)
            return {.damage =
                        fmt::format("is damaged: its element {} is of type {}; only {} and {}, variables "
                                    "and compressed ones, are there in a MAT file",
                                    element, tag->type, matrix_element, compressed_element)};
        std::uint64_t bytes = tag->bytes;
        if (tag->type == compressed_element) {
            stream.clear();
            stream.seekg(static_cast<std::streamoff>(at + tag_bytes));
            Inflated inflated = inflate_to_end(stream, tag->bytes);
            if (!inflated.damage.empty())
                return {.damage = fmt::format("is damaged: the compressed data of its element {} do not pass "
                                              "their check: {}",
                                              element, inflated.damage)};
            beginning = std::move(inflated.beginning);
            bytes = inflated.bytes;
        }
        note_variable(described(Elements(beginning, is_swapped)), bytes, contents);
        at += tag_bytes + tag->bytes;
    }
    return contents;
}

std::string advice_on_object(const std::string& variable, const std::string& matlab_class) {
    struct Advice {
        std::string_view matlab_class, line;
        std::string_view what =
            "is an object of MATLAB's class {}, which only MATLAB reads; save it there by";
    };
    constexpr std::array lines{
        Advice{"timetable",
               "s = timetable2table({0}); s.(1) = seconds({0}.Properties.RowTimes); s = table2struct(s, "
               "'ToScalar', true); save('numbers.mat', 's', '-v7')"},
        Advice{"table", "s = table2struct({0}, 'ToScalar', true); save('numbers.mat', 's', '-v7')"},
        Advice{"timeseries",
               "s = struct('time', {0}.Time, 'data', {0}.Data); save('numbers.mat', 's', '-v7')"},
        Advice{"string", "s = char({0}); save('numbers.mat', 's', '-v7')"},
        Advice{"datetime", "t = posixtime({0}); save('numbers.mat', 't', '-v7')"},
        Advice{"duration", "t = seconds({0}); save('numbers.mat', 't', '-v7')"},
        Advice{"Simulink.SimulationData.Dataset",
               "v = {0}{{1}}.Values; s = struct('time', v.Time, 'data', v.Data); save('numbers.mat', 's', "
               "'-v7')"},
        Advice{"Simulink.SimulationOutput",
               "t = {0}.tout; y = {0}.yout; save('numbers.mat', 't', 'y', '-v7'), with the model's output "
               "format Array or Structure with time"},
        Advice{"sparse", "s = full({0}); save('numbers.mat', 's', '-v7')",
               "is a {} matrix, which is not read; save it in MATLAB as a full one by"},
        Advice{"function_handle", "y = {0}(t); save('numbers.mat', 't', 'y', '-v7')",
               "is a {}, which holds no numbers; save its values at times t in MATLAB by"}};
    constexpr Advice other{"", "s = struct({0}); save('numbers.mat', 's', '-v7')"};
    const auto known = std::ranges::find(lines, matlab_class, &Advice::matlab_class);
    const Advice& advice = known != lines.end() ? *known : other;
    return fmt::format("{}: {}",
                       fmt::format(fmt::runtime(advice.what), matlab_class.empty() ? "?" : matlab_class),
                       fmt::format(fmt::runtime(advice.line), variable));
}

}  // namespace fidservo::imports

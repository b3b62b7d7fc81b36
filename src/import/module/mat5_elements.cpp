// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/mat_objects.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

namespace fidservo::imports {
namespace {

constexpr std::size_t header_bytes = 128, tag_bytes = 8;
constexpr std::size_t looked_at = 2048;  ///< of each element
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

std::string inflated(const std::string& bytes) {
    std::string out(looked_at, '\0');
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return {};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    inflate(&stream, Z_SYNC_FLUSH);
    out.resize(out.size() - stream.avail_out);
    inflateEnd(&stream);
    return out;
}

/// Of a matrix element whose tag is at 0: flags, name, type system, class.
void note_object(const Elements& elements, MatContents& contents) {
    constexpr std::size_t flags_element = 2 * tag_bytes;
    constexpr std::uint32_t class_mask = 0xFF;
    if (elements.number(0) != matrix_element || (elements.number(flags_element) & class_mask) != opaque_class)
        return;
    std::size_t at = flags_element + tag_bytes;
    std::array<std::string, 3> texts;
    for (std::string& text : texts) {
        const auto tag = elements.tag(at);
        if (!tag) return;
        text = elements.text(*tag);
        at = tag->next;
    }
    if (!texts[0].empty()) contents.objects[texts[0]] = texts[2];
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
    if (size < header_bytes) return {.objects = {}, .damage = "breaks off in its header"};
    const bool is_swapped = read_at(header_bytes - 2, 2) != "IM";
    int element = 1;
    for (std::size_t at = header_bytes; at < size; ++element) {
        const std::string beginning = read_at(at, looked_at);
        const auto tag = Elements(beginning, is_swapped).tag(0);
        if (!tag || std::size_t{tag->bytes} > size - at - tag_bytes) {
            contents.damage = fmt::format("breaks off: its element {} has more bytes than the file", element);
            return contents;
        }
        if (tag->type == compressed_element) {
            const std::string data =
                inflated(read_at(at + tag_bytes, std::min<std::size_t>(tag->bytes, looked_at)));
            note_object(Elements(data, is_swapped), contents);
        } else {
            note_object(Elements(beginning, is_swapped), contents);
        }
        at += tag_bytes + tag->bytes;
    }
    return contents;
}

std::string advice_on_object(const std::string& variable, const std::string& matlab_class) {
    struct Advice {
        std::string_view matlab_class, line;
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
               "format Array or Structure with time"}};
    const auto known = std::ranges::find(lines, matlab_class, &Advice::matlab_class);
    const std::string line = known != lines.end()
                                 ? fmt::format(fmt::runtime(known->line), variable)
                                 : fmt::format("s = struct({}); save('numbers.mat', 's', '-v7')", variable);
    return fmt::format("is an object of MATLAB's class {}, which only MATLAB reads; save it there by: {}",
                       matlab_class.empty() ? "?" : matlab_class, line);
}

}  // namespace fidservo::imports

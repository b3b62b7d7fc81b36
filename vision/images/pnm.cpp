// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/pnm.h"

#include "core/failure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace fidservo::vision {
namespace {

constexpr std::uint32_t most_in_a_byte = 255, most_in_two_bytes = 65535;

tl::unexpected<Failure> damaged_pnm(const std::string& why) {
    return failure(Reason::device, why);
}

bool is_white_space(char letter) {
    return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

bool is_decimal_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

/// Reads numbers as netpbm does: a comment, from # to the end of its line, stands for that end.
class NetpbmText {
  public:
    NetpbmText(std::string_view file, std::size_t at) : file_(file), at_(at) {}

    std::optional<char> next_letter() {
        if (at_ >= file_.size()) return std::nullopt;
        const char letter = file_[at_++];
        if (letter != '#') return letter;
        while (at_ < file_.size() && file_[at_] != '\n' && file_[at_] != '\r') ++at_;
        if (at_ < file_.size()) ++at_;
        return '\n';
    }

    std::optional<char> next_solid_letter() {
        auto letter = next_letter();
        while (letter && is_white_space(*letter)) letter = next_letter();
        return letter;
    }

    /// A whole number and the one letter behind it; empty if something else stands there, or nothing.
    std::optional<std::uint32_t> number() {
        constexpr std::uint32_t enough = 100'000'000;
        auto letter = next_solid_letter();
        if (!letter || !is_decimal_digit(*letter)) return std::nullopt;
        std::uint32_t value = 0;
        for (; letter && is_decimal_digit(*letter); letter = next_letter()) {
            if (value >= enough) return std::nullopt;
            value = 10 * value + static_cast<std::uint32_t>(*letter - '0');
        }
        if (letter && !is_white_space(*letter)) return std::nullopt;
        return value;
    }

    std::string_view line() {
        const std::size_t begin = at_, end = std::min(file_.size(), file_.find('\n', at_));
        at_ = std::min(file_.size(), end + 1);
        return file_.substr(begin, end - begin);
    }

    std::size_t place() const { return at_; }

  private:
    std::string_view file_;
    std::size_t at_;
};

struct PnmHeader {
    std::uint32_t width = 0, height = 0, depth = 1, largest = 1;
    bool is_text = false, is_bitmap = false, is_colour = false;
    std::size_t end = 0;

    std::size_t samples_in_a_row() const { return std::size_t{width} * depth; }
    std::size_t bytes_a_sample() const { return largest > most_in_a_byte ? 2 : 1; }
    /// Of pixels that are not text.
    std::size_t bytes_in_a_row() const {
        return is_bitmap ? (std::size_t{width} + 7) / 8 : samples_in_a_row() * bytes_a_sample();
    }
};

/// What the samples of a pixel are.
struct TupleType {
    std::string_view name;
    bool is_colour;
    std::uint32_t least_depth;
    bool has_two_levels;
};

constexpr std::array<TupleType, 6> tuple_types{{{"BLACKANDWHITE", false, 1, true},
                                                {"GRAYSCALE", false, 1, false},
                                                {"RGB", true, 3, false},
                                                {"BLACKANDWHITE_ALPHA", false, 2, true},
                                                {"GRAYSCALE_ALPHA", false, 2, false},
                                                {"RGB_ALPHA", true, 4, false}}};

std::string_view stripped(std::string_view text) {
    while (!text.empty() && is_white_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_white_space(text.back())) text.remove_suffix(1);
    return text;
}

/// Decides by the tuple type which samples of a pixel are read.
Status take_tuple_type(const std::optional<std::string>& name, PnmHeader& header) {
    if (!name && header.depth != 1 && header.depth != 3)
        return damaged_pnm(
            fmt::format("DEPTH {} without a TUPLTYPE: 1 (grey) or 3 (RGB) is read", header.depth));
    header.is_colour = header.depth == 3;
    if (!name) return {};
    const auto* type = std::ranges::find(tuple_types, *name, &TupleType::name);
    if (type == tuple_types.end())
        return damaged_pnm(
            fmt::format("TUPLTYPE {}: what is read is BLACKANDWHITE, GRAYSCALE or RGB, each also "
                        "with _ALPHA",
                        *name));
    if (header.depth < type->least_depth)
        return damaged_pnm(fmt::format("TUPLTYPE {} with DEPTH {}: it must be {} at least", *name,
                                       header.depth, type->least_depth));
    if (type->has_two_levels && header.largest != 1)
        return damaged_pnm(fmt::format("TUPLTYPE {} with MAXVAL {}: it must be 1", *name, header.largest));
    header.is_colour = type->is_colour;
    return {};
}

Result<PnmHeader> pam_header(std::string_view file) {
    NetpbmText text(file, 0);
    if (stripped(text.line()) != "P7")
        return damaged_pnm("its header is damaged: its first line is not P7 alone");
    struct Key {
        std::string_view name;
        std::optional<std::uint32_t> value{};
    };
    std::array<Key, 4> keys{{{"WIDTH"}, {"HEIGHT"}, {"DEPTH"}, {"MAXVAL"}}};
    std::optional<std::string> type;
    while (true) {
        if (text.place() == file.size()) return damaged_pnm("cut short: its header has no line ENDHDR");
        const std::string_view line = stripped(text.line());
        if (line == "ENDHDR") break;
        if (line.empty() || line.front() == '#') continue;
        const std::size_t space = std::min(line.size(), line.find_first_of(" \t"));
        const std::string_view name = line.substr(0, space), value = stripped(line.substr(space));
        if (name == "TUPLTYPE") {
            type = type ? fmt::format("{} {}", *type, value) : std::string(value);
            continue;
        }
        const auto* key = std::ranges::find(keys, name, &Key::name);
        if (key == keys.end())
            return damaged_pnm(
                fmt::format("its header is damaged: it has a line {} beside WIDTH, HEIGHT, DEPTH, MAXVAL and "
                            "TUPLTYPE",
                            name.substr(0, 20)));
        auto& held = keys[static_cast<std::size_t>(key - keys.begin())].value;
        if (held) return damaged_pnm(fmt::format("its header is damaged: {} stands in it twice", name));
        held = NetpbmText(value, 0).number();
        if (!held) return damaged_pnm(fmt::format("its header is damaged: {} is no whole number", name));
    }
    for (const Key& key : keys)
        if (!key.value) return damaged_pnm(fmt::format("its header is damaged: it has no {}", key.name));
    PnmHeader header{.width = *keys[0].value,
                     .height = *keys[1].value,
                     .depth = *keys[2].value,
                     .largest = *keys[3].value,
                     .end = text.place()};
    if (const Status known = take_tuple_type(type, header); !known) return tl::make_unexpected(known.error());
    return header;
}

Result<PnmHeader> pnm_header(std::string_view file) {
    if (file[1] == '7') return pam_header(file);
    const char kind = file[1];
    PnmHeader header;
    header.is_text = kind <= '3';
    header.is_bitmap = kind == '1' || kind == '4';
    header.is_colour = kind == '3' || kind == '6';
    header.depth = header.is_colour ? 3 : 1;
    NetpbmText text(file, 2);
    const auto width = text.number(), height = text.number();
    const auto largest = header.is_bitmap ? std::optional<std::uint32_t>(1) : text.number();
    if (!width || !height || !largest)
        return damaged_pnm(fmt::format("its header is damaged: it must give width{} as whole numbers",
                                       header.is_bitmap ? " and height" : ", height and the largest sample"));
    header.width = *width;
    header.height = *height;
    header.largest = *largest;
    header.end = text.place();
    if (!header.is_text && file[header.end - 1] == '\r' && header.end < file.size() &&
        file[header.end] == '\n')
        return damaged_pnm("its header is damaged: it ends in CR LF where one blank is to stand");
    return header;
}

Status demand_sound(const PnmHeader& header) {
    if (header.width == 0 || header.height == 0) return damaged_pnm("its header is damaged: a side is 0");
    if (const Status readable = demand_readable_size(header.width, header.height); !readable) return readable;
    constexpr std::uint32_t most_depth = 65535;
    if (header.depth == 0 || header.depth > most_depth)
        return damaged_pnm(fmt::format("DEPTH {}: it must be 1 to {}", header.depth, most_depth));
    if (header.largest == 0 || header.largest > most_in_two_bytes)
        return damaged_pnm(
            fmt::format("its largest sample is {}: it must be 1 to {}", header.largest, most_in_two_bytes));
    return {};
}

/// The rows of samples of a picture, from its bytes or its text.
class NetpbmRows {
  public:
    NetpbmRows(std::string_view file, const PnmHeader& header)
        : file_(file), header_(header), text_(file, header.end), row_(header.samples_in_a_row()) {}

    /// The next row; a failure if it is not there or has a sample above the largest one.
    Result<const std::vector<std::uint16_t>*> next() {
        const bool whole = header_.is_text ? take_text() : take_bytes();
        if (!whole)
            return damaged_pnm(
                fmt::format("cut short or damaged: row {} has no number for each of its samples", rows_));
        if (const auto most = std::ranges::max(row_); most > header_.largest)
            return damaged_pnm(
                fmt::format("damaged: row {} has a sample of {}, above the largest of {} that its "
                            "header states",
                            rows_, most, header_.largest));
        ++rows_;
        return &row_;
    }

  private:
    bool take_text() {
        for (std::uint16_t& sample : row_) {
            if (header_.is_bitmap) {
                const auto letter = text_.next_solid_letter();
                if (!letter || (*letter != '0' && *letter != '1')) return false;
                sample = *letter == '0' ? 1 : 0;  // 1 is black
            } else {
                const auto number = text_.number();
                if (!number) return false;
                sample = static_cast<std::uint16_t>(std::min(*number, most_in_two_bytes));
            }
        }
        return true;
    }

    bool take_bytes() {
        const std::size_t begin = header_.end + rows_ * header_.bytes_in_a_row();
        const auto byte = [&](std::size_t k) {
            return static_cast<std::uint32_t>(static_cast<unsigned char>(file_[begin + k]));
        };
        for (std::size_t k = 0; k < row_.size(); ++k) {
            if (header_.is_bitmap)
                row_[k] = (byte(k / 8) >> (7 - k % 8) & 1U) == 0 ? 1 : 0;
            else if (header_.bytes_a_sample() == 1)
                row_[k] = static_cast<std::uint16_t>(byte(k));
            else
                row_[k] = static_cast<std::uint16_t>(byte(2 * k) << 8U | byte(2 * k + 1));
        }
        return true;
    }

    std::string_view file_;
    const PnmHeader& header_;
    NetpbmText text_;
    std::vector<std::uint16_t> row_;
    std::size_t rows_ = 0;
};

/// Scales samples so that the largest becomes `white`, and colours to luma.
template <class Sample>
void put_grey(const std::vector<std::uint16_t>& row, const PnmHeader& header, std::uint32_t white,
              Sample* to) {
    constexpr std::uint64_t red = 4899, green = 9617, blue = 1868, all = 16384;  // ITU-R BT.601
    const auto level = [&](std::size_t k) {
        return (std::uint64_t{row[k]} * white + header.largest / 2) / header.largest;
    };
    for (std::size_t column = 0; column < header.width; ++column) {
        const std::size_t k = column * header.depth;
        to[column] = static_cast<Sample>(
            header.is_colour ? (red * level(k) + green * level(k + 1) + blue * level(k + 2) + all / 2) / all
                             : level(k));
    }
}

/// What follows the pixels of a file that is not text: nothing but blanks, or another picture.
Result<bool> has_another_picture(std::string_view file, const PnmHeader& header) {
    const std::size_t end = header.end + header.height * header.bytes_in_a_row();
    if (file.size() < end)
        return damaged_pnm(fmt::format("cut short: {} bytes where its header says {}", file.size(), end));
    const std::string_view rest = file.substr(end);
    if (stripped(rest).empty()) return false;
    if (is_pnm(std::as_bytes(std::span(rest)))) return true;
    return damaged_pnm(fmt::format("{} bytes where its header says {}", file.size(), end));
}

std::string_view letters_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool is_pnm(std::span<const std::byte> beginning) {
    const std::string_view file = letters_of(beginning);
    return file.size() > 2 && file[0] == 'P' && file[1] >= '1' && file[1] <= '7' &&
           (is_white_space(file[2]) || file[2] == '#');
}

bool is_deep_pnm(std::span<const std::byte> beginning) {
    const auto header = pnm_header(letters_of(beginning));
    return !header || header->largest > most_in_a_byte;
}

Result<StoredImage> decode_pnm(std::span<const std::byte> bytes) {
    const std::string_view file = letters_of(bytes);
    const auto header = pnm_header(file);
    if (!header) return tl::make_unexpected(header.error());
    if (const Status sound = demand_sound(*header); !sound) return tl::make_unexpected(sound.error());
    StoredImage image;
    if (header->is_text) {
        if (header->samples_in_a_row() * header->height > file.size()) return damaged_pnm("cut short");
    } else {
        const auto more = has_another_picture(file, *header);
        if (!more) return tl::make_unexpected(more.error());
        image.has_more_pictures = *more;
    }
    const bool deep = header->largest > most_in_a_byte;
    const int bits = deep ? static_cast<int>(std::bit_width(header->largest)) : 8;
    const std::uint32_t white = (1U << static_cast<unsigned>(bits)) - 1;
    image.grey.create(static_cast<int>(header->height), static_cast<int>(header->width),
                      deep ? CV_16UC1 : CV_8UC1);
    NetpbmRows rows(file, *header);
    for (int line = 0; line < image.grey.rows; ++line) {
        const auto row = rows.next();
        if (!row) return tl::make_unexpected(row.error());
        if (deep)
            put_grey(**row, *header, white, image.grey.ptr<std::uint16_t>(line));
        else
            put_grey(**row, *header, white, image.grey.ptr<unsigned char>(line));
    }
    // Programs that do not know better write the largest number of 16 bits: it states nothing.
    if (deep && header->largest < most_in_two_bytes) image.stated_bits = bits;
    return image;
}

}  // namespace fidservo::vision

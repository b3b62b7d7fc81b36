// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the table of tag families, as C++: write_tag_books FILE.cpp. Run at build time, so that the program
// itself need not load OpenCV's ArUco module.
#include "core/tag_families.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <opencv2/aruco/dictionary.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>
}

namespace {

using fidservo::cell_at;

struct Book {
    std::string name;
    int cells, outline_cells;
    std::string layout;
    std::vector<std::uint64_t> codes;
};

/// The library's own drawing tells the colours; its places of bits, which cells are of the code.
Book book_of(apriltag_family_t* family) {
    const int rim_of_bits =
        -std::min(0, static_cast<int>(*std::min_element(
                         reinterpret_cast<const std::int32_t*>(family->bit_x),
                         reinterpret_cast<const std::int32_t*>(family->bit_x) + family->nbits)));
    const int cells = family->width_at_border + 2 * rim_of_bits;
    Book book{family->name, cells, family->width_at_border, {}, {}};
    const int outside = (family->total_width - cells) / 2;
    const auto place_of_bit = [&](std::uint32_t bit) {
        return (static_cast<int>(family->bit_y[bit]) + rim_of_bits) * cells +
               static_cast<int>(family->bit_x[bit]) + rim_of_bits;
    };
    for (int id = 0; id < static_cast<int>(family->ncodes); ++id) {
        image_u8_t* const drawn = apriltag_to_image(family, id);
        std::string picture;
        for (int row = 0; row < cells; ++row)
            for (int column = 0; column < cells; ++column)
                picture += drawn->buf[(row + outside) * drawn->stride + column + outside] > 127 ? 'w' : 'b';
        std::free(drawn->buf);
        std::free(drawn);
        if (id == 0) {
            book.layout = picture;
            for (std::uint32_t bit = 0; bit < family->nbits; ++bit)
                book.layout[static_cast<std::size_t>(place_of_bit(bit))] = 'd';
        }
        std::uint64_t code = 0;
        for (std::size_t cell = 0; cell < picture.size(); ++cell)
            if (book.layout[cell] == 'd') code = 2 * code + (picture[cell] == 'w' ? 1 : 0);
        book.codes.push_back(code);
    }
    return book;
}

Book book_of(const std::string& name, const cv::aruco::Dictionary& dictionary) {
    const int bits = dictionary.markerSize, cells = bits + 2;
    Book book{name, cells, cells, {}, {}};
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column)
            book.layout += std::min(row, column) == 0 || std::max(row, column) == cells - 1 ? 'b' : 'd';
    for (int id = 0; id < dictionary.bytesList.rows; ++id) {
        const cv::Mat white =
            cv::aruco::Dictionary::getBitsFromByteList(dictionary.bytesList.rowRange(id, id + 1), bits);
        std::uint64_t code = 0;
        for (int row = 0; row < bits; ++row)
            for (int column = 0; column < bits; ++column) code = 2 * code + white.at<uchar>(row, column);
        book.codes.push_back(code);
    }
    return book;
}

/// A code as it reads when the tag is turned by a quarter.
std::uint64_t turned(const Book& book, std::uint64_t code) {
    std::vector<int> place;  // in the code's bits, by cell
    int bits = 0;
    for (const char cell : book.layout) place.push_back(cell == 'd' ? bits++ : -1);
    std::uint64_t out = 0;
    for (int row = 0; row < book.cells; ++row)
        for (int column = 0; column < book.cells; ++column) {
            const int to = place[cell_at(row, column, book.cells)];
            if (to < 0) continue;
            const int from = place[cell_at(book.cells - 1 - column, row, book.cells)];
            out |= ((code >> (bits - 1 - from)) & 1U) << (bits - 1 - to);
        }
    return out;
}

int least_distance(const Book& book) {
    int least = 64;
    for (std::size_t a = 0; a < book.codes.size(); ++a) {
        std::uint64_t code = book.codes[a];
        for (int turn = 0; turn < 4; ++turn) {
            for (std::size_t b = turn == 0 ? a + 1 : a; b < book.codes.size(); ++b)
                least = std::min(least, std::popcount(code ^ book.codes[b]));
            code = turned(book, code);
        }
    }
    return least;
}

void write(std::ofstream& out, const std::vector<Book>& books) {
    out << "#include \"core/tag_families.h\"\n\n#include <array>\n\nnamespace fidservo {\nnamespace {\n";
    for (const Book& book : books) {
        out << "\nconstexpr std::array<std::uint64_t, " << book.codes.size() << "> codes_of_" << book.name
            << "{";
        for (std::size_t k = 0; k < book.codes.size(); ++k)
            out << (k % 8 == 0 ? "\n    " : " ") << book.codes[k] << "U,";
        out << "};\n";
    }
    out << "\nconstexpr std::array<TagFamily, " << books.size() << "> families{{\n";
    for (const Book& book : books)
        out << "    {\"" << book.name << "\", " << book.cells << ", " << book.outline_cells << ", "
            << least_distance(book) << ", \"" << book.layout << "\", codes_of_" << book.name << "},\n";
    out << "}};\n\n}  // namespace\n\nstd::span<const TagFamily> tag_families() {\n    return families;\n}\n"
        << "\n}  // namespace fidservo\n";
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "usage: write_tag_books FILE.cpp\n";
        return 2;
    }
    std::vector<Book> books;
    const auto add = [&](apriltag_family_t* family, void (*destroy)(apriltag_family_t*)) {
        books.push_back(book_of(family));
        destroy(family);
    };
    add(tag36h11_create(), tag36h11_destroy);
    add(tag25h9_create(), tag25h9_destroy);
    add(tag16h5_create(), tag16h5_destroy);
    add(tagStandard41h12_create(), tagStandard41h12_destroy);
    int dictionary = cv::aruco::DICT_4X4_50;
    for (const char* const bits : {"4X4", "5X5", "6X6", "7X7"})
        for (const char* const size : {"50", "100", "250", "1000"})
            books.push_back(book_of(std::string("DICT_") + bits + "_" + size,
                                    *cv::aruco::getPredefinedDictionary(dictionary++)));
    std::ofstream out(arguments[1]);
    write(out, books);
    return out.flush() ? 0 : 1;
}

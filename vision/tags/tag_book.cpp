// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_book.h"

#include "core/demand.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

extern "C" {
#include <apriltag/apriltag.h>
}

namespace fidservo::vision {
namespace {

struct Cell {
    int row, column;
};

/// The code's cells such that those of the k-th quarter are the first quarter's, turned k times.
std::vector<Cell> cells_by_quarters(const TagPattern& pattern) {
    const int last = pattern.cells - 1;
    const auto turned = [&](Cell cell) { return Cell{cell.column, last - cell.row}; };
    const auto place = [&](Cell cell) { return cell_at(cell.row, cell.column, pattern.cells); };
    std::array<std::vector<Cell>, 4> quarters;
    std::vector<Cell> middle;
    auto left = pattern.code;
    for (int row = 0; row <= last; ++row)
        for (int column = 0; column <= last; ++column) {
            Cell cell{row, column};
            if (!left[place(cell)]) continue;
            if (2 * row == last && 2 * column == last) {
                middle.push_back(cell);
                continue;
            }
            for (std::vector<Cell>& quarter : quarters) {
                FIDSERVO_DEMAND(left[place(cell)]);
                left[place(cell)] = false;
                quarter.push_back(cell);
                cell = turned(cell);
            }
        }
    std::vector<Cell> all;
    for (const std::vector<Cell>& quarter : quarters) all.insert(all.end(), quarter.begin(), quarter.end());
    all.insert(all.end(), middle.begin(), middle.end());
    return all;
}

/// The library's family, and the memory that it points to.
struct Book {
    apriltag_family_t family{};
    std::string name;
    std::vector<std::uint64_t> codes;
    std::vector<std::uint32_t> columns, rows;

    Book(const TagReading& reading, int corrected_bits) : name(reading.print.family->name) {
        const TagPattern first = tag_pattern(reading.print, 0);
        const std::vector<Cell> cells = cells_by_quarters(first);
        for (const Cell& cell : cells) {
            columns.push_back(static_cast<std::uint32_t>(cell.column - first.rim));
            rows.push_back(static_cast<std::uint32_t>(cell.row - first.rim));
        }
        for (int id = 0; id < reading.print.family->size(); ++id) {
            const TagPattern pattern = tag_pattern(reading.print, id);
            std::uint64_t code = 0;
            for (const Cell& cell : cells)
                code =
                    2 * code + (pattern.is_white(cell.row, reading.mirrored ? pattern.cells - 1 - cell.column
                                                                            : cell.column)
                                    ? 1
                                    : 0);
            codes.push_back(code);
        }
        const int quiet_zone = first.rim == 0 ? 2 : 0;
        family = {.ncodes = static_cast<std::uint32_t>(codes.size()),
                  .codes = codes.data(),
                  .width_at_border = first.outline_cells(),
                  .total_width = first.cells + quiet_zone,
                  .reversed_border = first.is_white_inside(),
                  .nbits = static_cast<std::uint32_t>(cells.size()),
                  .bit_x = columns.data(),
                  .bit_y = rows.data(),
                  .h = static_cast<std::uint32_t>(reading.print.family->least_distance),
                  .name = name.data(),
                  .impl = nullptr};
        apriltag_detector_t* const maker = apriltag_detector_create();
        apriltag_detector_add_family_bits(maker, &family, corrected_bits);
        zarray_clear(maker->tag_families);  // what is still listed when a detector ends loses its table
        apriltag_detector_destroy(maker);
    }
    ~Book() {
        apriltag_detector_t* const ender = apriltag_detector_create();
        apriltag_family_t* const ended = &family;
        zarray_add(ender->tag_families, static_cast<const void*>(&ended));
        apriltag_detector_destroy(ender);
    }
    Book(const Book&) = delete;
    Book& operator=(const Book&) = delete;
};

/// Books in use, and the one that was taken last: to make a table takes longer than to search an image.
class Shelf {
  public:
    std::shared_ptr<Book> take(const TagReading& reading, int corrected_bits) {
        const std::scoped_lock lock(mutex_);
        std::erase_if(entries_, [](const Entry& entry) { return entry.book.expired(); });
        for (const Entry& entry : entries_)
            if (entry.reading == reading && entry.corrected_bits == corrected_bits)
                if (auto book = entry.book.lock()) return last_ = book;
        auto book = std::make_shared<Book>(reading, corrected_bits);
        entries_.push_back({reading, corrected_bits, book});
        return last_ = book;
    }

  private:
    struct Entry {
        TagReading reading;
        int corrected_bits;
        std::weak_ptr<Book> book;
    };
    std::mutex mutex_;
    std::vector<Entry> entries_;
    std::shared_ptr<Book> last_;
};

}  // namespace

int most_correctable_bits(const TagFamily& family) {
    constexpr std::int64_t most_words = 1 << 20;
    const std::int64_t bits = std::ranges::count(family.layout, 'd');
    const std::int64_t words = family.size() * (1 + bits + bits * (bits - 1));
    return std::min((family.least_distance - 1) / 2, words > most_words ? 1 : 2);
}

std::shared_ptr<apriltag_family> shared_tag_book(const TagReading& reading, int corrected_bits) {
    FIDSERVO_DEMAND(corrected_bits >= 0 && corrected_bits <= 2);
    static Shelf shelf;
    const std::shared_ptr<Book> book = shelf.take(reading, corrected_bits);
    return {book, &book->family};
}

void EndLibraryDetector::operator()(apriltag_detector* ended) const {
    zarray_clear(ended->tag_families);
    apriltag_detector_destroy(ended);
}

LibraryDetector library_detector(std::span<const std::shared_ptr<apriltag_family>> books, int min_contrast) {
    LibraryDetector detector(apriltag_detector_create());
    for (const std::shared_ptr<apriltag_family>& shared : books) {
        apriltag_family_t* const book = shared.get();
        zarray_add(detector->tag_families, static_cast<const void*>(&book));
    }
    detector->nthreads = 1;
    detector->quad_decimate = 1.0F;
    detector->quad_sigma = 0.0F;  // with decimation 1 the library would blur the caller's own image
    detector->qtp.min_white_black_diff = min_contrast;
    return detector;
}

}  // namespace fidservo::vision

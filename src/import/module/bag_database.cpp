// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/bag_database.h"

#include "src/import/module/cdr.h"
#include "src/import/module/zstd_bytes.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

/// Of SQLite's file format, 1.3.
constexpr std::size_t header_bytes = 100, write_version_at = 18, read_version_at = 19;
constexpr char version_with_log = 2;  ///< changes go into FILE-wal, and from there into the file at times

/// A database of SQLite states its pages, where its header's two counters of changes agree (SQLite's file
/// format, 1.3.7).
void demand_all_pages(std::string_view header, std::uint64_t size) {
    if (header.size() < header_bytes) throw BagError("breaks off in its header");
    const auto number_at = [&](std::size_t at, std::size_t bytes) {
        std::uint64_t number = 0;
        for (std::size_t k = 0; k < bytes; ++k)
            number = number * 256 + static_cast<unsigned char>(header[at + k]);
        return number;
    };
    const std::uint64_t page_bytes = number_at(16, 2) == 1 ? 65536 : number_at(16, 2);
    if (number_at(24, 4) == number_at(92, 4) && page_bytes * number_at(28, 4) > size)
        throw BagError(
            fmt::format("breaks off: it states {} bytes and has {}", page_bytes * number_at(28, 4), size));
}

std::string beginning_of_bag(const std::filesystem::path& file, std::size_t most_bytes,
                             bool (*is_interrupted)()) {
    constexpr std::size_t piece_bytes = std::size_t{1} << 24U;
    std::ifstream stream(file, std::ios::binary);
    std::string bytes;
    bytes.reserve(most_bytes);
    while (stream && bytes.size() < most_bytes && !is_interrupted()) {
        const std::size_t done = bytes.size(), piece = std::min(piece_bytes, most_bytes - done);
        bytes.resize(done + piece);
        stream.read(bytes.data() + done, static_cast<std::streamsize>(piece));
        bytes.resize(done + static_cast<std::size_t>(stream.gcount()));
    }
    return bytes;
}

/// So few that even a disk that seeks for each row is left within a second.
constexpr int steps_of_piece = 1'000;

}  // namespace

BagDatabase::BagDatabase(const std::filesystem::path& file, bool (*is_interrupted)())
    : file_(file), is_interrupted_(is_interrupted) {
    std::error_code error;
    std::uint64_t bytes = std::filesystem::file_size(file, error);
    if (error) throw BagError(error.message());
    std::string header = beginning_of_bag(file, header_bytes, is_interrupted);
    const bool is_compressed = is_zstd(header);
    if (is_compressed) {
        constexpr std::size_t most_bytes = std::size_t{1} << 31U;
        const std::string compressed =
            beginning_of_bag(file, std::min<std::size_t>(bytes, most_bytes), is_interrupted);
        auto content = decompressed(compressed, most_bytes, is_interrupted);
        end_if_interrupted();
        if (!content)
            throw BagError(fmt::format("{}; unzstd -o NEW.db3 FILE.db3.zstd decompresses a larger one",
                                       content.error()));
        content_ = *std::move(content);
        bytes = content_.size();
        header = content_.substr(0, header_bytes);
    }
    demand_all_pages(header, bytes);
    const std::uint64_t bytes_of_changes = std::filesystem::file_size(file.string() + "-wal", error);
    constexpr std::uint64_t least_pieces = 4'000, most_steps_of_byte = 20;
    most_pieces_ =
        least_pieces + (bytes + (error ? 0 : bytes_of_changes)) / steps_of_piece * most_steps_of_byte;
    const bool has_log = header[read_version_at] == version_with_log;
    lacks_log_ = has_log && !is_compressed && !std::filesystem::exists(file.string() + "-wal", error);
    sqlite3* const opened = open(is_compressed);
    if (is_compressed) open_compressed();
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, most_message_bytes);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_progress_handler(opened, steps_of_piece, count_steps, this);
    demand_plain_tables();
}

sqlite3* BagDatabase::open(bool is_compressed) {
    // Beside a file with a log of changes SQLite makes further files, which a medium or a folder that is only
    // read does not allow; without the log nobody changes the file, and nothing else is needed.
    std::string uri = "file:";
    for (const char letter : std::filesystem::absolute(file_).string())
        uri += letter == '%' || letter == '?' || letter == '#'
                   ? fmt::format("%{:02X}", static_cast<unsigned char>(letter))
                   : std::string(1, letter);
    if (lacks_log_) uri += "?immutable=1";
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(
        is_compressed ? ":memory:" : uri.c_str(), &opened,
        is_compressed ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) fail();
    return opened;
}

void BagDatabase::open_compressed() {
    // A log of changes beside the file does not exist in memory: the header then says that there is none.
    content_[write_version_at] = content_[read_version_at] = 1;
    const auto size = static_cast<sqlite3_int64>(content_.size());
    if (sqlite3_deserialize(database_.get(), "main", reinterpret_cast<unsigned char*>(content_.data()), size,
                            size, SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
        fail();
}

/// What a view, a virtual table or an expression computes may never end.
void BagDatabase::demand_plain_tables() const {
    each("SELECT name, type, rootpage FROM sqlite_master WHERE lower(name) IN ('topics', 'messages')", 0,
         [](sqlite3_stmt* row) {
             if (text_of(row, 1) != "table" || sqlite3_column_int64(row, 2) <= 0)
                 throw BagError(fmt::format("is no bag of ROS 2: {} is not a plain table", text_of(row, 0)));
         });
}

int BagDatabase::count_steps(void* bag) {
    const auto& database = *static_cast<const BagDatabase*>(bag);
    if (database.is_interrupted_() || database.pieces_left_ == 0) return 1;
    --database.pieces_left_;
    return 0;
}

void BagDatabase::each(const char* sql, std::int64_t argument,
                       const std::function<void(sqlite3_stmt*)>& visit) const {
    pieces_left_ = most_pieces_;
    sqlite3_stmt* prepared = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &prepared, nullptr) != SQLITE_OK) fail();
    const std::unique_ptr<sqlite3_stmt, Close> statement(prepared);
    if (sqlite3_bind_parameter_count(prepared) > 0) sqlite3_bind_int64(prepared, 1, argument);
    int code = SQLITE_ROW;
    while ((code = sqlite3_step(prepared)) == SQLITE_ROW) {
        end_if_interrupted();
        visit(prepared);
    }
    end_if_interrupted();
    if (code == SQLITE_INTERRUPT)
        throw BagError("is damaged: reading it takes more steps than a table of its size can need");
    if (code != SQLITE_DONE) fail();
}

void BagDatabase::end_if_interrupted() const {
    if (is_interrupted_()) throw BagError("is no longer read: interrupted");
}

std::string BagDatabase::note() const {
    if (!lacks_log_) return {};
    return fmt::format(
        "{0} was written with a log of changes, {0}-wal, which is not beside it: unless the "
        "recorder ended in order, the last messages are missing",
        name());
}

void BagDatabase::fail() const {
    const int code = sqlite3_extended_errcode(database_.get());
    const bool cannot_make_files = (code & 0xFF) == SQLITE_CANTOPEN || (code & 0xFF) == SQLITE_READONLY;
    if (cannot_make_files)
        for (const char* ending : {"-wal", "-journal"})
            if (std::error_code error; std::filesystem::exists(file_.string() + ending, error))
                throw BagError(
                    fmt::format("its changes are in {}{}, which SQLite can only join to it in a "
                                "folder that can be written to: copy both files into one",
                                name(), ending));
    std::string why =
        fmt::format("SQLite cannot read it as a bag of ROS 2: {}", sqlite3_errmsg(database_.get()));
    if (lacks_log_) why += fmt::format("; {}-wal, its log of changes, is not beside it", name());
    throw BagError(why);
}

std::string text_of(sqlite3_stmt* row, int column) {
    const unsigned char* text = sqlite3_column_text(row, column);
    return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

BagMessage::BagMessage(sqlite3_stmt* row, int column) {
    const void* bytes = sqlite3_column_blob(row, column);
    if (bytes != nullptr)
        bytes_ = {static_cast<const char*>(bytes),
                  static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
    if (!is_zstd(bytes_)) return;
    auto content = decompressed(bytes_, most_message_bytes, [] { return false; });
    if (!content) throw CdrError(content.error());
    decompressed_ = *std::move(content);
    bytes_ = decompressed_;
}

}  // namespace fidservo::imports

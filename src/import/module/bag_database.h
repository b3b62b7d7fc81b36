// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A file of a bag of ROS 2 in SQLite's format, which may be compressed, or its messages.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sqlite3.h>

namespace fidservo::imports {

class BagError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The largest message that is read.
inline constexpr int most_message_bytes = 1 << 28;

class BagDatabase {
  public:
    /// Opens it; a file that zstd compressed is decompressed into memory. Throws BagError: it is no bag, or
    /// is cut off, or its topics and messages are not plain tables.
    /// @param is_interrupted  asked while it reads, now and later; once it gives true, BagError is thrown
    BagDatabase(const std::filesystem::path& file, bool (*is_interrupted)());
    BagDatabase(const BagDatabase&) = delete;
    BagDatabase& operator=(const BagDatabase&) = delete;

    /// Runs a query; calls visit for each row. Throws BagError; also where SQLite takes more steps than a
    /// table of the file's size can need, as it does in one whose pages refer to each other in a circle.
    void each(const char* sql, std::int64_t argument, const std::function<void(sqlite3_stmt*)>& visit) const;

    std::string name() const { return file_.filename().string(); }
    /// What a user would want to know of the file, in one sentence; empty: nothing.
    std::string note() const;

  private:
    struct Close {
        void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    static int count_steps(void* bag);
    sqlite3* open(bool is_compressed);
    void open_compressed();
    void demand_plain_tables() const;
    void end_if_interrupted() const;
    [[noreturn]] void fail() const;

    std::filesystem::path file_;
    bool (*is_interrupted_)();
    bool lacks_log_ = false;         ///< SQLite's log of changes, FILE-wal, is not there
    std::string content_;            ///< of a compressed file; the database is in it
    std::uint64_t most_pieces_ = 0;  ///< of a query's steps, a thousand each
    std::unique_ptr<sqlite3, Close> database_;
    mutable std::uint64_t pieces_left_ = 0;
};

std::string text_of(sqlite3_stmt* row, int column);

/// A message as it was before the recorder compressed it, if it did.
class BagMessage {
  public:
    /// Throws CdrError: its compressed data are damaged.
    BagMessage(sqlite3_stmt* row, int column);
    /// Lives as long as this, and no longer than the row.
    std::string_view bytes() const { return bytes_; }

  private:
    std::string decompressed_;
    std::string_view bytes_;
};

}  // namespace fidservo::imports

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A file of a ROS 2 bag in SQLite's format. The file or its messages may be compressed.
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
    /// Opens a file; one that is compressed by zstd is decompressed into memory. Throws BagError if it is not
    /// a bag, if it is truncated, or if its topics and messages are not plain tables.
    /// @param is_interrupted  called during all reading, also after the constructor; once it returns true,
    /// BagError is thrown
    BagDatabase(const std::filesystem::path& file, bool (*is_interrupted)());
    BagDatabase(const BagDatabase&) = delete;
    BagDatabase& operator=(const BagDatabase&) = delete;

    /// Runs a query; calls visit for each row. Throws BagError, also if SQLite takes more steps than a table
    /// of the file's size can need, as it does if the pages of a damaged file refer to each other in a
    /// circle.
    void each(const char* sql, std::int64_t argument, const std::function<void(sqlite3_stmt*)>& visit) const;

    std::string name() const { return file_.filename().string(); }
    /// A note on the file for the user, one sentence; empty: none.
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

/// A message, decompressed if the recorder compressed it.
class BagMessage {
  public:
    /// Throws CdrError: its compressed data are damaged.
    BagMessage(sqlite3_stmt* row, int column);
    /// Valid as long as this object and the row.
    std::string_view bytes() const { return bytes_; }

  private:
    std::string decompressed_;
    std::string_view bytes_;
};

}  // namespace fidservo::imports

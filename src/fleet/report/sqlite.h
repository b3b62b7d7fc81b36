// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// SQLite handles that close themselves; errors become exceptions.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace fidservo::fleet {

/// A statement that is prepared once. Columns and parameters count from 0.
class Statement {
  public:
    /// Throws RunFault where the text is wrong or the file cannot be read.
    Statement(sqlite3* database, std::string_view sql);

    /// Sets the values of the statement's parameters and runs it to its end. NaN is stored as NULL.
    template <class... Values>
    void run(const Values&... values) {
        reset();
        int column = 0;
        (bind(column++, values), ...);
        while (step()) continue;
    }
    /// Whether there is a row.
    bool step();
    void reset();

    void bind(int at, const std::string& text);
    void bind(int at, const std::optional<std::string>& text);
    void bind(int at, double number);
    void bind(int at, std::int64_t number);
    void bind(int at, const std::optional<std::int64_t>& number);

    std::string text(int column) const;
    std::optional<std::string> optional_text(int column) const;
    double number(int column) const;  ///< NaN where it is NULL
    std::optional<std::int64_t> optional_integer(int column) const;
    std::int64_t integer(int column) const;

  private:
    struct Finalise {
        void operator()(sqlite3_stmt* statement) const;
    };
    [[noreturn]] void fail() const;

    sqlite3* database_;
    std::unique_ptr<sqlite3_stmt, Finalise> statement_;
};

/// An open file.
class Database {
  public:
    /// Opens it or makes a new one. Throws InputError if the file is no SQLite database, RunFault if it
    /// cannot be opened.
    explicit Database(const std::filesystem::path& file);

    sqlite3* get() const { return database_.get(); }
    /// Runs statements that have no parameters and whose rows do not matter. Throws RunFault.
    void run(const char* sql) const;
    /// The first number of a statement's first row.
    std::int64_t number(const char* sql) const;

  private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    std::filesystem::path file_;
    std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace fidservo::fleet

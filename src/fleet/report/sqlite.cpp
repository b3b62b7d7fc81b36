// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/sqlite.h"

#include "core/failure.h"
#include "core/input_error.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <sqlite3.h>

namespace fidservo::fleet {
namespace {

constexpr int busy_ms = 20'000;

[[noreturn]] void fail_by(sqlite3* database) {
    const char* file = database == nullptr ? nullptr : ::sqlite3_db_filename(database, "main");
    throw RunFault(
        fmt::format("{}: {}", file == nullptr ? "fleet.sqlite" : file, ::sqlite3_errmsg(database)));
}

}  // namespace

void Statement::Finalise::operator()(sqlite3_stmt* statement) const {
    ::sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, std::string_view sql) : database_(database) {
    sqlite3_stmt* statement = nullptr;
    if (::sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement, nullptr) !=
        SQLITE_OK)
        fail_by(database);
    statement_.reset(statement);
}

void Statement::fail() const {
    fail_by(database_);
}

bool Statement::step() {
    const int code = ::sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) fail();
    return false;
}

void Statement::reset() {
    (void)::sqlite3_reset(statement_.get());  // repeats the error of the step before, which was thrown
}

void Statement::bind(int at, const std::string& text) {
    if (::sqlite3_bind_text64(statement_.get(), at + 1, text.data(), text.size(), SQLITE_TRANSIENT,
                              SQLITE_UTF8) != SQLITE_OK)
        fail();
}

void Statement::bind(int at, const std::optional<std::string>& text) {
    if (text)
        bind(at, *text);
    else if (::sqlite3_bind_null(statement_.get(), at + 1) != SQLITE_OK)
        fail();
}

void Statement::bind(int at, double number) {
    if (::sqlite3_bind_double(statement_.get(), at + 1, number) != SQLITE_OK) fail();
}

void Statement::bind(int at, std::int64_t number) {
    if (::sqlite3_bind_int64(statement_.get(), at + 1, number) != SQLITE_OK) fail();
}

void Statement::bind(int at, const std::optional<std::int64_t>& number) {
    if (number)
        bind(at, *number);
    else if (::sqlite3_bind_null(statement_.get(), at + 1) != SQLITE_OK)
        fail();
}

std::string Statement::text(int column) const {
    const unsigned char* text = ::sqlite3_column_text(statement_.get(), column);
    const auto size = static_cast<std::size_t>(::sqlite3_column_bytes(statement_.get(), column));
    return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text), size);
}

std::optional<std::string> Statement::optional_text(int column) const {
    if (::sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return {};
    return text(column);
}

double Statement::number(int column) const {
    if (::sqlite3_column_type(statement_.get(), column) == SQLITE_NULL)
        return std::numeric_limits<double>::quiet_NaN();
    return ::sqlite3_column_double(statement_.get(), column);
}

std::optional<std::int64_t> Statement::optional_integer(int column) const {
    if (::sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return {};
    return integer(column);
}

std::int64_t Statement::integer(int column) const {
    return ::sqlite3_column_int64(statement_.get(), column);
}

void Database::Close::operator()(sqlite3* database) const {
    ::sqlite3_close_v2(database);
}

Database::Database(const std::filesystem::path& file) : file_(file) {
    sqlite3* database = nullptr;
    const int code =
        ::sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    database_.reset(database);
    if (code != SQLITE_OK) throw RunFault(fmt::format("{}: {}", file.string(), ::sqlite3_errmsg(database)));
    ::sqlite3_busy_timeout(database, busy_ms);
    // Whatever the file is shows when it is read first.
    char* message = nullptr;
    const int read = ::sqlite3_exec(database, "PRAGMA schema_version", nullptr, nullptr, &message);
    const std::string text = message == nullptr ? "" : message;
    ::sqlite3_free(message);
    if (read == SQLITE_NOTADB || read == SQLITE_CORRUPT)
        throw InputError(fmt::format("{}: {}; it is made anew where it is not there", file.string(), text));
    if (read != SQLITE_OK) throw RunFault(fmt::format("{}: {}", file.string(), text));
}

void Database::run(const char* sql) const {
    if (::sqlite3_exec(get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail_by(get());
}

std::int64_t Database::number(const char* sql) const {
    Statement statement(get(), sql);
    return statement.step() ? statement.integer(0) : 0;
}

}  // namespace fidservo::fleet

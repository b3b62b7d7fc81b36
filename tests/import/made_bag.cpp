// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/import/made_files.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

namespace fidservo::imports::testing {

CdrBytes& CdrBytes::header(std::int64_t stamp_ns) {
    constexpr std::int64_t second = 1'000'000'000;
    return number(static_cast<std::int32_t>(stamp_ns / second))
        .number(static_cast<std::uint32_t>(stamp_ns % second))
        .text("base");
}

CdrBytes& CdrBytes::text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value + '\0';
    return *this;
}

CdrBytes& CdrBytes::octets(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
}

CdrBytes& CdrBytes::doubles(const std::vector<double>& values) {
    number(static_cast<std::uint32_t>(values.size()));
    for (const double value : values) number(value);
    return *this;
}

void make_bag(const std::filesystem::path& file, const std::vector<BagTopic>& topics) {
    sqlite3* bag = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &bag), SQLITE_OK);
    const auto run = [&](const char* sql) {
        ASSERT_EQ(sqlite3_exec(bag, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(bag);
    };
    run("PRAGMA synchronous = OFF; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT "
        "NOT NULL, "
        "serialization_format TEXT NOT NULL, "
        "offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT "
        "NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC); BEGIN");
    for (std::size_t k = 0; k < topics.size(); ++k) {
        sqlite3_stmt* insert = nullptr;
        sqlite3_prepare_v2(bag, "INSERT INTO topics VALUES(?,?,?,?,'')", -1, &insert, nullptr);
        sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(k) + 1);
        sqlite3_bind_text(insert, 2, topics[k].name.c_str(), -1, SQLITE_STATIC);
        sqlite3_bind_text(insert, 3, topics[k].type.c_str(), -1, SQLITE_STATIC);
        sqlite3_bind_text(insert, 4, topics[k].serialization.c_str(), -1, SQLITE_STATIC);
        EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
        sqlite3_finalize(insert);
        sqlite3_prepare_v2(bag, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)", -1, &insert,
                           nullptr);
        for (const auto& [received, bytes] : topics[k].messages) {
            sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(k) + 1);
            sqlite3_bind_int64(insert, 2, received);
            sqlite3_bind_blob(insert, 3, bytes.data(), static_cast<int>(bytes.size()), SQLITE_STATIC);
            EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
            sqlite3_reset(insert);
        }
        sqlite3_finalize(insert);
    }
    run("COMMIT");
    sqlite3_close(bag);
}

std::string joint_state(std::int64_t stamp_ns, const std::vector<std::string>& joints,
                        const std::vector<double>& positions) {
    CdrBytes cdr;
    cdr.header(stamp_ns).number(static_cast<std::uint32_t>(joints.size()));
    for (const std::string& joint : joints) cdr.text(joint);
    return cdr.doubles(positions).doubles({}).doubles({}).bytes();
}

std::string float64(double value) {
    return CdrBytes().number(value).bytes();
}

std::string mono8_image(std::int64_t stamp_ns, std::uint32_t width, std::uint32_t height,
                        const std::string& pixels, const std::string& encoding) {
    return CdrBytes()
        .header(stamp_ns)
        .number(height)
        .number(width)
        .text(encoding)
        .number(std::uint8_t{0})
        .number(width)
        .octets(pixels)
        .bytes();
}

}  // namespace fidservo::imports::testing

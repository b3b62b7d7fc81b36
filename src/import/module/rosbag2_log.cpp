// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/rosbag2_log.h"

#include "src/import/module/bag_images.h"
#include "src/import/module/cdr.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <sqlite3.h>

namespace fidservo::imports {
namespace {

struct SqliteClose {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

class BagError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

class Bag {
  public:
    explicit Bag(const char* file) {
        sqlite3* opened = nullptr;
        const int code = sqlite3_open_v2(file, &opened, SQLITE_OPEN_READONLY, nullptr);
        database_.reset(opened);
        if (code != SQLITE_OK) fail();
        constexpr int most_bytes = 1 << 28;
        sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, most_bytes);
    }
    /// Runs a query; calls visit for each row.
    void each(const char* sql, std::int64_t argument, const std::function<void(sqlite3_stmt*)>& visit) const {
        sqlite3_stmt* prepared = nullptr;
        if (sqlite3_prepare_v2(database_.get(), sql, -1, &prepared, nullptr) != SQLITE_OK) fail();
        const std::unique_ptr<sqlite3_stmt, SqliteClose> statement(prepared);
        if (sqlite3_bind_parameter_count(prepared) > 0) sqlite3_bind_int64(prepared, 1, argument);
        int code = SQLITE_ROW;
        while ((code = sqlite3_step(prepared)) == SQLITE_ROW) visit(prepared);
        if (code != SQLITE_DONE) fail();
    }

  private:
    [[noreturn]] void fail() const {
        throw BagError(
            fmt::format("SQLite cannot read it as a bag of ROS 2: {}", sqlite3_errmsg(database_.get())));
    }
    std::unique_ptr<sqlite3, SqliteClose> database_;
};

/// A database of SQLite states its pages, where its header's two counters of changes agree (SQLite's file
/// format, 1.3.7).
void demand_all_pages(const char* file) {
    std::array<unsigned char, 100> header{};
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream.tellg()));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(header.data()), header.size());
    const auto number_at = [&](std::size_t at, std::size_t bytes) {
        std::uint64_t number = 0;
        for (std::size_t k = 0; k < bytes; ++k) number = number * 256 + header[at + k];
        return number;
    };
    const std::uint64_t page_bytes = number_at(16, 2) == 1 ? 65536 : number_at(16, 2);
    if (number_at(24, 4) == number_at(92, 4) && page_bytes * number_at(28, 4) > size)
        throw BagError(
            fmt::format("breaks off: it states {} bytes and has {}", page_bytes * number_at(28, 4), size));
}

std::string_view blob_of(sqlite3_stmt* row, int column) {
    const void* bytes = sqlite3_column_blob(row, column);
    return bytes == nullptr ? std::string_view()
                            : std::string_view(static_cast<const char*>(bytes),
                                               static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

std::string text_of(sqlite3_stmt* row, int column) {
    const unsigned char* text = sqlite3_column_text(row, column);
    return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

struct Topic {
    std::int64_t id = 0;
    std::string name, type, serialization;
};

/// The signals of a topic while its messages are read: a value a message, NaN where a message lacks one.
struct TopicSignals {
    std::vector<std::int64_t> stamps, received;
    std::map<std::string, std::vector<double>> values;

    void set(const std::string& name, double value) {
        std::vector<double>& of = values[name];
        of.resize(received.size(), std::numeric_limits<double>::quiet_NaN());
        of.back() = value;
    }
};

void read_joint_state(CdrReader& cdr, TopicSignals& topic) {
    topic.stamps.push_back(read_header(cdr));
    const std::vector<std::string> joints = cdr.texts();
    for (const char* what : {"position", "velocity", "effort"}) {
        const std::vector<double> values = cdr.doubles();
        if (!values.empty() && values.size() != joints.size())
            throw CdrError(
                fmt::format("has {} joints and {} values of {}", joints.size(), values.size(), what));
        for (std::size_t k = 0; k < values.size(); ++k)
            topic.set(fmt::format("/{}[{}]", what, joints[k].substr(0, 80)), values[k]);
    }
}

template <class Number>
void read_one_number(CdrReader& cdr, TopicSignals& topic) {
    topic.set("", static_cast<double>(cdr.number<Number>()));
}

struct Decoder {
    std::string_view type;
    void (*read)(CdrReader&, TopicSignals&);
};
constexpr std::array decoders{Decoder{"sensor_msgs/msg/JointState", read_joint_state},
                              Decoder{"std_msgs/msg/Float64", read_one_number<double>},
                              Decoder{"std_msgs/msg/Float32", read_one_number<float>},
                              Decoder{"std_msgs/msg/Int64", read_one_number<std::int64_t>},
                              Decoder{"std_msgs/msg/Int32", read_one_number<std::int32_t>},
                              Decoder{"std_msgs/msg/Int16", read_one_number<std::int16_t>},
                              Decoder{"std_msgs/msg/UInt32", read_one_number<std::uint32_t>},
                              Decoder{"std_msgs/msg/UInt16", read_one_number<std::uint16_t>},
                              Decoder{"std_msgs/msg/Bool", read_one_number<std::uint8_t>}};

constexpr const char* messages_of_topic =
    "SELECT timestamp, data, id FROM messages WHERE topic_id = ?1 ORDER BY timestamp, id";

/// Signals on the stamps where all messages have one, in their order.
void add_signals(const Topic& topic, TopicSignals& read, Log& log) {
    const bool has_stamps = read.stamps.size() == read.received.size() &&
                            std::ranges::none_of(read.stamps, [](auto stamp) { return stamp == 0; });
    LoggedSignal times{.name = topic.name + (has_stamps ? "/stamp" : "/received"), .unit = "ns"};
    const std::vector<std::int64_t>& from = has_stamps ? read.stamps : read.received;
    std::vector<std::size_t> order(from.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return from[k]; });
    for (const std::size_t k : order) {
        times.whole.push_back(from[k]);
        times.values.push_back(static_cast<double>(from[k]));
    }
    if (!has_stamps)
        log.notes.push_back(fmt::format(
            "{}: its messages have no stamps: times are those at which the bag received them", topic.name));
    for (auto& [name, values] : read.values) {
        values.resize(from.size(), std::numeric_limits<double>::quiet_NaN());
        LoggedSignal signal{.name = topic.name + name, .times = times.name};
        for (const std::size_t k : order) signal.values.push_back(values[k]);
        log.signals.push_back(std::move(signal));
    }
    log.signals.push_back(std::move(times));
}

void read_signals(const Bag& bag, const Topic& topic, const Decoder& decoder, Log& log,
                  std::uint64_t& count) {
    TopicSignals read;
    bag.each(messages_of_topic, topic.id, [&](sqlite3_stmt* row) {
        read.received.push_back(sqlite3_column_int64(row, 0));
        try {
            CdrReader cdr(blob_of(row, 1));
            decoder.read(cdr, read);
        } catch (const CdrError& error) {
            throw BagError(fmt::format("{}: message {}: {}", topic.name, read.received.size(), error.what()));
        }
        count += 1 + read.values.size();
        if (count > most_values || log.signals.size() + read.values.size() > most_signals)
            throw BagError(fmt::format("more than {} numbers or {} signals: are not read from one file",
                                       most_values, most_signals));
    });
    if (!read.received.empty()) add_signals(topic, read, log);
}

void read_camera_topic(const std::shared_ptr<const Bag>& bag, const Topic& topic, bool is_compressed,
                       Log& log) {
    struct Message {
        TimeNs time_ns;
        std::int64_t id;
    };
    std::vector<Message> messages;
    bag->each(messages_of_topic, topic.id, [&](sqlite3_stmt* row) {
        try {
            CdrReader cdr(blob_of(row, 1));
            const std::int64_t stamp = read_header(cdr);
            messages.push_back(
                {stamp == 0 ? sqlite3_column_int64(row, 0) : stamp, sqlite3_column_int64(row, 2)});
        } catch (const CdrError& error) {
            throw BagError(fmt::format("{}: message {}: {}", topic.name, messages.size() + 1, error.what()));
        }
    });
    std::ranges::stable_sort(messages, {}, &Message::time_ns);
    LoggedCamera camera{.name = topic.name};
    for (const Message& message : messages) camera.times_ns.push_back(message.time_ns);
    camera.frame = [bag, messages, is_compressed](std::size_t k) -> tl::expected<LoggedFrame, std::string> {
        std::optional<LoggedFrame> frame;
        try {
            bag->each("SELECT data FROM messages WHERE id = ?1", messages[k].id, [&](sqlite3_stmt* row) {
                frame =
                    is_compressed ? frame_of_compressed(blob_of(row, 0)) : frame_of_image(blob_of(row, 0));
            });
        } catch (const std::runtime_error& error) {
            return tl::make_unexpected(std::string(error.what()));
        }
        if (!frame) return tl::make_unexpected(std::string("is no longer in the bag"));
        return std::move(*frame);
    };
    if (!messages.empty()) log.cameras.push_back(std::move(camera));
}

void read_camera_info(const Bag& bag, const Topic& topic, Log& log) {
    bag.each("SELECT data FROM messages WHERE topic_id = ?1 ORDER BY timestamp, id LIMIT 1", topic.id,
             [&](sqlite3_stmt* row) {
                 try {
                     log.texts[topic.name] = text_of_camera_info(blob_of(row, 0));
                 } catch (const CdrError& error) {
                     throw BagError(fmt::format("{}: message 1: {}", topic.name, error.what()));
                 }
             });
}

void read_topic(const std::shared_ptr<const Bag>& bag, const Topic& topic, Log& log, std::uint64_t& count) {
    const auto decoder = std::ranges::find(decoders, topic.type, &Decoder::type);
    const bool is_image = topic.type == "sensor_msgs/msg/Image",
               is_compressed = topic.type == "sensor_msgs/msg/CompressedImage";
    const bool is_info = topic.type == "sensor_msgs/msg/CameraInfo";
    if (decoder == decoders.end() && !is_image && !is_compressed && !is_info) {
        log.notes.push_back(
            fmt::format("{}: passed over: messages of type {} are not read", topic.name, topic.type));
        return;
    }
    if (topic.serialization != "cdr")
        throw BagError(fmt::format("{}: its messages are serialized as '{}', not as cdr", topic.name,
                                   topic.serialization));
    if (decoder != decoders.end())
        read_signals(*bag, topic, *decoder, log, count);
    else if (is_info)
        read_camera_info(*bag, topic, log);
    else
        read_camera_topic(bag, topic, is_compressed, log);
}

}  // namespace

LogOrFault read_rosbag2_file(const char* file) {
    try {
        demand_all_pages(file);
        const auto bag = std::make_shared<const Bag>(file);
        std::vector<Topic> topics;
        bag->each("SELECT id, name, type, serialization_format FROM topics ORDER BY name", 0,
                  [&](sqlite3_stmt* row) {
                      topics.push_back(
                          {sqlite3_column_int64(row, 0), text_of(row, 1), text_of(row, 2), text_of(row, 3)});
                  });
        Log log;
        std::uint64_t count = 0;
        for (const Topic& topic : topics) read_topic(bag, topic, log, count);
        if (log.signals.empty() && log.cameras.empty())
            return tl::make_unexpected(
                fmt::format("holds no messages of a type that is read, in {} topics", topics.size()));
        return log;
    } catch (const BagError& error) {
        return tl::make_unexpected(std::string(error.what()));
    }
}

}  // namespace fidservo::imports

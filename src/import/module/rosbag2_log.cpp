// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/rosbag2_log.h"

#include "src/import/module/bag_database.h"
#include "src/import/module/bag_images.h"
#include "src/import/module/cdr.h"
#include "src/import/module/message_times.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

/// A file of the bag, and the topic's number in it.
struct Part {
    std::shared_ptr<const BagDatabase> database;
    std::int64_t topic = 0;
};

struct Topic {
    std::string name, type, serialization;
    std::vector<Part> parts;
};

/// Of a signal: the messages that have a value of it, and the values.
struct Samples {
    std::vector<std::uint32_t> messages;
    std::vector<double> values;
};

/// The signals of a topic while its messages are read.
struct TopicSignals {
    std::vector<std::int64_t> stamps, received;
    std::map<std::string, Samples> signals;
    std::uint64_t count = 0;  ///< of values

    void set(const std::string& name, double value) {
        const auto message = static_cast<std::uint32_t>(received.size() - 1);
        Samples& of = signals[name];
        if (!of.messages.empty() && of.messages.back() == message) {
            of.values.back() = value;
            return;
        }
        of.messages.push_back(message);
        of.values.push_back(value);
        ++count;
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

/// Calls visit for each message, with its row (timestamp, data, id), its part's place and its bytes.
template <class Visit>
void each_message(const Topic& topic, const char* sql, const Visit& visit) {
    std::size_t number = 0;
    for (std::size_t part = 0; part < topic.parts.size(); ++part) {
        const BagDatabase& database = *topic.parts[part].database;
        try {
            database.each(sql, topic.parts[part].topic, [&](sqlite3_stmt* row) {
                ++number;
                try {
                    const BagMessage message(row, 1);
                    visit(row, part, message.bytes());
                } catch (const CdrError& error) {
                    throw BagError(fmt::format("{}: message {}: {}", topic.name, number, error.what()));
                }
            });
        } catch (const BagError& error) {
            if (topic.parts.size() == 1) throw;
            throw BagError(fmt::format("{}: {}", database.name(), error.what()));
        }
    }
}

/// When the bag received a message. SQLite keeps a column of integers that holds something else.
std::int64_t reception_of(sqlite3_stmt* row) {
    if (sqlite3_column_type(row, 0) != SQLITE_INTEGER)
        throw CdrError(
            fmt::format("its time of reception, '{}', is no integer", text_of(row, 0).substr(0, 80)));
    return sqlite3_column_int64(row, 0);
}

constexpr const char* messages_of_topic =
    "SELECT timestamp, data, id FROM messages WHERE topic_id = ?1 ORDER BY timestamp, id";

/// The numbers of a list at some of its places; empty if the list is.
template <class Place>
std::vector<std::int64_t> at_places(const std::vector<std::int64_t>& list, const std::vector<Place>& places) {
    std::vector<std::int64_t> some;
    if (list.empty()) return some;
    some.reserve(places.size());
    for (const Place place : places) some.push_back(list[place]);
    return some;
}

LoggedSignal signal_of_times(std::string name, std::vector<std::int64_t> ns) {
    LoggedSignal times{.name = std::move(name), .unit = "ns", .values = {ns.begin(), ns.end()}};
    times.whole = std::move(ns);
    return times;
}

/// Signals that are in the same messages share their times. Times that are not of all messages are named
/// after the first signal that has them.
void add_signals(const Topic& topic, TopicSignals& read, Log& log) {
    std::map<std::vector<std::uint32_t>, std::vector<std::string>> groups;
    for (auto& [name, samples] : read.signals) groups[samples.messages].push_back(name);
    for (const auto& [messages, names] : groups) {
        const std::vector<std::int64_t> received = at_places(read.received, messages);
        const MessageTimes found = times_of_messages(at_places(read.stamps, messages), received);
        const std::string first = messages.size() == read.received.size() ? "" : names.front();
        if (const std::string note = found.note(); !note.empty())
            log.notes.push_back(fmt::format("{}{}: {}", topic.name, first, note));
        LoggedSignal reception =
            signal_of_times(topic.name + "/received" + first, at_places(received, found.order));
        LoggedSignal times =
            found.are_stamps ? signal_of_times(topic.name + "/stamp" + first, found.ns) : reception;
        for (const std::string& name : names) {
            const std::vector<double>& values = read.signals.at(name).values;
            LoggedSignal signal{.name = topic.name + name, .times = times.name};
            for (const std::size_t k : found.order) signal.values.push_back(values[k]);
            log.signals.push_back(std::move(signal));
        }
        log.signals.push_back(std::move(times));
        if (found.are_stamps) log.signals.push_back(std::move(reception));
    }
}

void read_signals(const Topic& topic, const Decoder& decoder, Log& log, std::uint64_t& count) {
    TopicSignals read;
    each_message(topic, messages_of_topic, [&](sqlite3_stmt* row, std::size_t, std::string_view bytes) {
        read.received.push_back(reception_of(row));
        CdrReader cdr(bytes);
        decoder.read(cdr, read);
        if (count + read.received.size() + read.count > most_values ||
            log.signals.size() + read.signals.size() > most_signals)
            throw BagError(fmt::format("more than {} numbers or {} signals: are not read from one bag",
                                       most_values, most_signals));
    });
    count += read.received.size() + read.count;
    if (!read.received.empty()) add_signals(topic, read, log);
}

/// An image message: its part's place and its number there.
struct ImageMessage {
    std::size_t part;
    std::int64_t id;
};

tl::expected<LoggedFrame, std::string> read_frame(const Topic& topic, const ImageMessage& message,
                                                  bool is_compressed) {
    std::optional<LoggedFrame> frame;
    try {
        topic.parts[message.part].database->each(
            "SELECT data FROM messages WHERE id = ?1", message.id, [&](sqlite3_stmt* row) {
                const BagMessage bytes(row, 0);
                frame = is_compressed ? frame_of_compressed(bytes.bytes()) : frame_of_image(bytes.bytes());
            });
    } catch (const std::runtime_error& error) {
        return tl::make_unexpected(std::string(error.what()));
    }
    if (!frame) return tl::make_unexpected(std::string("has left the bag"));
    return std::move(*frame);
}

void read_camera_topic(const Topic& topic, bool is_compressed, Log& log) {
    std::vector<std::int64_t> stamps, received;
    std::vector<ImageMessage> messages;
    LoggedCamera camera{.name = topic.name};
    each_message(topic, messages_of_topic, [&](sqlite3_stmt* row, std::size_t part, std::string_view bytes) {
        CdrReader cdr(bytes);
        stamps.push_back(read_header(cdr));
        received.push_back(reception_of(row));
        messages.push_back({part, sqlite3_column_int64(row, 2)});
        if (!is_compressed && is_deep_image(bytes)) camera.is_deep = true;
    });
    if (messages.empty()) return;
    const MessageTimes times = times_of_messages(stamps, received);
    if (const std::string note = times.note(); !note.empty())
        log.notes.push_back(fmt::format("{}: {}", topic.name, note));
    camera.times_ns = times.ns;
    camera.frame = [topic, messages, order = times.order, is_compressed](std::size_t k) {
        return read_frame(topic, messages[order[k]], is_compressed);
    };
    log.cameras.push_back(std::move(camera));
}

void read_camera_info(const Topic& topic, Log& log) {
    each_message(topic,
                 "SELECT timestamp, data FROM messages WHERE topic_id = ?1 ORDER BY timestamp, id LIMIT 1",
                 [&](sqlite3_stmt*, std::size_t, std::string_view bytes) {
                     log.texts.try_emplace(topic.name, text_of_camera_info(bytes));
                 });
}

void read_topic(const Topic& topic, Log& log, std::uint64_t& count) {
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
        read_signals(topic, *decoder, log, count);
    else if (is_info)
        read_camera_info(topic, log);
    else
        read_camera_topic(topic, is_compressed, log);
}

/// The topics of all files, by name; those of one name and several types as NAME(TYPE).
std::vector<Topic> topics_of(const std::vector<std::filesystem::path>& files, bool (*is_interrupted)(),
                             Log& log) {
    std::map<std::tuple<std::string, std::string, std::string>, Topic> topics;
    for (const std::filesystem::path& file : files) try {
            const auto database = std::make_shared<const BagDatabase>(file, is_interrupted);
            if (std::string note = database->note(); !note.empty()) log.notes.push_back(std::move(note));
            database->each("SELECT id, name, type, serialization_format FROM topics", 0,
                           [&](sqlite3_stmt* row) {
                               const std::tuple key{text_of(row, 1), text_of(row, 2), text_of(row, 3)};
                               Topic& topic = topics[key];
                               std::tie(topic.name, topic.type, topic.serialization) = key;
                               topic.parts.push_back({database, sqlite3_column_int64(row, 0)});
                           });
        } catch (const BagError& error) {
            if (files.size() == 1) throw;
            throw BagError(fmt::format("{}: {}", file.filename().string(), error.what()));
        }
    std::vector<Topic> all;
    all.reserve(topics.size());
    for (auto& [key, topic] : topics) all.push_back(std::move(topic));
    std::map<std::string, int> uses;
    for (const Topic& topic : all) ++uses[topic.name];
    for (Topic& topic : all)
        if (uses.at(topic.name) > 1) topic.name += fmt::format("({})", topic.type);
    return all;
}

}  // namespace

LogOrFault read_rosbag2_files(const std::vector<std::filesystem::path>& files, bool (*is_interrupted)()) {
    try {
        Log log;
        const std::vector<Topic> topics = topics_of(files, is_interrupted, log);
        std::uint64_t count = 0;
        for (const Topic& topic : topics) read_topic(topic, log, count);
        if (log.signals.empty() && log.cameras.empty())
            return tl::make_unexpected(
                fmt::format("holds no messages of a type that is read, in {} topics", topics.size()));
        return log;
    } catch (const BagError& error) {
        return tl::make_unexpected(std::string(error.what()));
    }
}

}  // namespace fidservo::imports

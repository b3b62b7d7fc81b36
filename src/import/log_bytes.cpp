// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/log_bytes.h"

#include "core/demand.h"

#include <cstring>

namespace fidservo::imports {
namespace {

class ByteWriter {
  public:
    void number(std::uint64_t value) { raw(&value, sizeof value); }
    void text(const std::string& value) {
        number(value.size());
        bytes_ += value;
    }
    template <class Value>
    void list(const std::vector<Value>& values) {
        number(values.size());
        raw(values.data(), values.size() * sizeof(Value));
    }
    std::string take() { return std::move(bytes_); }

  private:
    void raw(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
    std::string bytes_;
};

class ByteReader {
  public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t number() {
        std::uint64_t value = 0;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string text() { return std::string(take(number())); }
    template <class Value>
    std::vector<Value> list() {
        std::vector<Value> values(number());
        const std::string_view from = take(values.size() * sizeof(Value));
        if (!values.empty()) std::memcpy(values.data(), from.data(), from.size());
        return values;
    }

  private:
    std::string_view take(std::size_t size) {
        FIDSERVO_DEMAND(size <= bytes_.size());
        const std::string_view taken = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return taken;
    }
    std::string_view bytes_;
};

}  // namespace

std::string to_bytes(const Log& log) {
    ByteWriter bytes;
    bytes.number(log.signals.size());
    for (const LoggedSignal& signal : log.signals) {
        bytes.text(signal.name);
        bytes.text(signal.unit);
        bytes.list(signal.values);
        bytes.list(signal.whole);
        bytes.text(signal.times);
        bytes.text(signal.fault);
        bytes.number(static_cast<std::uint64_t>(signal.decimals) + 1);
    }
    bytes.number(log.texts.size());
    for (const auto& [name, text] : log.texts) {
        bytes.text(name);
        bytes.text(text);
    }
    bytes.number(log.notes.size());
    for (const std::string& note : log.notes) bytes.text(note);
    return bytes.take();
}

Log from_bytes(std::string_view from) {
    ByteReader bytes(from);
    Log log;
    log.signals.resize(bytes.number());
    for (LoggedSignal& signal : log.signals) {
        signal.name = bytes.text();
        signal.unit = bytes.text();
        signal.values = bytes.list<double>();
        signal.whole = bytes.list<std::int64_t>();
        signal.times = bytes.text();
        signal.fault = bytes.text();
        signal.decimals = static_cast<int>(bytes.number()) - 1;
    }
    for (std::uint64_t left = bytes.number(); left > 0; --left) {
        std::string name = bytes.text();
        log.texts[std::move(name)] = bytes.text();
    }
    for (std::uint64_t left = bytes.number(); left > 0; --left) log.notes.push_back(bytes.text());
    return log;
}

}  // namespace fidservo::imports

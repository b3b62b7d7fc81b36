// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The boundary to a data acquisition board, in Comedi's terms: subdevices, channels, ranges. The real one is
// libcomedi (libcomedi_link.h); tests put a board of their own in its place.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::control::comedi {

enum class SubdeviceKind : std::uint8_t {
    none,  ///< there is no such subdevice
    analogue_in,
    analogue_out,
    digital_in,
    digital_out,
    digital_io,
    counter,
    other
};

/// The kind in words: "analogue input" and so on.
std::string_view name_of(SubdeviceKind kind);

struct VoltageRange {
    double low_V;
    double high_V;
    bool operator==(const VoltageRange&) const = default;
};

/// A channel of a subdevice in one of its ranges.
struct Address {
    int subdevice = 0;
    int channel = 0;
    int range = 0;
};

class BoardLink {
  public:
    BoardLink() = default;
    BoardLink(const BoardLink&) = delete;
    BoardLink& operator=(const BoardLink&) = delete;
    virtual ~BoardLink() = default;

    /// Name of the board and of its driver: "multiq3 (driver multiq3)".
    virtual std::string name() const = 0;
    virtual SubdeviceKind kind(int subdevice) const = 0;
    virtual int channels(int subdevice) const = 0;
    /// The largest value that the channel's converter or counter takes on.
    virtual std::uint32_t max_value(int subdevice, int channel) const = 0;
    /// All ranges of a channel, by their Comedi index. A range that is not in volts (mA, or without unit) is
    /// empty: low_V = high_V.
    virtual std::vector<VoltageRange> ranges(int subdevice, int channel) const = 0;

    /// Configures a bidirectional digital line as an output. False if the device refused.
    [[nodiscard]] virtual bool make_output(int subdevice, int channel) noexcept = 0;
    /// Reads or writes a channel's raw value. False if the device refused. Neither call waits or allocates.
    [[nodiscard]] virtual bool read(const Address& at, std::uint32_t& value) noexcept = 0;
    [[nodiscard]] virtual bool write(const Address& at, std::uint32_t value) noexcept = 0;
};

}  // namespace fidservo::control::comedi

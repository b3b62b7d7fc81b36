// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A board in memory: a test defines its subdevices, reads its registers, and can make it refuse requests.
#include "control/comedi/board_link.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace fidservo::control::comedi {

struct FakeSubdevice {
    SubdeviceKind kind;
    int channels;
    std::uint32_t max_value;
    std::vector<VoltageRange> ranges;
};

/// The registers, which a test can see although the board belongs to the program.
struct FakeRegisters {
    std::map<std::pair<int, int>, std::uint32_t> values;    ///< by subdevice and channel
    std::vector<std::pair<Address, std::uint32_t>> writes;  ///< in order
    bool refuses = false;
    int lines_made_outputs = 0;
};

class FakeBoard final : public BoardLink {
  public:
    FakeBoard(std::vector<FakeSubdevice> subdevices, std::shared_ptr<FakeRegisters> registers)
        : subdevices_(std::move(subdevices)), registers_(std::move(registers)) {}

    std::string name() const override { return "fake board"; }
    SubdeviceKind kind(int subdevice) const override {
        return subdevice < static_cast<int>(subdevices_.size()) ? at(subdevice).kind : SubdeviceKind::none;
    }
    int channels(int subdevice) const override { return at(subdevice).channels; }
    std::uint32_t max_value(int subdevice, int) const override { return at(subdevice).max_value; }
    std::vector<VoltageRange> ranges(int subdevice, int) const override { return at(subdevice).ranges; }
    bool make_output(int, int) noexcept override {
        ++registers_->lines_made_outputs;
        return !registers_->refuses;
    }
    bool read(const Address& at, std::uint32_t& value) noexcept override {
        value = registers_->values[{at.subdevice, at.channel}];
        return !registers_->refuses;
    }
    bool write(const Address& at, std::uint32_t value) noexcept override {
        registers_->values[{at.subdevice, at.channel}] = value;
        registers_->writes.emplace_back(at, value);
        return !registers_->refuses;
    }

  private:
    const FakeSubdevice& at(int subdevice) const { return subdevices_[static_cast<std::size_t>(subdevice)]; }

    std::vector<FakeSubdevice> subdevices_;
    std::shared_ptr<FakeRegisters> registers_;
};

/// The MultiQ-3 as its driver describes it: 13-bit inputs and 12-bit outputs of +-5 V, 24-bit counters.
inline std::vector<FakeSubdevice> multiq3() {
    constexpr VoltageRange five{-5.0, 5.0};
    return {{SubdeviceKind::analogue_in, 8, 0x1fff, {five}},
            {SubdeviceKind::analogue_out, 8, 0xfff, {five}},
            {SubdeviceKind::digital_in, 16, 1, {}},
            {SubdeviceKind::digital_out, 16, 1, {}},
            {SubdeviceKind::counter, 4, 0xffffff, {}}};
}

/// comedi_test: 16 bit, +-10 V or +-5 V, analogue only.
inline std::vector<FakeSubdevice> analogue_board() {
    const std::vector<VoltageRange> ranges{{-10.0, 10.0}, {-5.0, 5.0}};
    return {{SubdeviceKind::analogue_in, 8, 0xffff, ranges},
            {SubdeviceKind::analogue_out, 8, 0xffff, ranges}};
}

/// Motor on the first output, wire on the second, Hall sensor on the first input, encoder on the first
/// counter.
inline ChannelMap multiq3_map() {
    ChannelMap map;
    map.macro.output = {1, 0, {}};
    map.micro = {1, 1, {}};
    map.hall = {0, 0, {}};
    map.encoder.input = {4, 0, {}};
    return map;
}

}  // namespace fidservo::control::comedi

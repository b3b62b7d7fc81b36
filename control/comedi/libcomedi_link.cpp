// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/comedi/libcomedi_link.h"

#include "core/input_error.h"

#include <comedilib.h>

namespace fidservo::control::comedi {

namespace {

constexpr int done = 1;  ///< what single instructions return on success

unsigned of(int number) {
    return static_cast<unsigned>(number);
}

class LibcomediLink final : public BoardLink {
  public:
    explicit LibcomediLink(const std::filesystem::path& node) : device_(::comedi_open(node.c_str())) {
        if (device_ == nullptr)
            throw RunFault(node.string() + ": cannot be opened: " + ::comedi_strerror(::comedi_errno()));
        if (::comedi_get_n_subdevices(device_) <= 0) {
            ::comedi_close(device_);
            throw RunFault(node.string() + ": no board is configured there (comedi_config)");
        }
    }
    ~LibcomediLink() override { ::comedi_close(device_); }

    std::string name() const override {
        return std::string(::comedi_get_board_name(device_)) + " (driver " +
               ::comedi_get_driver_name(device_) + ")";
    }

    SubdeviceKind kind(int subdevice) const override {
        if (subdevice < 0 || subdevice >= ::comedi_get_n_subdevices(device_)) return SubdeviceKind::none;
        switch (::comedi_get_subdevice_type(device_, of(subdevice))) {
            case COMEDI_SUBD_UNUSED:
                return SubdeviceKind::none;
            case COMEDI_SUBD_AI:
                return SubdeviceKind::analogue_in;
            case COMEDI_SUBD_AO:
                return SubdeviceKind::analogue_out;
            case COMEDI_SUBD_DI:
                return SubdeviceKind::digital_in;
            case COMEDI_SUBD_DO:
                return SubdeviceKind::digital_out;
            case COMEDI_SUBD_DIO:
                return SubdeviceKind::digital_io;
            case COMEDI_SUBD_COUNTER:
                return SubdeviceKind::counter;
            default:
                return SubdeviceKind::other;
        }
    }

    int channels(int subdevice) const override { return ::comedi_get_n_channels(device_, of(subdevice)); }

    std::uint32_t max_value(int subdevice, int channel) const override {
        return ::comedi_get_maxdata(device_, of(subdevice), of(channel));
    }

    std::vector<VoltageRange> ranges(int subdevice, int channel) const override {
        std::vector<VoltageRange> all;
        const int count = ::comedi_get_n_ranges(device_, of(subdevice), of(channel));
        for (int k = 0; k < count; ++k) {
            const comedi_range* const range = ::comedi_get_range(device_, of(subdevice), of(channel), of(k));
            const bool in_volts = range != nullptr && range->unit == UNIT_volt;
            all.push_back(in_volts ? VoltageRange{range->min, range->max} : VoltageRange{0.0, 0.0});
        }
        return all;
    }

    bool make_output(int subdevice, int channel) noexcept override {
        return ::comedi_dio_config(device_, of(subdevice), of(channel), COMEDI_OUTPUT) >= 0;
    }

    bool read(const Address& at, std::uint32_t& value) noexcept override {
        lsampl_t got = 0;
        if (::comedi_data_read(device_, of(at.subdevice), of(at.channel), of(at.range), AREF_GROUND, &got) !=
            done)
            return false;
        value = got;
        return true;
    }

    bool write(const Address& at, std::uint32_t value) noexcept override {
        return ::comedi_data_write(device_, of(at.subdevice), of(at.channel), of(at.range), AREF_GROUND,
                                   value) == done;
    }

  private:
    comedi_t* device_;
};

}  // namespace

std::unique_ptr<BoardLink> open_board(const std::filesystem::path& node) {
    return std::make_unique<LibcomediLink>(node);
}

}  // namespace fidservo::control::comedi

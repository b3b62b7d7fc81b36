// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/output_board.h"

#include "core/input_error.h"

#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <new>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace fidservo::control {

namespace {

[[noreturn]] void throw_board_fault(const std::filesystem::path& file, int error) {
    throw RunFault(file.string() + ": registers of the simulated board: " + std::strerror(error));
}

/// A new or existing file with room for the registers on the disk: a store to a hole of a full disk would be
/// a bus error.
int open_with_room(const std::filesystem::path& file, std::size_t bytes) {
    const int fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (fd < 0) throw_board_fault(file, errno);
    if (const int error = ::posix_fallocate(fd, 0, static_cast<off_t>(bytes)); error != 0) {
        ::close(fd);
        throw_board_fault(file, error);
    }
    return fd;
}

}  // namespace

struct SimulatedBoard::Registers {
    std::atomic<double> macro_V;
    std::atomic<double> micro_V;
};

SimulatedBoard::SimulatedBoard(const std::filesystem::path& file) {
    const int fd = open_with_room(file, sizeof(Registers));
    void* const mapped = ::mmap(nullptr, sizeof(Registers), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    const int error = errno;
    ::close(fd);
    if (mapped == MAP_FAILED) throw_board_fault(file, error);
    registers_ = new (mapped) Registers{0.0, 0.0};
}

SimulatedBoard::~SimulatedBoard() {
    ::munmap(registers_, sizeof(Registers));
}

bool SimulatedBoard::write(const StageCommand& command) noexcept {
    registers_->macro_V.store(command.macro_V);
    registers_->micro_V.store(command.micro_V);
    return true;
}

StageCommand SimulatedBoard::outputs(const std::filesystem::path& file) {
    std::array<double, 2> volts{};
    std::ifstream in(file, std::ios::binary);
    if (!in.read(reinterpret_cast<char*>(volts.data()), sizeof volts)) {
        throw RunFault(file.string() + ": not the registers of a simulated board");
    }
    return {volts[0], volts[1]};
}

}  // namespace fidservo::control

// SPDX-License-Identifier: GPL-3.0-or-later
// The test program's own operator new. It stands apart from the tests: were it inlined into them, the
// compiler would take its free() for a mismatch.
#include "tests/plant/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace fidservo::plant {

long allocation_count() {
    return allocations;
}

}  // namespace fidservo::plant

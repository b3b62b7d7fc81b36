// SPDX-License-Identifier: GPL-3.0-or-later
// One fuzzer: libFuzzer's entry to the target FIDSERVO_FUZZ_TARGET.
#include "tests/fuzz/targets.h"

#include <cstddef>
#include <cstdint>

#include <opencv2/core/utils/logger.hpp>

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    fidservo::fuzz::FIDSERVO_FUZZ_TARGET({reinterpret_cast<const char*>(bytes), size});
    return 0;
}

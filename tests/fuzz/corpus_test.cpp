// SPDX-License-Identifier: GPL-3.0-or-later
// What the fuzzers start from and what they found, read once more by every build.
#include "tests/fuzz/targets.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::fuzz {
namespace {

namespace fs = std::filesystem;

TEST(FuzzCorpus, EveryFile_IsReadOrRefusedInOrder) {
    for (const auto& [name, target] : targets) {
        int files = 0;
        for (const auto& entry : fs::directory_iterator(fs::path(FIDSERVO_FUZZ_CORPUS) / name)) {
            SCOPED_TRACE(entry.path().string());
            std::ifstream stream(entry.path(), std::ios::binary);
            const std::string bytes((std::istreambuf_iterator<char>(stream)),
                                    std::istreambuf_iterator<char>());
            EXPECT_NO_THROW(target(bytes));
            ++files;
        }
        EXPECT_GT(files, 0) << name;
    }
}

}  // namespace
}  // namespace fidservo::fuzz

// SPDX-License-Identifier: GPL-3.0-or-later
// Names under which what an interrupted run left is kept.
#include "src/files/disk/output_paths.h"

#include "tests/src/temporary_folder.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using std::filesystem::exists;

TEST(SetAside, FolderWithADotInItsName_KeepsTheWholeName) {
    const testing::TemporaryFolder folder;
    for (int times = 0; times < 2; ++times) {
        std::filesystem::create_directory(folder / "pulses-4.5");
        set_aside(folder / "pulses-4.5");
        EXPECT_FALSE(exists(folder / "pulses-4.5"));
    }
    EXPECT_TRUE(exists(folder / "pulses-4.5.interrupted-1"));
    EXPECT_TRUE(exists(folder / "pulses-4.5.interrupted-2"));
}

TEST(SetAside, File_KeepsItsExtension) {
    const testing::TemporaryFolder folder;
    folder.write("site.7.png", "");
    set_aside(folder / "site.7.png");
    EXPECT_TRUE(exists(folder / "site.7.interrupted-1.png"));
    set_aside(folder / "site.7.png");
    EXPECT_FALSE(exists(folder / "site.7.interrupted-2.png")) << "there was nothing to set aside";
}

}  // namespace
}  // namespace fidservo

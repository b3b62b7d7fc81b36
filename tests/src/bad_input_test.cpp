// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong input gives one clear line and the right exit code, and nothing is overwritten. On the real
// executable.
#include "core/rig.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::ProgramRun;
using testing::run_program;
using testing::TemporaryFolder;
using testing::text_of;

/// Runs it and demands one line on stderr that holds the pieces.
void expect_refusal(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    int exit_code, const std::vector<std::string>& pieces, rlim_t most_bytes = 0) {
    const ProgramRun run = run_program(arguments, folder, most_bytes);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(run.err.starts_with("fidservo: ")) << run.err;
    for (const std::string& piece : pieces)
        EXPECT_NE(run.err.find(piece), std::string::npos) << piece << "\n" << run.err;
}

std::string reference_rig_with(const std::string& piece, const std::string& replacement) {
    std::string text = text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    const auto place = text.find(piece);
    EXPECT_NE(place, std::string::npos) << piece;
    return text.replace(place, piece.size(), replacement);
}

TEST(Program, Help_IsThereForEveryCommand) {
    const TemporaryFolder folder;
    const ProgramRun help = run_program({"--help"}, folder.path());
    EXPECT_EQ(help.exit_code, 0);
    for (const char* command : {"replay", "simulate", "record", "cameras"}) {
        EXPECT_NE(help.out.find(command), std::string::npos) << command;
        const ProgramRun run = run_program({command, "--help"}, folder.path());
        EXPECT_EQ(run.exit_code, 0) << command;
        EXPECT_NE(run.out.find(std::string("Example:\n  fidservo ") + command), std::string::npos) << run.out;
    }
}

TEST(Program, DrillOfARealDevice_IsRefusedBeforeItIsTouched) {
    const TemporaryFolder folder;
    const std::string recipe = FIDSERVO_ASSETS_DIR "/demo/recipe.yaml", rig = FIDSERVO_ASSETS_DIR "/rig.yaml";
    for (const auto& device :
         {std::vector<std::string>{"--camera", "v4l2:/dev/null"}, {"--stage", "comedi:/dev/null"}})
        expect_refusal(
            {"inspect", recipe, "--rig", rig, "--out", "o", "--fault", "hall_stuck", device[0], device[1]},
            folder.path(), 2, {"--fault hall_stuck", "simulated"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(Program, UnknownCommandOrOption_ExitsWithTwo) {
    const TemporaryFolder folder;
    expect_refusal({"replai"}, folder.path(), 2,
                   {"replai: unknown command", "did you mean replay?", "simulate"});
    expect_refusal({}, folder.path(), 2, {"a command is needed", "replay"});
    expect_refusal({"replay", "--colour", "x"}, folder.path(), 2, {"--colour", "fidservo replay --help"});
    expect_refusal({"simulate", "rest"}, folder.path(), 2, {"--out", "required"});
    expect_refusal({"simulate", "dance", "--out", "o"}, folder.path(), 2,
                   {"dance: unknown experiment", "macro-pulses", "campaign"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Program, Cameras_AreListedOrSaidToBeMissing) {
    const TemporaryFolder folder;
    const ProgramRun run = run_program({"cameras"}, folder.path());
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_TRUE(run.out == "no camera found\n" || run.out.starts_with("v4l2:/dev/video")) << run.out;
}

TEST(Program, WrongRigFile_ExitsWithTwoAndMakesNothing) {
    const TemporaryFolder folder;
    std::filesystem::copy_file(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "preisach_fod.csv",
                               folder / "preisach_fod.csv");
    const struct {
        const char* piece;
        const char* replacement;
        const char* expected;
    } mistakes[] = {
        {"blur_px: 0.8", "blur_mm: 0.8", "camera.blur_mm: 0.8: unknown key; did you mean blur_px, in px?"},
        {"width_px: 1280", "width_px: [1280]", "camera.width_px: a list: must be a whole number"},
        {"tick_s: 0.001", "tick_s: 1 ms", "tick_s: 1 ms: must be a number in s"},
        {"slope: 0.636", "slope: -1", "macro.dead_zone.slope: -1: must be a number above 0"}};
    for (const auto& mistake : mistakes) {
        const auto file = folder.write("rig.yaml", reference_rig_with(mistake.piece, mistake.replacement));
        expect_refusal({"simulate", "rest", "--rig", "rig.yaml", "--out", "o"}, folder.path(), 2,
                       {"rig.yaml:", mistake.expected});
    }
    expect_refusal({"simulate", "rest", "--rig", "none.yaml", "--out", "o"}, folder.path(), 2,
                   {"none.yaml: cannot be opened"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(Program, FormulaThatGivesNoNumber_IsNamedWithFileAndValue) {
    const TemporaryFolder folder;
    const std::string formula =
        "  - name: own\n"
        "    block: macro.friction\n"
        "    acts_on: macro.friction\n"
        "    formula: size * sqrt(place - 1000)\n"
        "    parameters:\n"
        "      size: {bounds: [0, 1], typical: 0.1}\n";
    folder.write("effects.yaml", "format: fidservo-effects/1\neffects:\n" + formula);
    const std::string rig = text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    folder.write("rig.yaml", rig.substr(0, rig.find("micro:")) + "\neffects:\n" + formula);
    expect_refusal({"simulate", "rest", "--effects-file", "effects.yaml", "--out", "o"}, folder.path(), 2,
                   {"effects.yaml: own: its formula gives no number at place = ", "allowed: numbers up to"});
    expect_refusal({"simulate", "rest", "--rig", "rig.yaml", "--out", "o"}, folder.path(), 2,
                   {"rig.yaml: own: its formula gives no number at place = "});
}

TEST(Program, WrongEffect_ExitsWithTwo) {
    const TemporaryFolder folder;
    expect_refusal({"simulate", "rest", "--effect", "gravity", "--out", "o"}, folder.path(), 2, {"gravity"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(Program, ExistingOutputFolder_IsNotTouched) {
    const TemporaryFolder folder;
    folder.write("o/precious.txt", "keep");
    folder.write("image.png", "");
    expect_refusal({"simulate", "rest", "--out", "o"}, folder.path(), 2, {"o: exists already"});
    expect_refusal({"replay", "image.png", "--out", "o"}, folder.path(), 2, {"o: exists already"});
    EXPECT_EQ(text_of(folder / "o/precious.txt"), "keep");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "o"), {}), 1);
}

TEST(Program, ReplayInputsThatCannotBeRead_ExitWithTwo) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "empty");
    folder.write("broken.png", "\x89PNG\r\n\x1a\nnot an image");
    folder.write("text.jpg", "not an image");
    folder.write("video.avi", "not a video");
    folder.write("frames/cam0/data.csv", "#timestamp [ns],filename\n20,a.png\n10,b.png\n");
    expect_refusal({"replay", "none.png"}, folder.path(), 2, {"none.png: there is no such file or folder"});
    expect_refusal({"replay", "empty"}, folder.path(), 2, {"empty: holds no image", ".png"});
    expect_refusal({"replay", "frames"}, folder.path(), 2, {"frames/cam0/data.csv:3: timestamp: 10"});
    expect_refusal({"replay", "video.avi"}, folder.path(), 2, {"video.avi: cannot be read as a video"});
    for (const char* name : {"broken.png", "text.jpg"}) {
        const ProgramRun run = run_program({"replay", name}, folder.path());
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_NE(run.err.find(std::string(name) + ": cannot be read as an image"), std::string::npos)
            << run.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "replay-out"));
}

TEST(Program, GotoThatCannotBe_ExitsWithTwoBeforeAnythingMoves) {
    const TemporaryFolder folder;
    expect_refusal({"goto", "--tag", "12", "--dx-um", "nan"}, folder.path(), 2, {"--dx-um: nan"});
    expect_refusal({"goto", "--tag", "12", "--hold", "nan"}, folder.path(), 2, {"--hold: nan"});
    expect_refusal({"goto", "--tag", "100", "--dx-um", "1e9"}, folder.path(), 2,
                   {"--dx-um", "allowed at tag 100: -199800 to 3800 um"});
}

TEST(Program, InspectionWithAReferenceThatIsNoImage_ExitsWithTwoBeforeItBegins) {
    const TemporaryFolder folder;
    folder.write("golden.png", "not an image");
    folder.write("recipe.yaml",
                 "name: Golden\n"
                 "plate:\n"
                 "  grid: { columns: 3, rows: 1, pitch_mm: [2.0, 0.0], first_id: 0, side_mm: 1.2 }\n"
                 "sites: { tags: [1] }\n"
                 "views:\n"
                 "  - name: above\n"
                 "    offset_um: 0\n"
                 "    checks: [{ reference: { longest_defect_um: 25, image: golden.png } }]\n");
    expect_refusal({"inspect", "recipe.yaml", "--out", "o"}, folder.path(), 2,
                   {"golden.png: cannot be read as an image"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(Program, FullDisk_ExitsWithThreeAndSaysSo) {
    const TemporaryFolder folder;
    constexpr rlim_t most_bytes = 50'000;
    const ProgramRun run = run_program({"simulate", "rest", "--out", "o"}, folder.path(), most_bytes);
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find("stage0/data.csv: cannot be written: File too large"), std::string::npos)
        << run.err;
}

}  // namespace
}  // namespace fidservo

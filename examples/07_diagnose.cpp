// SPDX-License-Identifier: GPL-3.0-or-later
// Where recordings of a rig and its simulator disagree, and by which effect.
//
//     07_diagnose RIG.yaml FOLDER [EFFECT...]     the effects to try; all, if none is named
#include "core/rig.h"
#include "gap/diagnose.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/rig_file.h"

#include <cstdio>
#include <string>
#include <vector>

namespace {

void diagnose(const char* rig_file, const char* folder, std::vector<std::string> effects) {
    using namespace fidservo;
    std::vector<Recording> recordings;
    for (const auto& one : find_recordings(folder)) recordings.push_back(read_recording(one));

    // The evidence: windows of the recordings, and what the rig as its file describes it predicts of them.
    const gap::Evidence evidence(load_rig(rig_file), std::move(recordings));
    gap::DiagnosisOptions options;
    options.only = std::move(effects);
    const gap::Diagnosis diagnosis = gap::diagnose(evidence, options);

    std::printf("gap: %.3g floors before, %.3g after\n", diagnosis.gap.before, diagnosis.gap.after);
    for (const gap::FoundEffect& effect : diagnosis.effects) {
        std::printf("%s (%s), probability %.2f\n", effect.effect.c_str(), effect.block.c_str(),
                    effect.probability);
        for (const auto& parameter : effect.parameters)
            std::printf("    %s = %.6g +- %.2g %s\n", parameter.name.c_str(), parameter.value, parameter.std,
                        parameter.unit.c_str());
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: 07_diagnose RIG.yaml FOLDER [EFFECT...]\n");
        return 2;
    }
    try {
        diagnose(argv[1], argv[2], {argv + 3, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "07_diagnose: %s\n", error.what());
        return 2;
    }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The scripts and the manifest in deploy/ are what their engines take.
#include "tests/src/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;

const std::string deploy = FIDSERVO_SOURCE_DIR "/deploy/";

TEST(Deploy, Manifest_IsAnIndexedJobOfAsManyShardsAsItHasPods) {
    const YAML::Node job = YAML::LoadFile(deploy + "kubernetes/fleet.yaml");
    EXPECT_EQ(job["apiVersion"].as<std::string>(), "batch/v1");
    EXPECT_EQ(job["kind"].as<std::string>(), "Job");
    EXPECT_FALSE(job["metadata"]["name"].as<std::string>().empty());
    const YAML::Node spec = job["spec"];
    EXPECT_EQ(spec["completionMode"].as<std::string>(), "Indexed");
    EXPECT_LE(spec["parallelism"].as<int>(), spec["completions"].as<int>());
    EXPECT_LE(spec["maxFailedIndexes"].as<int>(), spec["completions"].as<int>());
    // A policy for failed pods asks for this one.
    const YAML::Node pod = spec["template"]["spec"];
    EXPECT_EQ(pod["restartPolicy"].as<std::string>(), "Never");
    const YAML::Node container = pod["containers"][0];
    EXPECT_EQ(container["env"][0]["name"].as<std::string>(), "SHARDS");
    EXPECT_EQ(container["env"][0]["value"].as<std::string>(), spec["completions"].as<std::string>());
    EXPECT_THAT(container["args"][0].as<std::string>(),
                HasSubstr("--shard \"$((JOB_COMPLETION_INDEX + 1))/$SHARDS\""));
    for (const YAML::Node& rule : spec["podFailurePolicy"]["rules"])
        if (rule["onExitCodes"]) {
            EXPECT_EQ(rule["onExitCodes"]["containerName"].as<std::string>(),
                      container["name"].as<std::string>());
            EXPECT_EQ(rule["onExitCodes"]["operator"].as<std::string>(), "In");
            EXPECT_TRUE(rule["onExitCodes"]["values"].IsSequence());
        }
    EXPECT_EQ(container["volumeMounts"][0]["name"].as<std::string>(),
              pod["volumes"][0]["name"].as<std::string>());
}

TEST(Deploy, Scripts_AreBash) {
    for (const char* script : {"slurm/fleet.sbatch", "parallel/fleet.sh"})
        EXPECT_EQ(std::system(("bash -n " + deploy + script).c_str()), 0) << script;
}

TEST(Deploy, SlurmScript_TellsTheProgramItsShare) {
    const testing::TemporaryFolder folder;
    const auto program = folder.write("program", "#!/bin/bash\nprintf '<%s>' \"$@\"; exit 1\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string command =
        "FIDSERVO=" + program.string() +
        " SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_COUNT=16 SLURM_CPUS_PER_TASK=2 bash " + deploy +
        "slurm/fleet.sbatch diagnose 'a b' --out c >" + (folder / "said").string();
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
    EXPECT_EQ(testing::text_of(folder / "said"),
              "<fleet><diagnose><a b><--out><c><--shard><3/16><--jobs><2>");
}

}  // namespace
}  // namespace fidservo

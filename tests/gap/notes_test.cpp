// SPDX-License-Identifier: GPL-3.0-or-later
// What a diagnosis notes beside its numbers.
#include "gap/notes.h"

#include "core/rig.h"
#include "gap/evidence.h"
#include "tests/gap/simulated_campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using ::testing::AllOf;
using testing::campaign;
using testing::effects;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Notes, RigAsItsFileSays_NeedsNone) {
    Diagnosis diagnosis;
    add_notes(campaign({}, {"rest"}), {}, diagnosis);
    EXPECT_THAT(diagnosis.notes, IsEmpty());
}

TEST(Notes, DiscrepancyThatDoesNotMatter_IsStatedWithItsLimit) {
    Diagnosis diagnosis;
    diagnosis.signals = {{Signal::encoder, 3.0, 2.0, 0.3, 1.9}, {Signal::hall, 3.0, 2.0, 0.5, 1.9}};
    SignalLimits matters{};
    matters[index_of(Signal::encoder)] = 5.0;
    matters[index_of(Signal::hall)] = 1.0;  // less than what is left: a gap, not a note
    add_notes(campaign({}, {"rest"}), matters, diagnosis);
    EXPECT_THAT(diagnosis.notes, ElementsAre(AllOf(HasSubstr("encoder"), HasSubstr("1.9"), HasSubstr("5"))));
}

TEST(Notes, EffectThatTheRigFileStates_IsStatedAsWhatBothComeTo) {
    Rig rig = reference_rig();
    rig.effects.push_back({.name = "hall_offset", .parameters = {{.name = "offset_V", .value = 0.02}}});
    const Evidence evidence(rig, testing::recordings_of({}, {"rest"}));
    Diagnosis diagnosis;
    diagnosis.hypothesis = effects({"hall_offset:offset_V=0.015"});
    add_notes(evidence, {}, diagnosis);
    EXPECT_THAT(diagnosis.notes, ElementsAre(AllOf(HasSubstr("hall_offset"), HasSubstr("0.035"))));
}

TEST(Notes, HallReadingThatScattersMoreThanTheRigFileSays_IsStated) {
    Rig noisy = reference_rig();
    noisy.micro->hall.noise_lsb *= 5.0;
    Diagnosis diagnosis;
    add_notes(campaign({}, {"rest"}, noisy), {}, diagnosis);
    EXPECT_THAT(diagnosis.notes, ElementsAre(AllOf(HasSubstr("hall"), HasSubstr("scatter"))));
}

}  // namespace
}  // namespace fidservo

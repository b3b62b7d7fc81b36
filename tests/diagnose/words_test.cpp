// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/words.h"

#include "gap/residuals/surrogate.h"
#include "plant/effects/catalogue.h"
#include "src/diagnose/advice.h"
#include "src/diagnose/verdict_words.h"

#include <cctype>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Words, ThreeDigits_KeepTheirMeaning) {
    EXPECT_EQ(three_digits(0.0), "0");
    EXPECT_EQ(three_digits(0.03124), "0.0312");
    EXPECT_EQ(three_digits(1.046), "1.05");
    EXPECT_EQ(three_digits(9.999), "10.0");
    EXPECT_EQ(three_digits(30.34), "30.3");
    EXPECT_EQ(three_digits(-999.4), "\u2212999");
    EXPECT_EQ(three_digits(999.6), "1\u202f000");
    EXPECT_EQ(three_digits(12403.0), "12\u202f400");
    EXPECT_EQ(three_digits(2081316.0), "2.08\u00d710\u2076");
    EXPECT_EQ(three_digits(1.5e-12), "1.50\u00d710\u207b\u00b9\u00b2");
    EXPECT_EQ(three_digits(std::numeric_limits<double>::quiet_NaN()), "\u2013");
}

TEST(Words, Enumeration_ReadsAsASentence) {
    EXPECT_EQ(enumerated({}), "");
    EXPECT_EQ(enumerated({"a"}), "a");
    EXPECT_EQ(enumerated({"a", "b"}), "a and b");
    EXPECT_EQ(enumerated({"a", "b", "c"}), "a, b and c");
}

TEST(Words, Dependence_PeriodIsPartOfTheSentence) {
    EXPECT_EQ(dependence_words("position, periodic (2.5 mm)"), "position with a period of 2.5 mm");
    EXPECT_EQ(dependence_words("velocity"), "velocity");
}

TEST(Words, SizeClasses_BeginAboveTheFloor) {
    EXPECT_EQ(size_class(0.2), 0);
    EXPECT_EQ(size_class(1.1), 0);
    EXPECT_EQ(size_class(1.5), 1);
    EXPECT_EQ(size_class(3.0), 2);
    EXPECT_EQ(size_class(19.0), 3);
    EXPECT_EQ(size_class(300.0), 4);
}

TEST(Advice, EveryEffectOfTheCatalogue_HasOneAndNoOther) {
    std::set<std::string_view> advised, known;
    for (const Advice& advice : all_advice())
        EXPECT_TRUE(advised.insert(advice.effect).second) << advice.effect;
    for (const plant::Effect* effect : plant::effect_catalogue()) known.insert(effect->name);
    EXPECT_EQ(advised, known);
}

TEST(Advice, Texts_AreAClauseAndSentences) {
    for (const Advice& advice : all_advice()) {
        ASSERT_FALSE(advice.what.empty() || advice.check.empty() || advice.cure.empty()) << advice.effect;
        EXPECT_TRUE(std::islower(static_cast<unsigned char>(advice.what.front())) ||
                    advice.what.starts_with("Hall"))
            << advice.what;
        EXPECT_NE(advice.what.back(), '.') << advice.what;
        for (const std::string_view sentence : {advice.check, advice.cure}) {
            EXPECT_TRUE(std::isupper(static_cast<unsigned char>(sentence.front()))) << sentence;
            EXPECT_EQ(sentence.back(), '.') << sentence;
        }
    }
}

TEST(Advice, EverythingThatARemainderCanDependOn_HasOne) {
    for (int k = 0; k <= static_cast<int>(gap::Dependence::image_place); ++k) {
        const std::string_view name = gap::name_of(static_cast<gap::Dependence>(k));
        EXPECT_FALSE(advice_on_dependence(name).empty()) << name;
    }
    EXPECT_NE(advice_on_dependence("position, periodic (2.5 mm)"), advice_on_dependence("position"));
}

TEST(Verdict, EachKind_SaysWhatItMeans) {
    gap::Diagnosis diagnosis;
    EXPECT_THAT(verdict_sentence(diagnosis), HasSubstr("Nothing in these recordings could be judged"));

    diagnosis.signals = {{gap::Signal::hall, 0.66, 0.66, 0.65}};
    diagnosis.gap = {1.01, 1.01};
    EXPECT_THAT(verdict_sentence(diagnosis), HasSubstr("No gap"));
    EXPECT_THAT(verdict_detail(diagnosis), HasSubstr("1.01 noise floors"));

    diagnosis.gap = {1.7, 1.7};
    EXPECT_THAT(verdict_detail(diagnosis), HasSubstr("more or longer recordings"));

    diagnosis.verdict = gap::Verdict::explained;
    diagnosis.gap = {30.3, 1.03};
    gap::FoundEffect& effect = diagnosis.effects.emplace_back();
    effect.effect = "hall_gain";
    effect.indistinguishable_from = {"stroke_change"};
    EXPECT_THAT(verdict_sentence(diagnosis), HasSubstr(std::string(advice_on("hall_gain")->what)));
    EXPECT_THAT(verdict_detail(diagnosis), HasSubstr("30.3 noise floors"));
    EXPECT_THAT(verdict_detail(diagnosis), HasSubstr("cannot tell hall gain from stroke change"));

    diagnosis.verdict = gap::Verdict::partly_explained;
    diagnosis.unexplained = gap::Remainder{"macro.friction", {"velocity"}, "text"};
    EXPECT_THAT(verdict_sentence(diagnosis), HasSubstr("in part because"));
    EXPECT_THAT(verdict_detail(diagnosis), HasSubstr("the friction of the carriage, dependent on velocity"));

    diagnosis.verdict = gap::Verdict::unexplained;
    diagnosis.effects.clear();
    EXPECT_THAT(verdict_sentence(diagnosis), HasSubstr("no known effect explains it"));
    EXPECT_THAT(verdict_sentence(diagnosis), Not(HasSubstr("because")));
}

}  // namespace
}  // namespace fidservo::diagnose

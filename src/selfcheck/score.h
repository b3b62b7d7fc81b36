#pragma once
// A diagnosis compared with what its case was made with. Labels are opened here only.
//
// Effects are compared by class. An effect that is found stands for the set of classes that it is said to be
// indistinguishable from, itself included: it is right if the truth is in its set.
#include "gap/diagnosis.h"
#include "src/selfcheck/label.h"

#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// A wrong name with this probability or more is a confident wrong name.
inline constexpr double confident = 0.9;

struct Score {
    gap::Verdict verdict = gap::Verdict::no_gap;
    /// Over the signals: the largest r.m.s. error of the rig file's prediction, in floors.
    double floors = 0.0;
    double before = 1.0, after = 1.0, removed = 0.0;  ///< gap over all signals

    std::vector<std::string> named;  ///< classes of the effects found, in order
    std::string first_block;         ///< empty: none
    double first_probability = 0.0;  ///< of the first effect; 0 where none is named
    std::size_t set_size = 0;        ///< of the first effect's set, in classes

    bool right_block_first = false;  ///< of any true effect or of one of its class
    bool right_effect_first = false;
    bool any_right = false;           ///< an effect found is a true one
    bool all_right = false;           ///< each true effect is found, and no other
    bool is_confident_wrong = false;  ///< one that is found is none of the case's and claims to be sure
    bool says_unexplained = false;    ///< verdict unexplained or partly-explained
};

/// Of a case with an effect withheld, or with one that the catalogue lacks, every name is wrong.
Score score(const Label& label, const gap::Diagnosis& diagnosis);

}  // namespace fidservo::selfcheck

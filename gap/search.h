#pragma once
// One step of a search: which effect, added to what is known, predicts best what was not fitted.
#include "gap/candidate.h"
#include "gap/fit.h"
#include "gap/score.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// A hypothesis fitted on each half of the windows (gap/halves.h).
struct CrossFit {
    std::array<Hypothesis, 2> of_half;
    std::vector<double> mean_squares;  ///< S_w of every window, predicted by what was fitted without its half
    double loss = 0.0;                 ///< of them all
};

/// A candidate that was added to a hypothesis. What promised little was not fitted: no gain, no squares.
struct Trial {
    const Candidate* candidate = nullptr;
    double gain = 0.0;       ///< loss saved in the held-out windows
    bool is_leader = false;  ///< fitted on both halves; otherwise on the first, judged on some of the second
    CrossFit fitted;
};

struct SearchOptions {
    std::size_t fits = 8;      ///< candidates that are fitted, of those that promise most
    std::size_t leaders = 4;   ///< of these, how many are fitted on both halves
    std::size_t windows = 48;  ///< of a signal and a half, that are fitted
    std::function<bool()> stop =
        {};              ///< asked at every prediction; once true, what is returned is worth nothing
    double tail = 0.01;  ///< of taking in anything where there is nothing, over the whole search
};

/// A search over one set of recordings. Counts what it tries.
class Search {
  public:
    Search(const Evidence& evidence, const std::vector<Candidate>& candidates, const SearchOptions& options);

    CrossFit nothing() const;

    /// Candidates added to a base, all of them but those `added` in it; leaders first, then by gain,
    /// but of those that tie with the best the one of fewest parameters first.
    std::vector<Trial> try_all(const CrossFit& base, std::span<const Candidate* const> added);

    /// Fits all parameters of a cross fit from where they are.
    void fit_again(CrossFit& cross) const;

    /// Whether an effect's gain is more than chance, over all that was tried, and takes away a good part of
    /// what exceeds the floor: where the true law differs a little from the catalogue's, many an effect gains
    /// a little.
    bool is_real(const CrossFit& without, const CrossFit& with) const;

    /// Whether every signal is at its floor: nothing is left for another effect to explain.
    bool is_at_floor(const CrossFit& fitted) const;

    /// Whether what the other lacks to the best is no more than chance.
    bool ties(const CrossFit& best, const CrossFit& other) const;

    struct Contender;

  private:
    /// What each candidate that is not `added` promises beside a base.
    std::vector<Contender> promising(const CrossFit& base, std::span<const Candidate* const> added) const;
    void fit_simple_first(const CrossFit& base, std::span<Contender> contenders) const;
    void fit_first_half(const CrossFit& base, Contender& contender) const;
    void fit_second_half(const CrossFit& base, Trial& trial) const;
    /// Of a wave that leaves more than the floor, over all windows.
    void polish_both_halves(const CrossFit& base, Trial& trial) const;
    Comparison compared(const CrossFit& base, const CrossFit& fitted) const;
    Wanted half(std::size_t side) const;
    Predict predictor(const Wanted& wanted) const;
    Fit fit_half(std::size_t side, const Hypothesis& start, const CrossFit& base) const;
    Wanted fitted_windows(std::size_t side, const Hypothesis& hypothesis,
                          std::span<const double> mean_squares) const;
    /// Puts the one of fewest parameters first, of those that tie with the best.
    void prefer_simplest(std::vector<Trial>& trials) const;
    void judge_first_half(const CrossFit& base, Trial& trial) const;
    /// Sum over the signals of what their mean squares exceed the floor by.
    double excess(std::span<const double> mean_squares) const;
    void judge(CrossFit& cross) const;

    const Evidence& evidence_;
    const std::vector<Candidate>& candidates_;
    SearchOptions options_;
    std::vector<std::uint8_t> half_;
    int trials_ = 0;
};

}  // namespace fidservo::gap

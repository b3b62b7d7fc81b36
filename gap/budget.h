// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How long a diagnosis may take, and whether its user still wants it.
//
// A search has no natural end: it ends when its time is spent or its user says so, and the best that it has
// found until then stands. Whatever takes long asks its budget as it goes.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <string_view>

namespace fidservo::gap {

/// How a diagnosis came to its end.
enum class Ended {
    finished,     ///< all was done
    budget,       ///< the time was over
    interrupted,  ///< by the user
};
/// As the report has it.
std::string_view name_of(Ended ended);

/// Thrown where the budget is asked after its end.
class BudgetEnded : public std::exception {
  public:
    /// With what ended it.
    explicit BudgetEnded(Ended how) : how_(how) {}
    /// For people.
    const char* what() const noexcept override { return "the time for the diagnosis is over"; }
    /// What ended it.
    Ended how() const { return how_; }

  private:
    Ended how_;
};

/// What the seconds of a budget are.
enum class Seconds {
    by_clock,   ///< they pass by themselves
    by_effort,  ///< one for each rows_a_second rows of recordings that are predicted
};

/// Rows of recordings (ticks of 1 ms) predicted within a second, by definition: about what two cores do.
inline constexpr double rows_a_second = 50e6;

/// How long a diagnosis may take, and who may end it.
class Budget {
  public:
    /// No end.
    Budget() = default;
    /// @param search_s     from now on, until effects are looked for
    /// @param whole_s      until what was found is worked out; search_s at least
    /// @param interrupted  whether the user wants an end at once; asked often, by several threads at a time
    Budget(double search_s, double whole_s, std::function<bool()> interrupted,
           Seconds seconds = Seconds::by_clock);

    /// Throws BudgetEnded after the end of the part that is under way.
    void check() const;
    /// Counts rows that were predicted.
    void count(std::uint64_t rows) const { rows_.fetch_add(rows, std::memory_order_relaxed); }
    /// How many were counted so far.
    std::uint64_t rows() const { return rows_.load(std::memory_order_relaxed); }
    /// What follows works out what was found.
    void end_search() const { part_.store(Part::working_out, std::memory_order_relaxed); }
    /// What follows may take so much longer.
    void prolong(double extra_s) const;
    /// What follows takes a known time, and is done whatever happens: writing a report.
    void end() const { part_.store(Part::over, std::memory_order_relaxed); }
    /// Whether the user has ended it.
    bool is_interrupted() const { return interrupted_ && interrupted_(); }

  private:
    static constexpr double never = std::numeric_limits<double>::infinity();

    /// Since the budget began.
    double now_s() const;

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double search_end_s_ = never;
    mutable std::atomic<double> whole_end_s_ = never;
    std::function<bool()> interrupted_;
    Seconds seconds_ = Seconds::by_clock;
    mutable std::atomic<std::uint64_t> rows_ = 0;
    enum class Part {
        search,       ///< effects are looked for
        working_out,  ///< what was found is worked out
        over,         ///< nothing more may begin
    };
    mutable std::atomic<Part> part_ = Part::search;
};

}  // namespace fidservo::gap

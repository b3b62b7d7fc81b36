// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The time that a diagnosis may take, and its interruption by the user.
//
// A search has no natural end: it ends when its time is spent or its user interrupts it, and the best result
// until then is kept. All long computations check the budget regularly.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <string_view>

namespace fidservo::gap {

/// How a diagnosis ended.
enum class Ended {
    finished,     ///< everything was done
    budget,       ///< the time was spent
    interrupted,  ///< by the user
};
/// The name in reports.
std::string_view name_of(Ended ended);

/// Thrown by Budget::check() after the budget's end.
class BudgetEnded : public std::exception {
  public:
    /// @param how  the reason for the end
    explicit BudgetEnded(Ended how) : how_(how) {}
    /// The message.
    const char* what() const noexcept override { return "the time for the diagnosis is over"; }
    /// The reason for the end.
    Ended how() const { return how_; }

  private:
    Ended how_;
};

/// Thrown by Budget::check() after the end of a share of the search's time (Budget::Share).
class ShareEnded : public std::exception {
  public:
    /// The message.
    const char* what() const noexcept override {
        return "this part of the search has had its share of the time";
    }
};

/// How the seconds of a budget are measured.
enum class Seconds {
    by_clock,   ///< by the wall clock
    by_effort,  ///< by computing: one second for each rows_a_second rows of recordings that are predicted
};

/// Rows of recordings (ticks of 1 ms) predicted within a second, by definition: about what two cores do.
inline constexpr double rows_a_second = 50e6;

/// How long a diagnosis may take, and who may end it.
class Budget {
  public:
    /// A budget without an end.
    Budget() = default;
    /// @param search_s     time for the search for effects, from now on
    /// @param whole_s      time for the search and the evaluation of its result; at least search_s
    /// @param interrupted  whether the user wants an end at once; called often, by several threads at a time
    Budget(double search_s, double whole_s, std::function<bool()> interrupted,
           Seconds seconds = Seconds::by_clock);

    /// During its lifetime, the search may take no more than a share of the time that remained for it, so
    /// that an unsuccessful part of a search leaves time for the others. Has no effect if the search has no
    /// time limit. Only one may exist at a time.
    class Share {
      public:
        /// @param budget  must outlive this object
        /// @param share  fraction of the remaining time of the search, 0 to 1
        Share(const Budget& budget, double share);
        ~Share() { budget_.share_end_s_.store(never, std::memory_order_relaxed); }
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;

      private:
        const Budget& budget_;
    };

    /// Throws BudgetEnded if the time of the search or, after end_search(), of the whole diagnosis is over,
    /// or if the user has interrupted it; ShareEnded if a Share of the search's time is over.
    void check() const;
    /// Counts predicted rows.
    void count(std::uint64_t rows) const { rows_.fetch_add(rows, std::memory_order_relaxed); }
    /// The number of predicted rows so far.
    std::uint64_t rows() const { return rows_.load(std::memory_order_relaxed); }
    /// Ends the search: what follows is the evaluation of its result.
    void end_search() const { part_.store(Part::working_out, std::memory_order_relaxed); }
    /// Extends the time for what follows.
    void prolong(double extra_s) const;
    /// Ends the budget's control: what follows takes a known time and is completed in any case, such as
    /// writing a report.
    void end() const { part_.store(Part::over, std::memory_order_relaxed); }
    /// Whether the user has interrupted the diagnosis.
    bool is_interrupted() const { return interrupted_ && interrupted_(); }

  private:
    static constexpr double never = std::numeric_limits<double>::infinity();

    /// Time since the budget began.
    double now_s() const;

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double search_end_s_ = never;
    mutable std::atomic<double> whole_end_s_ = never, share_end_s_ = never;
    std::function<bool()> interrupted_;
    Seconds seconds_ = Seconds::by_clock;
    mutable std::atomic<std::uint64_t> rows_ = 0;
    enum class Part {
        search,       ///< the search for effects
        working_out,  ///< the evaluation of its result
        over,         ///< what is completed in any case
    };
    mutable std::atomic<Part> part_ = Part::search;
};

}  // namespace fidservo::gap

#pragma once
// How long a diagnosis may take, and whether its user still wants it.
//
// A search has no natural end: it ends when its time is spent or its user says so, and the best that it has
// found until then stands. Whatever takes long asks its budget as it goes.
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
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

/// How long a diagnosis may take, and who may end it.
class Budget {
  public:
    /// No end.
    Budget() = default;
    /// @param search_s     from now on, until effects are looked for
    /// @param whole_s      until what was found is worked out; search_s at least
    /// @param interrupted  whether the user wants an end at once; asked often, by several threads at a time
    Budget(double search_s, double whole_s, std::function<bool()> interrupted);

    /// Throws BudgetEnded after the end of the part that is under way.
    void check() const;
    /// What follows works out what was found.
    void end_search() const { part_.store(Part::working_out, std::memory_order_relaxed); }
    /// What follows may take so much longer.
    void prolong(double extra_s) const;
    /// What follows takes a known time, and is done whatever happens: writing a report.
    void end() const { part_.store(Part::over, std::memory_order_relaxed); }
    /// Whether the user has ended it.
    bool is_interrupted() const { return interrupted_ && interrupted_(); }

  private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point search_end_ = Clock::time_point::max();
    mutable std::atomic<Clock::time_point> whole_end_ = Clock::time_point::max();
    std::function<bool()> interrupted_;
    enum class Part {
        search,       ///< effects are looked for
        working_out,  ///< what was found is worked out
        over,         ///< nothing more may begin
    };
    mutable std::atomic<Part> part_ = Part::search;
};

}  // namespace fidservo::gap

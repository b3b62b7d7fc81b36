#include "gap/budget.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {

std::string_view name_of(Ended ended) {
    switch (ended) {
        case Ended::budget:
            return "budget";
        case Ended::interrupted:
            return "interrupted";
        case Ended::finished:
            break;
    }
    return "finished";
}

Budget::Budget(double search_s, double whole_s, std::function<bool()> interrupted)
    : interrupted_(std::move(interrupted)) {
    const auto after = [now = Clock::now()](double seconds) {
        return now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    };
    search_end_ = after(search_s);
    whole_end_ = after(whole_s);
}

void Budget::prolong(double extra_s) const {
    const auto end = whole_end_.load(std::memory_order_relaxed);
    if (end == Clock::time_point::max()) return;
    const auto extra = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(extra_s));
    whole_end_.store(std::max(end, Clock::now()) + extra, std::memory_order_relaxed);
}

void Budget::check() const {
    const Part part = part_.load(std::memory_order_relaxed);
    if (part == Part::over) return;
    if (is_interrupted()) throw BudgetEnded(Ended::interrupted);
    const auto end = part == Part::search ? search_end_ : whole_end_.load(std::memory_order_relaxed);
    if (end != Clock::time_point::max() && Clock::now() > end) throw BudgetEnded(Ended::budget);
}

}  // namespace fidservo::gap

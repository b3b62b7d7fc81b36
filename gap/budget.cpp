// SPDX-License-Identifier: GPL-3.0-or-later
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

Budget::Budget(double search_s, double whole_s, std::function<bool()> interrupted, Seconds seconds)
    : search_end_s_(search_s),
      whole_end_s_(whole_s),
      interrupted_(std::move(interrupted)),
      seconds_(seconds) {}

double Budget::now_s() const {
    if (seconds_ == Seconds::by_effort) return static_cast<double>(rows()) / rows_a_second;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Budget::prolong(double extra_s) const {
    const double end_s = whole_end_s_.load(std::memory_order_relaxed);
    if (end_s == never) return;
    whole_end_s_.store(std::max(end_s, now_s()) + extra_s, std::memory_order_relaxed);
}

Budget::Share::Share(const Budget& budget, double share) : budget_(budget) {
    const double now_s = budget.now_s();
    budget.share_end_s_.store(now_s + share * (budget.search_end_s_ - now_s), std::memory_order_relaxed);
}

void Budget::check() const {
    const Part part = part_.load(std::memory_order_relaxed);
    if (part == Part::over) return;
    if (is_interrupted()) throw BudgetEnded(Ended::interrupted);
    const double end_s = part == Part::search ? search_end_s_ : whole_end_s_.load(std::memory_order_relaxed);
    if (end_s == never) return;
    const double now = now_s();
    if (now > end_s) throw BudgetEnded(Ended::budget);
    if (part == Part::search && now > share_end_s_.load(std::memory_order_relaxed)) throw ShareEnded();
}

}  // namespace fidservo::gap

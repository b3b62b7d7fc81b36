// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/preisach.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

namespace {

constexpr std::size_t usual_depth = 256;

/// Contraction held by the loops that survive when the temperature reaches `peak`, resp. stays below it.
double outer_contraction(const PreisachMemory& memory, std::size_t depth) {
    return depth == 0 ? 0.0 : memory.loops[depth - 1].contraction_mm;
}

double outer_valley(const FodTable& table, const PreisachMemory& memory, std::size_t depth) {
    return depth == 0 ? table.low_degC() : memory.loops[depth - 1].valley_degC;
}

/// Where a move to a temperature ends: how many loops survive it, from which peak the wire then cools.
struct Landing {
    std::size_t depth;
    double peak_degC;
};

Landing land(const PreisachMemory& memory, double temp_degC) {
    Landing landing{memory.loops.size(), memory.last_peak_degC};
    if (temp_degC >= memory.temp_degC) {
        while (landing.depth > 0 && memory.loops[landing.depth - 1].peak_degC <= temp_degC) --landing.depth;
        landing.peak_degC = temp_degC;
        return landing;
    }
    while (landing.depth > 0 && memory.loops[landing.depth - 1].valley_degC >= temp_degC) {
        landing.peak_degC = memory.loops[landing.depth - 1].peak_degC;
        --landing.depth;
    }
    return landing;
}

double contraction_after(const FodTable& table, const PreisachMemory& memory, const Landing& landing,
                         double temp_degC) {
    return outer_contraction(memory, landing.depth) + table.contraction_mm(landing.peak_degC, temp_degC) -
           table.contraction_mm(landing.peak_degC, outer_valley(table, memory, landing.depth));
}

}  // namespace

FodTable::FodTable(std::vector<double> nodes_degC, std::vector<double> lower_triangle_mm)
    : nodes_(nodes_degC.size()),
      low_degC_(nodes_degC.front()),
      high_degC_(nodes_degC.back()),
      step_degC_((high_degC_ - low_degC_) / static_cast<double>(nodes_ - 1)),
      nodes_per_degC_(1.0 / step_degC_),
      square_mm_(nodes_ * nodes_) {
    FIDSERVO_DEMAND(nodes_ >= 2 && lower_triangle_mm.size() == nodes_ * (nodes_ + 1) / 2);
    std::size_t next = 0;
    for (std::size_t peak = 0; peak < nodes_; ++peak) {
        for (std::size_t temp = 0; temp <= peak; ++temp)
            square_mm_[peak * nodes_ + temp] = lower_triangle_mm[next++];
        for (std::size_t temp = peak + 1; temp < nodes_; ++temp)
            square_mm_[peak * nodes_ + temp] = square_mm_[peak * nodes_ + peak];
    }
}

double FodTable::contraction_mm(double peak_degC, double temp_degC) const {
    const double last = static_cast<double>(nodes_ - 1);
    const double peak = std::clamp((peak_degC - low_degC_) * nodes_per_degC_, 0.0, last);
    const double temp = std::clamp((temp_degC - low_degC_) * nodes_per_degC_, 0.0, peak);
    const auto i = std::min(static_cast<std::ptrdiff_t>(peak), static_cast<std::ptrdiff_t>(nodes_) - 2);
    const auto j = std::min(static_cast<std::ptrdiff_t>(temp), static_cast<std::ptrdiff_t>(nodes_) - 2);
    const double u = peak - static_cast<double>(i);
    const double w = temp - static_cast<double>(j);
    if (i == j) {
        const double corner = node_mm(i, i);
        const double below = node_mm(i + 1, i);
        return corner + u * (below - corner) + w * (node_mm(i + 1, i + 1) - below);
    }
    const double shallow = node_mm(i, j) + w * (node_mm(i, j + 1) - node_mm(i, j));
    const double deep = node_mm(i + 1, j) + w * (node_mm(i + 1, j + 1) - node_mm(i + 1, j));
    return shallow + u * (deep - shallow);
}

PreisachMemory preisach_start(const FodTable& table, double temp_degC) {
    PreisachMemory memory{{}, temp_degC, temp_degC, table.contraction_mm(temp_degC, temp_degC)};
    memory.loops.reserve(usual_depth);
    return memory;
}

double preisach_step(const FodTable& table, PreisachMemory& memory, double temp_degC) {
    if (temp_degC == memory.temp_degC) return memory.contraction_mm;
    const bool was_cooling = memory.last_peak_degC > memory.temp_degC;
    if (temp_degC > memory.temp_degC && was_cooling)
        memory.loops.push_back({memory.last_peak_degC, memory.temp_degC, memory.contraction_mm});
    const Landing landing = land(memory, temp_degC);
    memory.contraction_mm = contraction_after(table, memory, landing, temp_degC);
    memory.loops.resize(landing.depth);
    memory.last_peak_degC = landing.peak_degC;
    memory.temp_degC = temp_degC;
    return memory.contraction_mm;
}

double preisach_peek(const FodTable& table, const PreisachMemory& memory, double temp_degC) {
    if (temp_degC == memory.temp_degC) return memory.contraction_mm;
    const bool was_cooling = memory.last_peak_degC > memory.temp_degC;
    const Landing landing = land(memory, temp_degC);
    const bool inside_new_loop = temp_degC > memory.temp_degC && was_cooling &&
                                 landing.depth == memory.loops.size() && temp_degC < memory.last_peak_degC;
    if (inside_new_loop)
        return memory.contraction_mm + table.contraction_mm(temp_degC, temp_degC) -
               table.contraction_mm(temp_degC, memory.temp_degC);
    return contraction_after(table, memory, landing, temp_degC);
}

std::optional<double> preisach_inverse(const FodTable& table, const PreisachMemory& memory,
                                       double contraction_mm) {
    const bool heat = contraction_mm >= memory.contraction_mm;
    double near = memory.temp_degC;
    double far = heat ? table.high_degC() : table.low_degC();
    const double reach = preisach_peek(table, memory, far);
    if (heat ? reach < contraction_mm : reach > contraction_mm) return std::nullopt;
    constexpr double resolution_degC = 1e-9;
    while (std::abs(far - near) > resolution_degC) {
        const double middle = 0.5 * (near + far);
        const double x_mm = preisach_peek(table, memory, middle);
        (heat ? x_mm < contraction_mm : x_mm > contraction_mm) ? near = middle : far = middle;
    }
    return far;
}

}  // namespace fidservo

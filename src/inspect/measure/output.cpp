#include "src/inspect/measure/output.h"

#include "core/input_error.h"

#include <fmt/format.h>

namespace fidservo::inspect {

std::string visit_name(int tag_id, bool again) {
    return fmt::format("site-{:03}{}", tag_id, again ? "-again" : "");
}

std::string image_name(int tag_id, bool again, const std::string& view) {
    return fmt::format("images/{}-{}.png", visit_name(tag_id, again), view);
}

std::string recording_name(int tag_id, bool again) {
    return "recordings/" + visit_name(tag_id, again);
}

void set_aside(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) return;
    for (int k = 1;; ++k) {
        const auto other = path.parent_path() / fmt::format("{}.interrupted-{}{}", path.stem().string(), k,
                                                            path.extension().string());
        if (std::filesystem::exists(other)) continue;
        std::error_code problem;
        std::filesystem::rename(path, other, problem);
        if (problem)
            throw RunFault(fmt::format("{}: cannot be renamed: {}", path.string(), problem.message()));
        return;
    }
}

}  // namespace fidservo::inspect

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A rig file made from another one.
#include "core/preisach.h"
#include "core/rig.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

/// The provenance of a part's numbers, for readers of the file.
struct RigProvenance {
    std::string part;
    std::vector<std::string> recordings;
    std::vector<std::pair<std::string, double>> standard_errors;  ///< of keys, in the keys' units
    std::vector<std::pair<std::string, double>> residuals;        ///< r.m.s. by "signal_unit"
    std::vector<std::string> contradictions = {};  ///< contradictions between recordings, in words
};

/// A copy of a rig file whose values are changed one by one. Keys keep their order; comments are lost.
class RigEdit {
  public:
    /// Throws InputError if the file is not a rig file.
    explicit RigEdit(const std::filesystem::path& source);
    ~RigEdit();
    RigEdit(const RigEdit&) = delete;
    RigEdit& operator=(const RigEdit&) = delete;

    /// @param key  its path, e.g. "macro.dead_zone.slope"; missing maps are created
    /// If the camera names a camera_info file, its intrinsics are first copied from there.
    void set(std::string_view key, double value);
    /// Sets a list, e.g. "camera.distortion".
    void set(std::string_view key, std::span<const double> values);
    /// Sets a name, e.g. "camera.lens".
    void set_name(std::string_view key, std::string_view name);
    /// Adds an effect to those that the file states, or replaces the one of the same name.
    void state_effect(const StatedEffect& effect);
    /// Adds what was found beside the effects that the file states: an effect that it states, too, becomes
    /// one with it (plant/effects/together.h). Throws InputError where that is not possible.
    void add_effect(const StatedEffect& found);
    /// Writes the table beside the rig file, as NAME_fod.csv, and refers to it.
    void set_fod(std::shared_ptr<const FodTable> table);
    void set_provenance(const RigProvenance& provenance);

    /// Writes the new file. Throws InputError if it exists or a value is not allowed in a rig file, RunFault
    /// if the disk fails.
    void save(const std::filesystem::path& file) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo

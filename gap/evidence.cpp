// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "core/parallel.h"
#include "core/rig.h"
#include "gap/candidates/coupling.h"
#include "gap/evidence_parts.h"
#include "gap/residuals/wire_path.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace fidservo::gap {

namespace {

constexpr std::array<std::string_view, signal_count> signal_names{"encoder",       "hall",          "tag",
                                                                  "macro_command", "micro_command", "image"};
constexpr std::array<std::string_view, signal_count> signal_units{"count", "adc", "px", "V", "V", "floor"};

/// The models of the signal chain's stretches under a hypothesis.
struct Models {
    CarriageModel carriage;
    std::optional<PlatformModel> platform;
    std::optional<TagModel> tag;
    std::optional<ImageModel> image;
    bool platform_feels_carriage = false;

    /// Whether the prediction of a signal depends on the carriage's path.
    bool need_path_for(Signal signal) const {
        return signal == Signal::tag || (signal == Signal::hall && platform_feels_carriage);
    }
};

/// Throws InputError where the plant refuses the hypothesis.
Models models_of(const Rig& rig, const Hypothesis& hypothesis) {
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, hypothesis);
    Models models{.carriage = carriage_model(parameters),
                  .platform = std::nullopt,
                  .tag = std::nullopt,
                  .image = std::nullopt};
    if (parameters.micro) models.platform = platform_model(parameters);
    if (parameters.camera) {
        models.tag = tag_model(parameters, rig);
        models.image = ImageModel{*rig.camera, *parameters.camera};
    }
    models.platform_feels_carriage = models.platform && models.platform->stage.feels_carriage();
    return models;
}

/// Which signals a hypothesis can change, and whether it changes the carriage's motion.
struct Touched {
    std::array<bool, signal_count> signals{};
    bool carriage = false;
};

Touched touched_by(const Hypothesis& hypothesis, const Models& models) {
    Touched touched;
    for (const plant::EffectSetting& setting : hypothesis) {
        for (const Signal signal : reach_of(*setting.effect)) touched.signals[index_of(signal)] = true;
        if (moves_carriage(*setting.effect)) touched.carriage = true;
    }
    if (models.carriage.start_offset_count != 0.0) {
        touched.carriage = true;
        touched.signals[index_of(Signal::encoder)] = touched.signals[index_of(Signal::tag)] = true;
    }
    if (touched.carriage && models.platform_feels_carriage) touched.signals[index_of(Signal::hall)] = true;
    return touched;
}

/// An error in floors as it is stored: clipped at 1e9, so that sums of squares stay finite.
float stored(double error) {
    constexpr double most = 1e9;
    return static_cast<float>(std::clamp(error, -most, most));
}

void write_detections(Errors& errors, const Window& window, const TagRun& run,
                      const std::vector<CornerValues>& found) {
    std::size_t at = window.begin;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const CornerValues floors =
            found[i].cwiseQuotient(run.sightings[window.first_detection + i].floors_px);
        for (const double value : floors) errors[at++] = stored(value);
    }
}

/// Cost of a window, wanted or not, in rows of a carriage that is simulated by its closed-form solution.
constexpr std::size_t rows_worth_a_window = 20;

/// Predicts those signals of a run that are asked for.
class RunPredictor {
  public:
    /// @param known  the path of a carriage that moves otherwise than the rig file's; null: to be computed
    RunPredictor(const Evidence::Parts& parts, std::size_t run, const Wanted& wanted, const Models& models,
                 bool other_carriage, const CarriagePath* known = nullptr)
        : parts_(parts),
          links_(parts.links[run]),
          windows_(
              std::span(parts.windows)
                  .subspan(parts.first_window[run], parts.first_window[run + 1] - parts.first_window[run])),
          wanted_(std::span(wanted).subspan(parts.first_window[run], windows_.size())),
          models_(models),
          other_carriage_(other_carriage),
          known_path_(known),
          all_rows_(parts.recordings[run].rows.size()) {}

    /// @return the cost, in rows
    std::size_t predict(const std::array<bool, signal_count>& touched, Errors& errors) {
        std::array<bool, signal_count> signals{};
        for (std::size_t w = 0; w < windows_.size(); ++w) {
            const std::size_t signal = index_of(windows_[w].signal);
            if (wanted_[w] != 0 && touched[signal]) signals[signal] = true;
        }
        const bool hall = signals[index_of(Signal::hall)], tag = signals[index_of(Signal::tag)];
        const bool needs_path =
            other_carriage_ && !known_path_ &&
            ((tag && models_.need_path_for(Signal::tag)) || (hall && models_.need_path_for(Signal::hall)));
        PredictedCounts predicted;
        if (needs_path)
            predicted = predicted_counts(models_.carriage, links_.carriage, path_);
        else if (signals[index_of(Signal::encoder)])
            predicted = predicted_counts(models_.carriage, links_.carriage, wanted_of(Signal::encoder));
        if (signals[index_of(Signal::encoder)]) write_counts(predicted.counts, errors);
        if (hall && links_.platform) predict_hall(errors);
        if (tag && models_.tag) predict_tags(errors);
        if (signals[index_of(Signal::image)] && models_.image) predict_images(errors);
        for (const Signal signal : {Signal::macro_command, Signal::micro_command})
            if (signals[index_of(signal)]) replay(signal, errors);
        constexpr std::size_t of_hall = 3;  // by the time that it takes (bench/gap_bench.cpp)
        return predicted.effort + (hall ? of_hall * all_rows_ : 0) + (tag ? all_rows_ : 0);
    }

  private:
    const CarriagePath& path() const {
        if (known_path_) return *known_path_;
        return path_.position_mm.empty() ? links_.path : path_;
    }

    void write_counts(const std::vector<double>& predicted, Errors& errors) const {
        const double floor = parts_.floors[index_of(Signal::encoder)];
        for_rows(Signal::encoder, errors, [&](std::size_t row) {
            return counted_error(links_.carriage, row, predicted[row]) / floor;
        });
    }

    void predict_hall(Errors& errors) const {
        const auto found = predicted_readings(*models_.platform, *links_.platform,
                                              models_.platform_feels_carriage ? &path() : nullptr);
        for_rows(Signal::hall, errors, [&](std::size_t row) {
            return (found.reading_lsb[row] - links_.platform->hall_adc[row]) / links_.platform->floor_lsb;
        });
    }

    void predict_tags(Errors& errors) const {
        const SmoothedReading* reading = links_.smoothed ? &*links_.smoothed : nullptr;
        SmoothedReading filtered;
        if (reading != nullptr && models_.tag->micro->hall_disturbance.leak_lag_s > 0.0) {
            filtered = *reading;
            filtered.drive_V =
                behind_lag(std::move(filtered.drive_V), models_.tag->micro->hall_disturbance.leak_lag_s,
                           links_.tags.tick_s);
            reading = &filtered;
        }
        const double zero_mm = zero_offset_mm(*models_.tag, links_.tags, path(), reading);
        const std::span<const std::uint8_t> wanted = wanted_of(Signal::tag);
        auto window = std::ranges::find(windows_, Signal::tag, &Window::signal);
        for (std::size_t i = 0; i < wanted.size(); ++i, ++window)
            if (wanted[i] != 0)
                write_detections(
                    errors, *window, links_.tags,
                    tag_errors(*models_.tag, links_.tags, links_.tags.windows[i], path(), reading, zero_mm));
    }

    void predict_images(Errors& errors) const {
        const std::size_t run = windows_.front().run;
        const std::vector<ImageErrors> found =
            image_errors(*models_.image, parts_.recordings[run], parts_.images[run]);
        for (std::size_t w = 0; w < windows_.size(); ++w) {
            const Window& window = windows_[w];
            if (window.signal != Signal::image || wanted_[w] == 0) continue;
            std::size_t at = window.begin;
            for (std::size_t i = window.first_detection; at < window.end; ++i)
                for (const double value : found[i]) errors[at++] = stored(value);
        }
    }

    void replay(Signal signal, Errors& errors) const {
        const ControllerRun& run = signal == Signal::macro_command ? links_.macro : links_.micro;
        for_rows(signal, errors, [&](std::size_t row) {
            return counted_floors(run.error_V[row], parts_.floors[index_of(signal)]);
        });
    }

    /// @param error  function of a row; in floors
    template <class RowError>
    void for_rows(Signal signal, Errors& errors, RowError error) const {
        for (std::size_t w = 0; w < windows_.size(); ++w) {
            const Window& window = windows_[w];
            if (window.signal != signal || wanted_[w] == 0) continue;
            for (std::size_t i = 0; i < window.rows; ++i)
                errors[window.begin + i] = stored(error(window.first_row + i));
        }
    }

    /// The flags of a signal's windows, which are contiguous.
    std::span<const std::uint8_t> wanted_of(Signal signal) const {
        const auto is_own = [signal](const Window& window) { return window.signal == signal; };
        const auto first = std::ranges::find_if(windows_, is_own);
        const auto end = std::find_if_not(first, windows_.end(), is_own);
        return wanted_.subspan(static_cast<std::size_t>(first - windows_.begin()),
                               static_cast<std::size_t>(end - first));
    }

    const Evidence::Parts& parts_;
    const RunLinks& links_;
    std::span<const Window> windows_;
    std::span<const std::uint8_t> wanted_;
    const Models& models_;
    bool other_carriage_;
    const CarriagePath* known_path_;
    std::size_t all_rows_;
    CarriagePath path_;
};

double command_floor_V(const std::vector<Recording>& recordings, double StageRow::*command_V) {
    std::vector<double> commands;
    for (const Recording& recording : recordings)
        for (const StageRow& row : recording.rows) commands.push_back(row.*command_V);
    return controller_floor_V(commands);
}

}  // namespace

std::string_view name_of(Signal signal) {
    return signal_names[index_of(signal)];
}

std::string_view unit_of(Signal signal) {
    return signal_units[index_of(signal)];
}

Evidence::Evidence(const Rig& rig, std::vector<Recording> recordings, std::shared_ptr<const Budget> budget)
    : parts_(std::make_unique<Parts>()) {
    Parts& parts = *parts_;
    parts.rig = rig;
    parts.budget = budget ? std::move(budget) : std::make_shared<const Budget>();
    for (const Recording& recording : recordings) check(rig, recording);
    parts.recordings = joined(std::move(recordings), rig);
    for (Recording& recording : parts.recordings) {
        recording.is_seen = recording.is_seen || !recording.appearances.empty();
        std::ranges::stable_sort(recording.detections, {}, &TagDetection::time_ns);
        std::ranges::stable_sort(recording.appearances, {}, &TagAppearance::time_ns);
        parts.places.push_back(refer_to_travel(recording, rig));
        parts.budget->check();
    }
    find_noise(parts);
    parts.floors[index_of(Signal::macro_command)] =
        command_floor_V(parts.recordings, &StageRow::macro_command_V);
    parts.floors[index_of(Signal::micro_command)] =
        command_floor_V(parts.recordings, &StageRow::micro_command_V);
    parts.floors[index_of(Signal::image)] = 1.0;
    for (Recording& recording : parts.recordings) parts.late.push_back(fill_late_ticks(recording));
    find_looks(parts);
    find_wires(parts);
    for (std::size_t run = 0; run < parts.recordings.size(); ++run) {
        parts.budget->check();
        add_run(parts, run);
    }
    parts.first_window.push_back(parts.windows.size());
    for (std::size_t signal = 0; signal < signal_count; ++signal)
        if (std::ranges::none_of(parts.windows,
                                 [&](const Window& window) { return index_of(window.signal) == signal; }))
            parts.floors[signal] = std::numeric_limits<double>::quiet_NaN();

    parts.nominal.assign(parts.values, std::numeric_limits<float>::quiet_NaN());
    const Models models = models_of(parts.rig, {});
    const Wanted all = everything(*this);
    for (std::size_t run = 0; run < parts.recordings.size(); ++run) {
        parts.budget->check();
        RunPredictor(parts, run, all, models, false).predict(all_signals, parts.nominal);
    }
}

Evidence::~Evidence() = default;
Evidence::Evidence(Evidence&&) noexcept = default;

const Rig& Evidence::rig() const {
    return parts_->rig;
}
const std::shared_ptr<const Budget>& Evidence::budget() const {
    return parts_->budget;
}
const std::vector<Recording>& Evidence::recordings() const {
    return parts_->recordings;
}
const std::vector<Window>& Evidence::windows() const {
    return parts_->windows;
}
double Evidence::floor(Signal signal) const {
    return parts_->floors[index_of(signal)];
}
const std::vector<Omission>& Evidence::omissions() const {
    return parts_->omissions;
}
bool Evidence::knows_places(std::size_t run) const {
    return parts_->places[run] != PlacesFrom::nowhere;
}
const Course& Evidence::course(std::size_t run) const {
    return parts_->courses[run];
}

const TagSighting& Evidence::sighting(std::size_t run, std::size_t detection) const {
    return parts_->links[run].tags.sightings[detection];
}

bool Evidence::platform_feels_carriage(const Hypothesis& hypothesis) const {
    return models_of(rig(), hypothesis).platform_feels_carriage;
}

double Evidence::effort() const {
    std::size_t rows = 0;
    for (const Recording& recording : parts_->recordings) rows += recording.rows.size();
    constexpr std::size_t five_minutes = 300'000;
    return static_cast<double>(parts_->budget->rows()) / static_cast<double>(std::max(rows, five_minutes));
}

Errors Evidence::errors(const Hypothesis& hypothesis, const Wanted& wanted, double start_offset_count,
                        const CarriagePaths* known) const {
    const Parts& parts = *parts_;
    FIDSERVO_DEMAND(wanted.size() == parts.windows.size());
    try {
        Models models = models_of(parts.rig, hypothesis);
        models.carriage.start_offset_count = start_offset_count;
        const Touched touched = touched_by(hypothesis, models);
        Errors errors(parts.values, std::numeric_limits<float>::quiet_NaN());
        for (std::size_t w = 0; w < parts.windows.size(); ++w) {
            const Window& window = parts.windows[w];
            if (wanted[w] == 0 || touched.signals[index_of(window.signal)]) continue;
            std::copy(parts.nominal.begin() + static_cast<std::ptrdiff_t>(window.begin),
                      parts.nominal.begin() + static_cast<std::ptrdiff_t>(window.end),
                      errors.begin() + static_cast<std::ptrdiff_t>(window.begin));
        }
        if (std::ranges::none_of(touched.signals, std::identity{})) return errors;
        if (known && (start_offset_count != 0.0 || known->moving != moving_carriage(hypothesis)))
            known = nullptr;
        parts.budget->count(parts.windows.size() * rows_worth_a_window);
        parallel_for(parts.recordings.size(), [&](std::size_t run) {
            const CarriagePath* const path = known ? &known->along[run] : nullptr;
            parts.budget->count(RunPredictor(parts, run, wanted, models, touched.carriage, path)
                                    .predict(touched.signals, errors));
        });
        return errors;
    } catch (const InputError&) {
        return {};
    }
}

std::shared_ptr<const CarriagePaths> Evidence::paths(const Hypothesis& hypothesis, const Wanted& wanted,
                                                     std::shared_ptr<const CarriagePaths> known) const {
    const Parts& parts = *parts_;
    FIDSERVO_DEMAND(wanted.size() == parts.windows.size());
    Hypothesis moving = moving_carriage(hypothesis);
    if (moving.empty()) return nullptr;
    if (known && known->moving == moving) return known;
    try {
        const Models models = models_of(parts.rig, hypothesis);
        const auto asks = [&](const Window& window) {
            return wanted[static_cast<std::size_t>(&window - parts.windows.data())] != 0 &&
                   models.need_path_for(window.signal);
        };
        if (std::ranges::none_of(parts.windows, asks)) return nullptr;
        auto paths = std::make_shared<CarriagePaths>();
        paths->moving = std::move(moving);
        paths->along.resize(parts.recordings.size());
        parallel_for(parts.recordings.size(), [&](std::size_t run) {
            const PredictedCounts counts =
                predicted_counts(models.carriage, parts.links[run].carriage, paths->along[run]);
            parts.budget->count(counts.effort);
        });
        return paths;
    } catch (const InputError&) {
        return nullptr;
    }
}

Wanted everything(const Evidence& evidence) {
    return Wanted(evidence.windows().size(), 1);
}

}  // namespace fidservo::gap

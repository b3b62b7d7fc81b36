// SPDX-License-Identifier: GPL-3.0-or-later
// diagnose: in a thread of its own, while Python's own looks after signals and tells how it goes.
#include "core/parallel.h"
#include "python/bindings.h"
#include "src/diagnose/diagnose_recordings.h"
#include "src/diagnose/diagnosis_json.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace fidservo::python {

namespace py = pybind11;

namespace {

/// A progress report of a running diagnosis.
struct Told {
    std::string what;
    double share;
};

/// Work in another thread that can be asked to end.
class Errand {
  public:
    explicit Errand(std::function<std::string(Errand&)> work)
        : thread_([this, work = std::move(work)] {
              try {
                  answer_ = work(*this);
              } catch (...) {
                  failed_ = std::current_exception();
              }
              const std::lock_guard lock(mutex_);
              is_done_ = true;
              changed_.notify_all();
          }) {}

    void ask_to_end() { is_unwanted_ = true; }
    bool is_unwanted() const { return is_unwanted_; }
    void tell(std::string_view what, double share) {
        const std::lock_guard lock(mutex_);
        told_ = Told{std::string(what), share};
    }

    /// The latest progress report, unless it has been returned already.
    std::optional<Told> news() {
        const std::lock_guard lock(mutex_);
        return std::exchange(told_, std::nullopt);
    }
    /// Whether it is done within a time.
    bool is_done_within(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, time, [&] { return is_done_; });
    }
    /// Waits for the answer; throws what the work has thrown.
    std::string answer() {
        thread_.join();
        if (failed_) std::rethrow_exception(failed_);
        return std::move(answer_);
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::atomic<bool> is_unwanted_ = false;
    bool is_done_ = false;
    std::optional<Told> told_;
    std::string answer_;
    std::exception_ptr failed_;
    std::jthread thread_;  ///< last: it uses the others
};

/// Waits for the errand in Python's thread, handling Python's signals and passing progress reports on. Throws
/// what a signal handler or `progress` raises.
void look_after(Errand& errand, const std::optional<py::function>& progress) {
    constexpr std::chrono::milliseconds period{50};
    for (bool is_done = false; !is_done;) {
        {
            const py::gil_scoped_release others_may_run;
            is_done = errand.is_done_within(period);
        }
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        // Also after the end: an errand shorter than one period has its only report still waiting then.
        if (const auto told = errand.news(); told && progress) (*progress)(told->what, told->share);
    }
}

std::string run(std::function<std::string(Errand&)> work, const std::optional<py::function>& progress) {
    Errand errand(std::move(work));
    try {
        look_after(errand, progress);
    } catch (...) {
        errand.ask_to_end();
        const py::gil_scoped_release others_may_run;
        errand.is_done_within(std::chrono::hours(24));
        throw;
    }
    return errand.answer();
}

struct CopiedRecordings {
    std::vector<Recording> recordings;
    std::vector<std::filesystem::path> folders;
};

CopiedRecordings copied(const std::vector<RecordingPointer>& held) {
    CopiedRecordings all;
    for (const RecordingPointer& one : held) {
        all.recordings.push_back(one->recording);
        all.folders.push_back(one->folder);
    }
    return all;
}

/// Throws TypeError, one line, on what is no list of recordings.
std::vector<RecordingPointer> recordings_of(const py::object& given) {
    if (py::isinstance<HeldRecording>(given) || !py::isinstance<py::iterable>(given))
        throw py::type_error("recordings: must be a list of Recordings, not " + type_name(given));
    std::vector<RecordingPointer> all;
    for (const py::handle one : given) {
        if (!py::isinstance<HeldRecording>(one))
            throw py::type_error("recordings[" + std::to_string(all.size()) + "]: must be a Recording, not " +
                                 type_name(one));
        all.push_back(one.cast<RecordingPointer>());
    }
    return all;
}

std::string diagnose_all(const HeldRig& rig, const py::object& recordings_given,
                         std::vector<std::string> effects, std::vector<std::string> without,
                         const std::optional<std::filesystem::path>& effects_file,
                         std::vector<std::string> matters, std::optional<double> effort_s,
                         const std::optional<py::function>& progress) {
    const std::vector<RecordingPointer> held = recordings_of(recordings_given);
    static std::mutex one_at_a_time;
    const std::unique_lock lock(one_at_a_time, std::try_to_lock);
    if (!lock) throw std::runtime_error("diagnose: another thread's is under way; one at a time");
    const gap::DiagnosisOptions options = diagnose::options_of({.only = std::move(effects),
                                                                .without = std::move(without),
                                                                .effects_file = effects_file.value_or(""),
                                                                .matters = std::move(matters)},
                                                               rig.rig);
    diagnose::keep_memory();
    use_cores(effort_s ? 1 : std::thread::hardware_concurrency());
    return run(
        [&](Errand& errand) {
            const diagnose::Conduct conduct{
                .effort_s = effort_s,
                .interrupted = [&] { return errand.is_unwanted(); },
                .tell = [&](std::string_view what, double share) { errand.tell(what, share); }};
            auto [recordings, folders] = copied(held);
            return diagnosis_json(
                diagnose::diagnose_recordings(
                    rig.rig, diagnose::with_frames(std::move(recordings), folders, conduct.interrupted),
                    options, conduct)
                    .diagnosis);
        },
        progress);
}

}  // namespace

void bind_diagnosis(py::module_& module) {
    using Texts = std::vector<std::string>;
    module.attr("USUAL_EFFORT_S") = diagnose::usual_effort_s();
    module.def("diagnose_to_json", &diagnose_all, py::arg("rig"), py::arg("recordings"), py::kw_only(),
               py::arg("effects") = Texts(), py::arg("without") = Texts(),
               py::arg("effects_file") = py::none(), py::arg("matters") = Texts(),
               py::arg("effort_s") = py::none(), py::arg("progress") = py::none(),
               "The text of `fidservo diagnose --json`; see fidservo.diagnose.");
}

}  // namespace fidservo::python

#pragma once
// Builds polytopes and reads files for commands. These are the slow parts of commands, so another thread can do them.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "errors/error.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/command.hpp"
#include "session/load.hpp"
#include "session/session.hpp"
#include "slicing/critical/critical_sections.hpp"
#include "slicing/critical/critical_sections_cache.hpp"

namespace oval4d::session {

/// A function that reads the object that a command specifies. Its parameters, result and errors are as for
/// readObject().
using FileReader = std::function<Result<ObjectWithWarnings>(const LoadObject& load, const Limits& limits)>;

/// Options of the search for critical values of w. At these values, the type of the section changes.
struct CriticalSearchOptions {
    /// The results of earlier searches. May be null; must outlive the loader.
    slicing::CriticalSectionsCache* cache = nullptr;
    /// The maximum duration of a search.
    std::chrono::duration<double> time = slicing::CriticalSearchLimits{}.time;
};

/// Everything that determines the critical values of w of an object.
struct CriticalSearchArguments {
    slicing::Object object;
    geometry::Rotation orientation;
    /// For a field, `levels` and `inside` of its settings; all other members have default values.
    slicing::FieldSettings settings;
    bool operator==(const CriticalSearchArguments&) const = default;
};
/// Returns the arguments of a search for the critical values of w of the object that the state shows.
CriticalSearchArguments criticalSearchArguments(const State& state);

/// A provider of the objects that one command needs, and of critical values of w. With LoadingMode::immediate,
/// functions such as polytopeOf() and objectFrom() do slow work before they return. With LoadingMode::deferred, these
/// functions return an error if the result is not available yet, and the work becomes pending.
///
/// needsLoading() calls the functions to find what a command needs. The caller then calls completePending(), on any
/// thread, and needsLoading() again, until nothing is pending. Results stay available, even if a cache drops them in
/// the meantime. A loader can be moved (std::move) at any time.
class ObjectLoader {
  public:
    /// Whether the loader does slow work at once, or in completePending().
    enum class LoadingMode : bool { immediate, deferred };

    /// Creates a loader with LoadingMode::immediate that reads files in the calling process.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache);
    /// Creates a loader that reads files with `reader`.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, LoadingMode mode, FileReader reader,
                 CriticalSearchOptions search = {});

    /// Returns the polytope of a design (the recipe for a named polytope). Errors: `unknown_polytope` if the polytope
    /// cannot be built; `too_large` if the computation of a convex hull exceeds a limit.
    Result<slicing::Object> polytopeOf(const polytopes::PolytopeDesign& design);

    /// Returns the object that `load` specifies. `load` must outlive the loader, unless it names an array in the
    /// server's data folder. Errors: the errors of checkLoad() and readObject().
    Result<ObjectWithWarnings> objectFrom(const LoadObject& load);

    /// Returns `source` in the coordinates of the frame of reference `frame` (see slicing::transformedTo()). Objects
    /// with at most 1000 elements are transformed at once, even with LoadingMode::deferred. With LoadingMode::deferred,
    /// the loader keeps the results, so it transforms an object to a frame only once.
    Result<slicing::Object> transformedTo(const slicing::Object& source, const geometry::ReferenceFrame& frame);
    /// Returns the array `field`, extended by the time steps of `added` (see session::appendTimeSteps()).
    Result<slicing::Object> fieldWithTimeSteps(const slicing::Object& field, const slicing::Object& added);

    /// Returns the critical values of w of the object that the state shows (see slicing::findCriticalSections()). A
    /// deferred search gives the result for the state of the first call, even if the object has turned before the next
    /// call. Only searches in fields and in objects with more than 1000 elements are deferred. Error: `canceled` if the
    /// search was stopped.
    Result<slicing::CriticalSectionsPtr> criticalSections(const State& state);

    /// Returns whether an object or a search is pending. If so, a function of the loader has failed only because its
    /// result is not available yet.
    bool isPending() const { return !std::holds_alternative<std::monostate>(pending_); }
    /// Replaces the function that reads files.
    void readFilesWith(FileReader reader) { reader_ = std::move(reader); }
    /// Returns whether the pending object comes from a file, so that the FileReader must read it.
    bool pendingNeedsFile() const { return std::holds_alternative<const LoadObject*>(pending_); }
    /// Returns whether a search for critical values of w is pending. A search takes longer than drawing a picture.
    bool isSearchPending() const { return std::holds_alternative<CriticalSearchArguments>(pending_); }
    /// Builds, reads or transforms the pending object, or searches for the pending critical values of w. Does nothing
    /// if nothing is pending. `stop` ends a search for critical values, which then fails with `canceled`.
    void completePending(std::stop_token stop = {});
    /// Returns the estimated duration of completePending(). The estimate for a polytope of the catalogue is accurate to
    /// within a factor of three.
    std::chrono::duration<double> estimatedDuration() const;

    /// Returns the estimated memory, in bytes, of completePending() and its result; 0 if nothing is pending. The
    /// estimate may be too low for an array in a compressed file. After completePending(), loadedObjectMemory() returns
    /// the actual memory.
    std::size_t estimatedMemory() const;
    /// Returns the memory, in bytes, of the object that was read from a file and of the array that was extended. Does
    /// not count polytopes that were built, nor objects that were transformed.
    std::size_t loadedObjectMemory() const;
    /// Returns the warnings of the object that was read from a file; an empty list if no object was read.
    std::vector<std::string> warnings() const;

  private:
    struct ObjectInReferenceFrame {
        slicing::Object source;
        geometry::ReferenceFrame frame;
        slicing::Object object = {};  // `source` in the coordinates of `frame`; null while pending
    };

    Result<slicing::CriticalSectionsPtr> searchCriticalSections(const CriticalSearchArguments& arguments,
                                                                std::stop_token stop);
    Result<slicing::Object> build(const polytopes::PolytopeDesign& design);

    Limits limits_;
    polytopes::PolytopeCache* cache_;
    LoadingMode mode_;
    FileReader reader_;
    CriticalSearchOptions search_;
    // The time steps of the array `added`, which will be appended to the array `field`.
    struct TimeStepsToAppend {
        slicing::Object field, added;
    };
    std::variant<std::monostate, polytopes::PolytopeDesign, const LoadObject*, ObjectInReferenceFrame,
                 TimeStepsToAppend, CriticalSearchArguments>
        pending_;
    // The pending command if it names an array in the server's data folder; else null. `pending_` points to this
    // command.
    std::shared_ptr<const LoadObject> ofDataFolder_;
    std::string builtName_;  // the name of the design of the polytope `built_`
    std::optional<Result<slicing::Object>> built_;
    std::optional<Result<ObjectWithWarnings>> fromFile_;
    // The array that fieldWithTimeSteps() has extended to `extended_`.
    slicing::Object extendedFrom_;
    std::optional<Result<slicing::Object>> extended_;
    slicing::Object searched_;  // the object for which `critical_` was computed
    std::optional<Result<slicing::CriticalSectionsPtr>> critical_;
    // Objects in the coordinates of a frame of reference. A command may change both the object and the frame, so it
    // needs an object in the old and in the new frame. There are more than two entries only if the session changes
    // between the calls of needsLoading().
    std::vector<ObjectInReferenceFrame> objectsInFrames_;
};

}  // namespace oval4d::session

#pragma once
// Builds polytopes and reads files for commands. Building and reading are the slow parts of commands, so another thread
// can do them.

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

/// Reads the object that a command specifies. Parameters, result and errors are those of readObject().
using FileReader = std::function<Result<ObjectWithWarnings>(const LoadObject& load, const Limits& limits)>;

/// How a loader searches for critical values of w: those at which the type of the section changes.
struct CriticalSearchOptions {
    slicing::CriticalSectionsCache* cache = nullptr;  ///< may be null; must outlive the loader
    /// The maximum search time: see CriticalSearchLimits::time.
    std::chrono::duration<double> time = slicing::CriticalSearchLimits{}.time;
};

/// What the critical values of w of an object depend on.
struct CriticalSearchArguments {
    slicing::Object object;
    geometry::Rotation orientation;
    slicing::FieldSettings settings;  ///< `levels` and `inside` of a field; all other members have their default values
    bool operator==(const CriticalSearchArguments&) const = default;
};
/// Returns the arguments that determine the critical values of w of the object that the state shows.
CriticalSearchArguments criticalSearchArguments(const State& state);

/// Provides the objects that one command needs, and the critical values of w of an object. With LoadingMode::immediate,
/// polytopeOf(), objectFrom() and the other functions build or read the object before they return. With
/// LoadingMode::deferred, they return an error if the object is not available yet, and the object becomes pending.
/// needsLoading() calls them to find what a command needs; the caller must call completePending(), on any thread, and
/// needsLoading() again, until nothing is pending. What was available once stays available, even if a cache drops it in
/// the meantime. A loader can be moved, also while something is pending.
class ObjectLoader {
  public:
    /// Whether slow work is done at once, or by completePending().
    enum class LoadingMode : bool { immediate, deferred };

    /// Creates a loader with LoadingMode::immediate that reads files in the calling process.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache);
    /// Creates a loader that reads files with `reader`.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, LoadingMode mode, FileReader reader,
                 CriticalSearchOptions search = {});

    /// Returns the polytope of this design. Errors: `unknown_polytope` if it cannot be built; `too_large` if the
    /// computation of a convex hull exceeds a limit, which is not known before the computation.
    Result<slicing::Object> polytopeOf(const polytopes::Design& design);

    /// Returns the object that `load` specifies. `load` must outlive the loader, unless it names an array in the data
    /// folder. Errors: those of checkLoad() and readObject().
    Result<ObjectWithWarnings> objectFrom(const LoadObject& load);

    /// Returns `source` transformed to `frame` (see slicing::transformedTo()). An object with few elements is
    /// transformed at once even with LoadingMode::deferred. With this mode, the loader keeps the results and transforms
    /// an object to a frame only once.
    Result<slicing::Object> transformedTo(const slicing::Object& source, const geometry::ReferenceFrame& frame);
    /// Returns the result of session::appendTimeSteps().
    Result<slicing::Object> fieldWithTimeSteps(const slicing::Object& field, const slicing::Object& added);

    /// Returns the critical values of w of the object that the state shows (see slicing::findCriticalSections()). If
    /// the search was deferred, the result is for the state at the time of the first call, even if the object has
    /// turned since. The search is never deferred for an object with few elements, unless it is a field. Error:
    /// `canceled` if the search was stopped.
    Result<slicing::CriticalSectionsPtr> criticalSections(const State& state);

    /// Returns whether an object or a search is pending: a function failed only because its result is not available
    /// yet.
    bool isPending() const { return !std::holds_alternative<std::monostate>(pending_); }
    /// Replaces the FileReader.
    void readFilesWith(FileReader reader) { reader_ = std::move(reader); }
    /// Returns whether the pending object must be read by the FileReader.
    bool pendingNeedsFile() const { return std::holds_alternative<const LoadObject*>(pending_); }
    /// Returns whether a search for critical values of w is pending. A search takes longer than drawing a picture.
    bool isSearchPending() const { return std::holds_alternative<CriticalSearchArguments>(pending_); }
    /// Builds, reads or transforms the pending object, or finds the pending critical values of w. Does nothing if
    /// nothing is pending. `stop` ends a search for critical values of w, which then fails with `canceled`.
    void completePending(std::stop_token stop = {});
    /// Returns the estimated duration of completePending(). For entries of the catalogue, it is accurate to within a
    /// factor of three.
    std::chrono::duration<double> estimatedDuration() const;

    /// Returns the estimated memory in bytes that completePending() and its result use; 0 if nothing is pending. For
    /// the array of a compressed file, the estimate may be too low; afterward, loadedObjectMemory() states the actual
    /// memory.
    std::size_t memoryNeeded() const;
    /// Returns the memory, in bytes, of the object that was read from a file and of the array that was extended. Does
    /// not count polytopes that were built and objects that were transformed.
    std::size_t loadedObjectMemory() const;
    /// Returns ObjectWithWarnings::warnings of the object that was read; an empty list if none was read.
    std::vector<std::string> warnings() const;

  private:
    struct ObjectInReferenceFrame {
        slicing::Object source;
        geometry::ReferenceFrame frame;
        slicing::Object object = {};  // `source` in `frame`; null while it is pending
    };

    Result<slicing::CriticalSectionsPtr> search(const CriticalSearchArguments& arguments, std::stop_token stop);
    Result<slicing::Object> build(const polytopes::Design& design);

    Limits limits_;
    polytopes::PolytopeCache* cache_;
    LoadingMode mode_;
    FileReader reader_;
    CriticalSearchOptions search_;
    // Time steps to append: those of the array `added`, at the end of the array `field`.
    struct TimeStepsToAppend {
        slicing::Object field, added;
    };
    std::variant<std::monostate, polytopes::Design, const LoadObject*, ObjectInReferenceFrame, TimeStepsToAppend,
                 CriticalSearchArguments>
        pending_;
    std::shared_ptr<const LoadObject> ofDataFolder_;  // the pending load if it names an array in the data folder
    std::string builtName_;                           // the name of the design from which `built_` was built
    std::optional<Result<slicing::Object>> built_;
    std::optional<Result<ObjectWithWarnings>> fromFile_;
    slicing::Object extendedFrom_;  // the array to which time steps were added to make `extended_`
    std::optional<Result<slicing::Object>> extended_;
    slicing::Object searched_;  // the object whose critical values of w are `critical_`
    std::optional<Result<slicing::CriticalSectionsPtr>> critical_;
    // The transformed objects: at most one in the frame before the command and one in the frame after it, because a
    // command may change both the object and the frame; more only if the session changes in the meantime.
    std::vector<ObjectInReferenceFrame> objectsInFrames_;
};

}  // namespace oval4d::session

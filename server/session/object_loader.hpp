#pragma once
// Builds polytopes and reads files for commands. These are the slow parts of commands, so they can be deferred to
// another thread.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "errors/error.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/command.hpp"
#include "session/load.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Reads an object from a text in this format. Parameters, result and errors are those of readObject.
using FileReader = std::function<Result<LoadedObject>(std::string_view format, std::string_view text,
                                                      const std::string& name, const Limits& limits)>;

/// Provides the objects that one command needs. With Mode::immediate, polytopeOf() and objectFrom() build or read the
/// object before they return. With Mode::deferred, they return an error if the object is not available yet, and the
/// object becomes pending. The caller then calls loadPendingObject(), on any thread, and applies the command again. The
/// caller repeats this until nothing is pending.
class ObjectLoader {
  public:
    enum class Mode : bool { immediate, deferred };

    /// Creates a loader with Mode::immediate that reads files in the calling process.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache);
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, Mode mode, FileReader reader);

    /// Returns the polytope of this design. Error: `unknown_polytope` if it cannot be built; the message gives only the
    /// reason, not the name.
    Result<slicing::Object> polytopeOf(const polytopes::Design& design);

    /// Returns the object read from the data of `load`, which must outlive the loader. Errors: those of checkLoad and
    /// readObject.
    Result<LoadedObject> objectFrom(const Load& load);

    /// Returns whether an object is pending: the command failed only because the object is not available yet.
    bool isPending() const { return !std::holds_alternative<std::monostate>(pending_); }
    /// Returns whether the pending object must be read from a file.
    bool isFilePending() const { return std::holds_alternative<const Load*>(pending_); }
    /// Builds or reads the pending object, if there is one.
    void loadPendingObject();
    /// Returns the estimated duration of loadPendingObject(). For entries of the catalogue, it is accurate to within a
    /// factor of three.
    std::chrono::duration<double> estimatedDuration() const;

    /// Returns the estimated memory in bytes that loadPendingObject() and its result use; 0 if nothing is pending.
    std::size_t bytesNeeded() const;
    /// Returns whether this loader has read a file, even one with errors, or built a polytope in loadPendingObject().
    bool hasDoneWork() const { return built_ || fromFile_; }

    /// Returns one warning for each fault that was corrected in the file; empty if no file has been read.
    std::vector<std::string> warnings() const;

  private:
    Result<slicing::Object> build(const polytopes::Design& design);

    Limits limits_;
    polytopes::PolytopeCache& cache_;
    Mode mode_;
    FileReader reader_;
    std::variant<std::monostate, polytopes::Design, const Load*> pending_;
    std::string builtName_;  // the name of the design from which `built_` was built
    std::optional<Result<slicing::Object>> built_;
    std::optional<Result<LoadedObject>> fromFile_;
};

}  // namespace oval4d::session

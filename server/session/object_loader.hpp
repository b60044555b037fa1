#pragma once
// Performs the slow parts of commands, building polytopes and reading files, at once or on another thread.

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

/// Reads an object from a text in this format; parameters, result and errors are those of readObject.
using FileReader = std::function<Result<LoadedObject>(std::string_view format, std::string_view text,
                                                      const std::string& name, const Limits& limits)>;

/// Provides the objects that one command needs. With Mode::immediate, objects are built or read within the call. With
/// Mode::deferred, a call for an object that is not available fails, and the object becomes pending. The caller then
/// calls loadPending(), on any thread, and applies the command again, until nothing is pending.
class ObjectLoader {
  public:
    enum class Mode : bool { immediate, deferred };

    /// A loader with Mode::immediate that reads files in the calling process.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache);
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, Mode mode, FileReader reader);

    /// Returns the polytope of this design. Error: `unknown_polytope`, whose message is only the reason, if it cannot
    /// be built.
    Result<slicing::Object> built(const polytopes::Design& design);

    /// Returns the object read from the data of `load`, which must outlive the loader. Errors: those of checkLoad and
    /// readObject.
    Result<LoadedObject> reading(const Load& load);

    /// Whether the command failed only because an object is not available yet.
    bool isPending() const { return !std::holds_alternative<std::monostate>(pending_); }
    /// Whether a file is to be read, rather than a polytope to be built.
    bool isFilePending() const { return std::holds_alternative<const Load*>(pending_); }
    /// Builds or reads the pending object, if there is one.
    void loadPending();
    /// The estimated duration of loadPending(); for entries of the catalogue, accurate to within a factor of three.
    std::chrono::duration<double> cost() const;

    /// The estimated memory of loadPending() and its result, in bytes; 0 if nothing is pending.
    std::size_t bytesNeeded() const;
    /// Whether loadPending() has built a polytope, or any call has read a file.
    bool hasLoaded() const { return built_ || reading_; }

    /// One warning for each fault that was corrected in the file; empty if no file has been read.
    std::vector<std::string> warnings() const;

  private:
    Result<slicing::Object> build(const polytopes::Design& design);

    Limits limits_;
    polytopes::PolytopeCache& cache_;
    Mode mode_;
    FileReader reader_;
    std::variant<std::monostate, polytopes::Design, const Load*> pending_;
    std::string builtName_;  ///< the name of the design from which `built_` was built
    std::optional<Result<slicing::Object>> built_;
    std::optional<Result<LoadedObject>> reading_;
};

}  // namespace oval4d::session

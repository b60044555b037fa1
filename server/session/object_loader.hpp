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
using FileReader = std::function<Result<Reading>(std::string_view format, std::string_view text,
                                                 const std::string& name, const Limits& limits)>;

/// Provides the objects that one command needs. With Pace::at_once, objects are built or read within the call. With
/// Pace::later, a call for an object that is not available fails and stores an order. The caller then calls work(), on
/// any thread, to carry out the order, and applies the command again, until ordered() is false.
class ObjectLoader {
  public:
    enum class Pace : bool { at_once, later };

    /// A loader with Pace::at_once that reads files in the calling process.
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache);
    ObjectLoader(const Limits& limits, polytopes::PolytopeCache& cache, Pace pace, FileReader reader);

    /// Returns the polytope of this design. Error: `unknown_polytope`, whose message is only the reason, if it cannot
    /// be built.
    Result<slicing::Object> built(const polytopes::Design& design);

    /// Returns the object read from the data of `load`, which must outlive the order. Errors: those of checkLoad and
    /// readObject.
    Result<Reading> reading(const Load& load);

    /// Whether there is an order, that is, the command failed only because an object was not available yet.
    bool ordered() const { return !std::holds_alternative<std::monostate>(order_); }
    /// Whether the order is to read a file rather than to build a polytope.
    bool orderedFile() const { return std::holds_alternative<const Load*>(order_); }
    /// Carries out the order, if there is one.
    void work();
    /// The estimated duration of work(); for entries of the catalogue, accurate to within a factor of three.
    std::chrono::duration<double> cost() const;

    /// The estimated memory for carrying out the order and for its result, in bytes; 0 without an order.
    std::size_t bytesNeeded() const;
    /// Whether work() has built a polytope, or any call has read a file.
    bool hasWorked() const { return built_ || reading_; }

    /// One warning for each fault that was corrected in the file; empty if no file has been read.
    std::vector<std::string> warnings() const;

  private:
    Result<slicing::Object> build(const polytopes::Design& design);

    Limits limits_;
    polytopes::PolytopeCache& cache_;
    Pace pace_;
    FileReader reader_;
    std::variant<std::monostate, polytopes::Design, const Load*> order_;
    std::string builtName_;  ///< the name of the design from which `built_` was built
    std::optional<Result<slicing::Object>> built_;
    std::optional<Result<Reading>> reading_;
};

}  // namespace oval4d::session

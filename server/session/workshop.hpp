#pragma once
// What takes long in a command: building a polytope, reading a file.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/design.hpp"
#include "protocol/cpp/error.hpp"
#include "protocol/cpp/request.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// A polytope read from a file, and what was repaired in it.
struct Reading {
    PolytopePtr polytope;
    std::vector<std::string> warnings;
};

/// Makes what one command needs; in one of two ways. `at_once`: as soon as it is asked for. `later`: what is not there
/// yet becomes an order and the command fails for now; `work` carries the order out, on any thread, and the command
/// is to be applied again, until nothing is ordered any more.
class Workshop {
  public:
    enum class Pace : bool { at_once, later };

    explicit Workshop(const Limits& limits, Pace pace = Pace::at_once) : limits_(limits), pace_(pace) {}

    /// The polytope of this design. `unknown_polytope`, with the reason alone, where none can be built.
    protocol::Result<PolytopePtr> polytope(const geometry::Design& design);

    /// What `load` holds; it must live until the order is carried out. Errors as readPolytope's.
    protocol::Result<Reading> reading(const protocol::Load& load);

    /// Whether the command failed only because something was not there yet.
    bool ordered() const { return !std::holds_alternative<std::monostate>(order_); }
    void work();

    /// What was repaired in what was read.
    std::vector<std::string> warnings() const;

  private:
    Limits limits_;
    Pace pace_;
    std::variant<std::monostate, geometry::Design, const protocol::Load*> order_;
    std::string built_;  ///< the name of the design that `polytope_` is of
    std::optional<protocol::Result<PolytopePtr>> polytope_;
    std::optional<protocol::Result<Reading>> reading_;
};

}  // namespace oval4d::session

#pragma once
// Those answers of the server whose members are described with Boost.Describe. The message of an answer has members of
// the same names, and its type is the constant kMessageType of the answer.

#include <boost/describe/class.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "session/command.hpp"

namespace oval4d::wire {

/// Answers a request that took effect, unless another message answers it.
struct Done {
    static constexpr std::string_view kMessageType = "done";
    std::uint64_t revision = 0;
    std::vector<std::string> warnings = {};  ///< from reading a file, or what an exported file lacks
};
BOOST_DESCRIBE_STRUCT(Done, (), (revision, warnings))

/// Answers a Measure: the slicing::ElementMeasurements of the element.
struct Measured {
    static constexpr std::string_view kMessageType = "measured";
    std::uint64_t revision = 0;
    std::optional<double> length, area, volume;
    glm::dvec4 center{0};
};
BOOST_DESCRIBE_STRUCT(Measured, (), (revision, length, area, volume, center))

/// Answers a Ping: how busy the threads are that slice and draw pictures.
struct Pong {
    static constexpr std::string_view kMessageType = "pong";
    std::uint64_t workers = 0;  ///< the number of these threads
    std::uint64_t waiting = 0;  ///< the number of jobs, mostly pictures, that wait for one of them
    double busy = 0;            ///< the total running time of all jobs that have ended, in seconds
    double time = 0;            ///< the time of a steady clock, in seconds
};
BOOST_DESCRIBE_STRUCT(Pong, (), (workers, waiting, busy, time))

/// An answer whose members are described with Boost.Describe. GetTarget::address is answered with an OpenAddress whose
/// query describes the session's view.
using Answer = std::variant<Done, Measured, Pong, session::OpenAddress>;

}  // namespace oval4d::wire

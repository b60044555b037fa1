#pragma once
// Parsed messages from clients, and those answers to them whose members are described with Boost.Describe. The constant
// kMessageType of a struct is the type of the messages that it represents. If the members of the struct are described,
// the messages have members of the same names.

#include <array>
#include <boost/describe/class.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "export/export_request.hpp"
#include "scene/scene.hpp"
#include "session/command.hpp"
#include "slicing/element.hpp"
#include "text/choice.hpp"
#include "wire/encoding.hpp"

namespace oval4d::wire {

/// What the server sends to a connection after each change of the session, in addition to the new state.
enum class Stream : std::uint8_t {
    none,      ///< nothing
    geometry,  ///< a `slices` message, from which the client draws the picture
    frames,    ///< a frame: the picture as a PNG file
};
inline constexpr auto kStreams = text::completeTable<text::NamedValue<Stream>>(
    {{"none", Stream::none}, {"geometry", Stream::geometry}, {"frames", Stream::frames}});

/// The first message of a connection, which joins or creates a session. A later `hello` changes the stream of the
/// connection.
struct Hello {
    static constexpr std::string_view kMessageType = "hello";
    Stream stream = Stream::none;
    Encoding encoding = Encoding::json;
    std::optional<scene::Viewport> viewport;     ///< the size of the pictures; if absent, the server chooses it
    scene::Scheme scheme = scene::Scheme::dark;  ///< for pictures with scene::Background::automatic
    std::optional<std::string> token;            ///< the token of the session that the connection joins
    bool operator==(const Hello&) const = default;
};
/// The data that a `get` message requests.
enum class GetTarget : std::uint8_t { state, slices, frame, at, file, critical, catalogue, keymap, address };
inline constexpr auto kGetTargets =
    text::completeTable<text::NamedValue<GetTarget>>({{"state", GetTarget::state},
                                                      {"slices", GetTarget::slices},
                                                      {"frame", GetTarget::frame},
                                                      {"at", GetTarget::at},
                                                      {"file", GetTarget::file},
                                                      {"critical", GetTarget::critical},
                                                      {"catalogue", GetTarget::catalogue},
                                                      {"keymap", GetTarget::keymap},
                                                      {"address", GetTarget::address}});

/// Requests data once.
struct Get {
    static constexpr std::string_view kMessageType = "get";
    GetTarget what = GetTarget::state;
    std::optional<scene::Viewport>
        viewport;  ///< for GetTarget::slices, frame and at; if absent, the connection's viewport is used
    std::optional<scene::Background> background;  ///< for GetTarget::slices and frame; if absent, that of the session
    /// For GetTarget::slices and frame: the highlighted element, or an inner optional that is empty for none. If the
    /// outer optional is empty, the element that the session highlights.
    std::optional<std::optional<slicing::Element>> highlight;
    glm::dvec2 point{0};  ///< for GetTarget::at: pixels from the upper left corner
    /// For GetTarget::at: the point of a field whose values are asked, after the rotation and in the coordinates of the
    /// object's file, instead of `point`.
    std::optional<glm::dvec4> fieldPoint;
    exports::ExportRequest file;  ///< the options of the export, for GetTarget::file
    bool operator==(const Get&) const = default;
};
/// Asks for the center and the size of an element.
struct Measure {
    static constexpr std::string_view kMessageType = "measure";
    slicing::ElementKind element = slicing::ElementKind::vertex;  ///< the kind of the element
    std::size_t number = 0;                                       ///< slicing::Element::index
    bool highlight = false;                                       ///< whether the answer has `highlight` and `range`
};
BOOST_DESCRIBE_STRUCT(Measure, (), (element, number, highlight))
/// Answers a Measure: the slicing::ElementMeasurements of the element.
struct Measured {
    static constexpr std::string_view kMessageType = "measured";
    std::uint64_t revision = 0;
    std::optional<double> length, area, volume;
    glm::dvec4 center{0};
    std::optional<std::uint64_t> kind = {};  ///< of a cell: its type, as an index into ObjectInfo::cellTypes
    std::optional<std::string> unit = {};    ///< of the length, the area or the volume; absent if unknown
    std::optional<std::string> name = {};    ///< of a 2-face: that of its polygon
    /// If the request asks for it: what shows the element in pictures, and the least and the greatest w of its vertices
    /// in the coordinates of what is shown.
    std::optional<slicing::PartsShowingElement> highlight = {};
    std::optional<glm::dvec2> range = {};
};
BOOST_DESCRIBE_STRUCT(Measured, (), (revision, length, area, volume, center, kind, unit, name, highlight, range))

/// Reports that the client has shown the picture with this revision.
struct PictureShown {
    static constexpr std::string_view kMessageType = "shown";
    std::uint64_t revision = 0;
};
BOOST_DESCRIBE_STRUCT(PictureShown, (), (revision))

/// Asks for the server's load.
struct Ping {
    static constexpr std::string_view kMessageType = "ping";
};
BOOST_DESCRIBE_STRUCT(Ping, (), ())
/// Answers a Ping: how busy the threads are that slice and draw pictures.
struct Pong {
    static constexpr std::string_view kMessageType = "pong";
    std::uint64_t workers = 0;  ///< the number of threads that slice and draw pictures
    std::uint64_t waiting = 0;  ///< the number of jobs, mostly pictures, that wait for such a thread
    double busy = 0;            ///< the total running time of all jobs that have ended, in seconds
    double time = 0;            ///< the time of a steady clock, in seconds
};
BOOST_DESCRIBE_STRUCT(Pong, (), (workers, waiting, busy, time))

/// Answers a request that took effect, unless another message answers it.
struct Done {
    static constexpr std::string_view kMessageType = "done";
    std::uint64_t revision = 0;
    std::vector<std::string> warnings = {};  ///< about a file that was read, or what an exported file lacks
};
BOOST_DESCRIBE_STRUCT(Done, (), (revision, warnings))

/// One message to the server.
struct Request {
    std::optional<double> id;  ///< repeated in the answer
    std::variant<Hello, session::Command, Get, Measure, Ping, PictureShown> body;
};

/// An answer whose members are described. GetTarget::address is answered with a ShowLinkedView whose query describes
/// the session's view.
using Answer = std::variant<Done, Measured, Pong, session::ShowLinkedView>;

}  // namespace oval4d::wire

#pragma once
// Parsed messages from clients, and answers whose members are described with Boost.Describe. The constant kMessageType
// of a struct is the type of its messages. If the members of a struct are described, the messages have members with the
// same names.

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

/// What the server sends to a client after each change of the session, in addition to the new state.
enum class StreamKind : std::uint8_t {
    none,      ///< nothing besides the state
    geometry,  ///< a `slices` message, from which the client draws the picture itself
    frames,    ///< a picture of the state as a PNG file
};
inline constexpr auto kStreams = text::completeTable<text::NamedValue<StreamKind>>(
    {{"none", StreamKind::none}, {"geometry", StreamKind::geometry}, {"frames", StreamKind::frames}});

/// The first message on a connection, which joins or creates a session. A later `hello` changes the stream of the
/// connection.
struct Hello {
    static constexpr std::string_view kMessageType = "hello";
    StreamKind stream = StreamKind::none;
    Encoding encoding = Encoding::json;
    std::optional<scene::Viewport> viewport;  ///< the size of the pictures; if absent, the server chooses the size
    /// The color scheme of the pictures for this client, if their background is scene::Background::automatic.
    scene::ColorScheme scheme = scene::ColorScheme::dark;
    /// The secret token of the session to join. Present only if the address of the connection names a session.
    std::optional<std::string> token;
    bool operator==(const Hello&) const = default;
};
/// The kind of data that a `get` message requests.
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

/// A request for data, which the server answers once.
struct Get {
    static constexpr std::string_view kMessageType = "get";
    GetTarget what = GetTarget::state;
    std::optional<scene::Viewport>
        /// For GetTarget::slices, frame and at: the size of the picture. If absent, the size from the `hello` of the
        /// connection.
        viewport;
    /// For GetTarget::slices and frame: the background. If absent, the background of the session.
    std::optional<scene::Background> background;
    /// For GetTarget::slices and frame: the element to highlight. The inner optional is empty for no highlight. The
    /// outer optional is empty for the element that the session highlights.
    std::optional<std::optional<slicing::Element>> highlight;
    glm::dvec2 point{0};  ///< for GetTarget::at: a position in pixels from the upper left corner
    /// For GetTarget::at, instead of `point`: a point of a field, whose values are requested. The point is given after
    /// the rotation, in the coordinates of the object's file.
    std::optional<glm::dvec4> fieldPoint;
    exports::ExportRequest file;  ///< for GetTarget::file: the options of the export
    bool operator==(const Get&) const = default;
};
/// A request for the center and the size of an element (a cell, face, edge or vertex).
struct Measure {
    static constexpr std::string_view kMessageType = "measure";
    /// Whether to measure a cell, a face, an edge or a vertex.
    slicing::ElementKind element = slicing::ElementKind::vertex;
    /// The index of the element among the elements of its kind.
    std::size_t number = 0;
    /// Whether the answer contains `highlight` and `range`.
    bool highlight = false;
};
BOOST_DESCRIBE_STRUCT(Measure, (), (element, number, highlight))
/// The answer to a Measure: the center and the sizes of the element, from slicing::ElementMeasurements.
struct Measured {
    static constexpr std::string_view kMessageType = "measured";
    std::uint64_t revision = 0;
    std::optional<double> length, area, volume;
    glm::dvec4 center{0};
    /// For a cell: its type, as an index into ObjectInfo::cellTypes.
    std::optional<std::uint64_t> kind = {};
    std::optional<std::string> unit = {};  ///< the unit of `length`, `area` or `volume`; absent if unknown
    std::optional<std::string> name = {};  ///< for a 2-face: the name of its polygon
    /// `highlight` is the vertices and edges that show the element in pictures. `range` is the least and the greatest w
    /// of the element's vertices, in the coordinates of the shown object. `highlight` and `range` are present only if
    /// the request asks for them.
    std::optional<slicing::PartsShowingElement> highlight = {};
    std::optional<glm::dvec2> range = {};
};
BOOST_DESCRIBE_STRUCT(Measured, (), (revision, length, area, volume, center, kind, unit, name, highlight, range))

/// A report that the client has shown the picture of the state with this revision.
struct PictureShown {
    static constexpr std::string_view kMessageType = "shown";
    std::uint64_t revision = 0;
};
BOOST_DESCRIBE_STRUCT(PictureShown, (), (revision))

/// A request for the load of the server.
struct Ping {
    static constexpr std::string_view kMessageType = "ping";
};
BOOST_DESCRIBE_STRUCT(Ping, (), ())
/// The answer to a Ping: how busy the threads are that compute slices and draw pictures.
struct Pong {
    static constexpr std::string_view kMessageType = "pong";
    std::uint64_t workers = 0;  ///< the number of threads that compute slices and draw pictures
    std::uint64_t waiting = 0;  ///< the number of jobs, mostly pictures, that wait for such a thread
    double busy = 0;            ///< the total running time of all finished jobs, in seconds
    double time = 0;            ///< the time at which the answer was made, on a monotonic clock in seconds
};
BOOST_DESCRIBE_STRUCT(Pong, (), (workers, waiting, busy, time))

/// The answer to a request that took effect and has no answer of its own.
struct Done {
    static constexpr std::string_view kMessageType = "done";
    std::uint64_t revision = 0;
    /// Warnings about a file that was read, or about what an exported file lacks.
    std::vector<std::string> warnings = {};
};
BOOST_DESCRIBE_STRUCT(Done, (), (revision, warnings))

/// A message to the server.
struct Request {
    std::optional<double> id;  ///< the server repeats the id in its answer
    std::variant<Hello, session::Command, Get, Measure, Ping, PictureShown> body;
};

/// An answer with described members. A request for GetTarget::address is answered with a ShowLinkedView, whose query
/// describes the view of the session.
using Answer = std::variant<Done, Measured, Pong, session::ShowLinkedView>;

}  // namespace oval4d::wire

#pragma once
// Writes the messages from the server to clients as JSON text, except `slices` and `state`. In all functions, `id` is
// the id of the request that the message answers. `id` is absent if the message answers no request, or a request
// without an id.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "scene/pick.hpp"
#include "scene/pick_level.hpp"
#include "session/session.hpp"
#include "slicing/critical/critical_sections.hpp"
#include "slicing/field_sample.hpp"
#include "wire/request.hpp"

namespace oval4d::wire {

/// Returns the message with the members of `answer`, in the order of BOOST_DESCRIBE_STRUCT. Omits empty optionals and
/// empty lists.
std::string answerMessage(const Answer& answer, std::optional<double> id);

/// What a picture shows at one pixel.
struct PictureAtPixel {
    /// The element (cell, face, edge or vertex) at the pixel, unless `level` is nearer to the viewer.
    std::optional<scene::PickedElement> element;
    std::optional<scene::PickedLevel> level;     ///< the surface or contour of a field at the pixel
    std::optional<slicing::FieldSample> sample;  ///< the values of the field at PickedLevel::point; present only if
                                                 ///< `level` is present
    /// If the pixel is in a panel of the matrix (planar sections in all pairs of axes): the 4-D point there, in the
    /// coordinates of the rotated object.
    std::optional<glm::dvec4> panelPoint;
};

/// Returns the `at` message, which describes what a picture shows at a pixel. `scene` is the picture of `object`.
/// `source` is the object before it was transformed to the frame of reference (see session::State). The name of a
/// 2-face describes its shape in `source`, because the transformation may change the shape.
std::string pickMessage(const PictureAtPixel& at, const scene::Scene& scene, const slicing::Object& object,
                        const slicing::Object& source, std::uint64_t revision, std::optional<double> id);

/// Returns the `at` message that answers a request for the values of a field at a point.
std::string sampleMessage(const slicing::FieldSample& sample, std::uint64_t revision, std::optional<double> id);

/// Returns the `critical` message: the values of w at which the section of the object changes its type, in the
/// coordinates of the object's file. `originW` is the w of the object's geometry::ObjectInfo::originInFile.
std::string criticalMessage(const slicing::CriticalSections& sections, double originW, std::uint64_t revision,
                            std::optional<double> id);

/// Returns the `error` message for an error.
std::string errorMessage(const Error& error, std::optional<double> id);
/// Returns the `catalogue` message: a list of the polytopes of the catalogue, the example fields, loaded objects and
/// arrays. `loaded` has the objects loaded into the session, and `data` the names of the arrays in the server's data
/// folder.
std::string catalogueMessage(std::optional<double> id, std::span<const slicing::Object> loaded = {},
                             std::span<const std::string> data = {});
/// Returns the `keymap` message, which contains the key table of protocol/keymap.json.
std::string keymapMessage(std::optional<double> id);

/// Returns the `welcome` message. `session` is the id of the session, and `token` its secret token. `limits` is a JSON
/// object, as text, with the limits of the server.
std::string welcomeMessage(std::string_view session, std::string_view token, std::string_view limits,
                           std::optional<double> id);

}  // namespace oval4d::wire

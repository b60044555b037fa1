#pragma once
// Writes the messages from the server to clients, except `slices` and `state`, as JSON text. `id` is the id of the
// request that the message answers; it is absent if the message answers no request, or a request without an id.

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

/// Returns the message with the members of `answer`, in the order of BOOST_DESCRIBE_STRUCT. Omits members that are an
/// empty optional or an empty list.
std::string answerMessage(const Answer& answer, std::optional<double> id);

/// What a picture shows at a pixel.
struct PictureAtPixel {
    std::optional<scene::PickedElement> element;  ///< the element there, unless `level` is nearer to the viewer
    std::optional<scene::PickedLevel> level;      ///< the surface or the contour of a field there
    std::optional<slicing::FieldSample> sample;   ///< the field at PickedLevel::point; present if `level` is
    /// If a panel of the matrix is there, the 4-D point that it shows, in the coordinates of the rotated object.
    std::optional<glm::dvec4> panelPoint;
};

/// Returns the `at` message, which describes what the picture `scene` of `object` shows at a pixel. `source`: the
/// object before it was transformed to the frame of reference (see session::State), in which a 2-face has the shape for
/// which it is named.
std::string atMessage(const PictureAtPixel& at, const scene::Scene& scene, const slicing::Object& object,
                      const slicing::Object& source, std::uint64_t revision, std::optional<double> id);

/// Returns the `at` message that answers a request for the values of a field at a point.
std::string sampleMessage(const slicing::FieldSample& sample, std::uint64_t revision, std::optional<double> id);

/// Returns the `critical` message: the critical values of w of the object, in the coordinates of the object's file.
/// `originW`: the w of the object's geometry::ObjectInfo::originInFile.
std::string criticalMessage(const slicing::CriticalSections& sections, double originW, std::uint64_t revision,
                            std::optional<double> id);

/// Returns the `error` message.
std::string errorMessage(const Error& error, std::optional<double> id);
/// Returns the `catalogue` message: the entries of the catalogue and the example fields, followed by the session's
/// loaded objects and by the arrays in the data folder. `data` are the names of these arrays.
std::string catalogueMessage(std::optional<double> id, std::span<const slicing::Object> loaded = {},
                             std::span<const std::string> data = {});
/// Returns the `keymap` message, the key table of protocol/keymap.json.
std::string keymapMessage(std::optional<double> id);

/// Returns the `welcome` message. `session` is the id of the session, and `token` its secret token. `limits`: the
/// limits of the server, as the text of a JSON object.
std::string welcomeMessage(std::string_view session, std::string_view token, std::string_view limits,
                           std::optional<double> id);

}  // namespace oval4d::wire

#pragma once
// Writes the messages from the server to clients, except `slices`, as JSON text. `id` is the id of the request that the
// message answers; it is absent if the message answers no request, or one without an id.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "scene/pick.hpp"
#include "session/session.hpp"
#include "slicing/section_name.hpp"

namespace oval4d::wire {

/// Returns the `state` message of a state, whose focus slice has the names `section`. The PNG files of frames contain
/// the same text.
std::string stateMessage(const session::State& state, const slicing::SectionNames& section, std::uint64_t revision,
                         std::optional<double> id = {});
/// Writes the `state` message to `out`. Overwrites `out` and reuses its memory.
void stateMessage(const session::State& state, const slicing::SectionNames& section, std::uint64_t revision,
                  std::optional<double> id, std::string& out);

/// Returns the `at` message: what the picture `scene` of `object` shows at a point. `picked` is empty if that is
/// nothing. `point` is the point of the object's space that a panel of the matrix shows there, if there is a panel.
std::string atMessage(const std::optional<scene::PickedElement>& picked, const std::optional<glm::dvec4>& point,
                      const scene::Scene& scene, const slicing::Object& object, std::uint64_t revision,
                      std::optional<double> id);

/// Returns the `error` message.
std::string errorMessage(const Error& error, std::optional<double> id);
/// Returns the `done` message. `warnings` are the warnings from reading a file.
std::string doneMessage(std::optional<double> id, std::uint64_t revision,
                        const std::vector<std::string>& warnings = {});
/// Returns the `catalogue` message: the entries of the catalogue, followed by the session's loaded objects.
std::string catalogueMessage(std::optional<double> id, std::span<const slicing::Object> loaded = {});
/// Returns the `keymap` message, the key table of protocol/keymap.json.
std::string keymapMessage(std::optional<double> id);

/// Returns the `welcome` message. `session` is the id of the session, and `token` its secret token. `limits` is the
/// text of a JSON object.
std::string welcomeMessage(std::string_view session, std::string_view token, std::string_view limits,
                           std::optional<double> id);

}  // namespace oval4d::wire

#pragma once
// A slice, or the whole oval, as a file that other programs open.

#include <chrono>
#include <cstddef>
#include <stop_token>
#include <string>
#include <variant>

#include "export/wish.hpp"
#include "geometry/polytope.hpp"
#include "geometry/rotation.hpp"
#include "geometry/slice_set.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Bounds on the work for one file.
struct Limits {
    std::size_t triangles = 5'000'000;
    std::size_t bytes = 512U << 20U;
    std::chrono::duration<double> time{20};
};

/// What is exported: `planes` are those of the oval, `focus` the index n of the focus slice.
struct Subject {
    const geometry::Polytope& polytope;
    const geometry::Rotation& orientation;
    geometry::Hyperplanes planes;
    int focus = 0;
    scene::Colouring colouring = scene::Colouring::cell;
};

/// Why there is no file. `message` is a sentence for the user.
struct Refusal {
    enum class Cause : std::uint8_t {
        no_body,    ///< the slice is empty or flat, or the label does not fit
        too_large,  ///< beyond Limits::triangles or bytes
        too_long,   ///< beyond Limits::time, or stopped
    };
    Cause cause;
    std::string message;
};

/// The bytes of the file. Bodies are in millimetres (a GLB in metres, as glTF has it), closed and 2-manifold: every
/// edge lies in two triangles that run along it in opposite directions, and normals point outward.
/// Goes on until `stop` asks it to end.
std::variant<std::string, Refusal> fileOf(const Subject& subject, const Wish& wish, const Limits& limits,
                                          std::stop_token stop = {});

}  // namespace oval4d::exports

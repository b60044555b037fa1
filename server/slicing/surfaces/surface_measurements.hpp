#pragma once
// Measures the body that a closed surface bounds: the volume, surface area, centroid and topology of the body.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "slicing/closed_surfaces/closed_surface.hpp"
#include "slicing/surfaces/slice_surface.hpp"

namespace oval4d::slicing {

/// The measurements of the body inside a closed surface that is oriented outward. The unit of length is that of the
/// object.
struct SurfaceMeasurements {
    double volume = 0;
    double area = 0;                     ///< the area of the level set, without caps
    double capArea = 0;                  ///< the area of the caps
    std::optional<glm::dvec3> centroid;  ///< the centroid of the body; empty unless the volume is positive
    /// The number of connected components of the body. Each component has one outer surface, which encloses a positive
    /// volume. The surface of a cavity encloses a negative volume, and does not count as a component.
    std::size_t components = 0;
    /// The Euler characteristic of the surface, including its caps: the sum of 2 − 2 · genus over the connected parts
    /// of the surface. This is twice the Euler characteristic of the body: 2 for a ball, 4 for a ball with a cavity,
    /// and 0 for a solid torus.
    long euler = 0;
};

/// Measures the surface of one level of a slice. `level` is the index of the level, as in SliceSurface::levelIndex().
SurfaceMeasurements measureSurface(const SliceSurface& surface, std::size_t level);

/// Returns the mean over the level set, without caps, of a function, weighted by area. `values` are the values of the
/// function at the points of `surface`. The function is treated as linear in each triangle. Ignores triangles with a
/// value that is not finite. Returns an empty optional if the area of the remaining triangles is 0.
std::optional<double> meanOnSurface(const ClosedSurface& surface, std::span<const float> values);

/// The connected parts of the surface of one level.
struct SurfaceComponents {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// The volume that a connected part encloses, and its Euler characteristic.
    struct SurfacePart {
        double volume = 0;  ///< in cubic units of the object; negative for the surface of a cavity
        long euler = 0;     ///< the Euler characteristic of the part
    };
    /// Per point: the index in `parts` of the part to which the point belongs; kNone for points of other levels.
    std::vector<std::uint32_t> ofPoint;
    std::vector<SurfacePart> parts;
};

/// Finds the connected parts of the surface of the level with the index `level`.
SurfaceComponents findConnectedParts(const SliceSurface& surface, std::size_t level);

/// Measures a closed surface in one slice.
SurfaceMeasurements measureSurface(const ClosedSurface& surface);

}  // namespace oval4d::slicing

#pragma once
// The ways in which a surface can pass through a cube, depending on which corners of the cube are inside the body: the
// cases of dual marching cubes (G. Nielson, "Dual marching cubes", 2004).

#include <array>
#include <cstdint>

namespace oval4d::slicing {

/// The two corners of each edge of a cube. Corner x + 2y + 4z has the coordinates x, y, z in {0, 1}. Edge 4a + u + 2v
/// is parallel to axis a; u and v in {0, 1} are its coordinates along the other two axes: u along the one that comes
/// first in the order x, y, z. Face 2a + s is perpendicular to axis a, at the coordinate s in {0, 1} along this axis.
inline constexpr std::array<std::array<std::uint8_t, 2>, 12> kCubeEdges = [] {
    std::array<std::array<std::uint8_t, 2>, 12> edges{};
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
        const std::uint8_t first = axis == 0 ? 2 : 1, second = axis == 2 ? 2 : 4;
        for (std::uint8_t i = 0; i < 4; ++i) {
            const auto from = static_cast<std::uint8_t>((i & 1) * first + (i >> 1) * second);
            edges[4 * axis + i] = {from, static_cast<std::uint8_t>(from + (1 << axis))};
        }
    }
    return edges;
}();

/// The way in which a surface passes through a cube: in one or more patches. Each patch is bounded by a closed loop.
/// The loop visits edges of the cube that have one end inside the body and the other end outside.
struct CubeCase {
    static constexpr std::uint8_t kNoPatch = 0xff;
    static constexpr std::uint8_t kNoFace = 0xff;

    std::uint8_t patches = 0;  ///< the number of patches, 0 … 4
    /// Per edge: the index of its patch; kNoPatch if both ends are on the same side of the surface.
    std::array<std::uint8_t, 12> patchOfEdge{};
    /// The face of the cube whose corners are alternately inside and outside, and whose four edges belong to the same
    /// patch; kNoFace if there is no such face. If the face is also the mergingFace of the neighboring cube that shares
    /// it, the surface would touch itself along an edge there. In this case, use joinedCubeCase() for both cubes.
    std::uint8_t mergingFace = kNoFace;
};

/// Returns the case of a cube. Bit c of `inside` is set if corner c is inside the body. On a face whose corners are
/// alternately inside and outside, the two inside corners are separated.
const CubeCase& cubeCase(std::uint8_t inside);

/// Returns the case of a cube like cubeCase(), except that the inside corners on the face CubeCase::mergingFace, if the
/// cube has such a face, are joined. The edges of this face then belong to two patches.
const CubeCase& joinedCubeCase(std::uint8_t inside);

}  // namespace oval4d::slicing

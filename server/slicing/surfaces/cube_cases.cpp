#include "slicing/surfaces/cube_cases.hpp"

#include <algorithm>
#include <numeric>

namespace oval4d::slicing {

namespace {

struct CubeFace {
    // The corners and edges of the face in cyclic order; edge i joins corners i and (i + 1) mod 4.
    std::array<std::uint8_t, 4> corners, edges;
};

std::array<CubeFace, 6> makeCubeFaces() {
    std::array<CubeFace, 6> faces{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const unsigned first = axis == 0 ? 2 : 1, second = axis == 2 ? 2 : 4;
        for (unsigned side = 0; side < 2; ++side) {
            CubeFace& face = faces[2 * axis + side];
            const unsigned origin = side << axis;
            const std::array<unsigned, 4> cycle{origin, origin + first, origin + first + second, origin + second};
            std::ranges::copy(cycle, face.corners.begin());
            for (std::size_t i = 0; i < 4; ++i) {
                const auto [low, high] = std::minmax(face.corners[i], face.corners[(i + 1) % 4]);
                const auto edge = std::ranges::find(kCubeEdges, std::array<std::uint8_t, 2>{low, high});
                face.edges[i] = static_cast<std::uint8_t>(edge - kCubeEdges.begin());
            }
        }
    }
    return faces;
}

// Returns the case of a cube. Bit c of `inside` is set if corner c is inside the body. On the face with the index
// `joined`, if its corners are alternately inside and outside, joins the inside corners. On all other faces, separates
// them.
CubeCase makeCubeCase(unsigned inside, const std::array<CubeFace, 6>& faces, std::size_t joined) {
    const auto isInside = [&](std::uint8_t corner) { return (inside >> corner & 1U) != 0; };
    // loop[e] is the least number of an edge that is in the same loop as edge e.
    std::array<std::uint8_t, 12> loop{};
    std::iota(loop.begin(), loop.end(), std::uint8_t{0});
    const auto link = [&](std::uint8_t a, std::uint8_t b) {
        const auto [low, high] = std::minmax(loop[a], loop[b]);
        std::ranges::replace(loop, std::uint8_t{high}, std::uint8_t{low});
    };
    CubeCase result;
    std::uint8_t alternating = 0;  // a bit for each face: whether the face's corners are alternately inside and outside
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& [corners, edges] = faces[f];
        std::array<std::uint8_t, 4> crossed{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (isInside(corners[i]) != isInside(corners[(i + 1) % 4])) crossed[count++] = edges[i];
        }
        if (count == 2) link(crossed[0], crossed[1]);
        if (count < 4) continue;
        alternating |= static_cast<std::uint8_t>(1U << f);
        for (std::size_t i = 0; i < 4; ++i) {
            if (isInside(corners[i]) != (f == joined)) link(edges[(i + 3) % 4], edges[i]);
        }
    }
    std::array<std::uint8_t, 12> patchOfLoop{};
    result.patchOfEdge.fill(CubeCase::kNoPatch);
    for (std::uint8_t e = 0; e < 12; ++e) {
        if (isInside(kCubeEdges[e][0]) == isInside(kCubeEdges[e][1])) continue;
        if (loop[e] == e) patchOfLoop[e] = result.patches++;
        result.patchOfEdge[e] = patchOfLoop[loop[e]];
    }
    for (std::uint8_t f = 0; f < 6; ++f) {
        const auto& edges = faces[f].edges;
        if ((alternating >> f & 1U) != 0 && std::ranges::all_of(edges, [&](std::uint8_t e) {
                return result.patchOfEdge[e] == result.patchOfEdge[edges[0]];
            })) {
            result.mergingFace = f;  // no case has two such faces; a test checks this
        }
    }
    return result;
}

struct CubeCaseTables {
    std::array<CubeCase, 256> usual, joined;
};

const CubeCaseTables& cubeCaseTables() {
    static const CubeCaseTables all = [] {
        const std::array<CubeFace, 6> faces = makeCubeFaces();
        CubeCaseTables made;
        for (unsigned inside = 0; inside < 256; ++inside) {
            made.usual[inside] = made.joined[inside] = makeCubeCase(inside, faces, CubeCase::kNoFace);
            const std::uint8_t merging = made.usual[inside].mergingFace;
            if (merging != CubeCase::kNoFace) made.joined[inside] = makeCubeCase(inside, faces, merging);
        }
        return made;
    }();
    return all;
}

}  // namespace

const CubeCase& cubeCase(std::uint8_t inside) { return cubeCaseTables().usual[inside]; }

const CubeCase& joinedCubeCase(std::uint8_t inside) { return cubeCaseTables().joined[inside]; }

}  // namespace oval4d::slicing

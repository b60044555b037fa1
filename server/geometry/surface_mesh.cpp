#include "geometry/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "geometry/index.hpp"

namespace oval4d::geometry {

namespace {

// Throws InvalidSurface if the vertex loop of a 2-face is invalid. `face` is the index of the 2-face, and `vertices`
// the number of vertices of the surface. Overwrites `sorted`, which is only working memory.
void checkFace(std::uint32_t face, std::span<const std::uint32_t> loop, std::size_t vertices,
               std::vector<std::uint32_t>& sorted) {
    const std::string name = "2-face " + std::to_string(face);
    if (loop.size() < 3) throw InvalidSurface(face, name + " has fewer than 3 vertices");
    sorted.assign(loop.begin(), loop.end());
    std::ranges::sort(sorted);
    if (sorted.back() >= vertices)
        throw InvalidSurface(face, name + " lists vertex " + std::to_string(sorted.back()) + ", but there are only " +
                                       std::to_string(vertices) + " vertices");
    if (std::ranges::adjacent_find(sorted) != sorted.end()) throw InvalidSurface(face, name + " lists a vertex twice");
}

}  // namespace

SurfaceMesh makeSurfaceMesh(std::string name, std::vector<glm::dvec4> vertices, JaggedArray faces) {
    if (faces.size() == 0) throw InvalidSurface(kNone, "there are no 2-faces");
    std::vector<std::uint32_t> sorted;
    for (std::size_t f = 0; f < faces.size(); ++f)
        checkFace(static_cast<std::uint32_t>(f), faces[f], vertices.size(), sorted);
    SurfaceMesh surface;
    for (const glm::dvec4& vertex : vertices) {
        const double r = glm::length(vertex);
        if (!std::isfinite(r)) throw InvalidSurface(kNone, "a vertex is not finite");
        surface.circumradius = std::max(surface.circumradius, r);
    }
    if (!(surface.circumradius > 0)) throw InvalidSurface(kNone, "all vertices are at the origin");
    surface.serial = nextSerial();
    surface.name = std::move(name);
    surface.vertices = std::move(vertices);
    surface.faces = std::move(faces);
    findEdges(surface);
    surface.convexFaces = hasConvexFaces(surface);
    return surface;
}

SurfaceMesh transformedTo(const SurfaceMesh& surface, const ReferenceFrame& frame, std::uint64_t serial) {
    SurfaceMesh image = surface;
    image.serial = serial;
    image.rebuildableFromName = false;
    image.circumradius = mapPoints(frame.matrix(), image.vertices);
    image.originInFile = frame.matrix() * surface.originInFile;
    return image;
}

std::size_t memoryOf(const SurfaceMesh& surface) { return sizeof surface + memoryOfElements(surface); }

}  // namespace oval4d::geometry

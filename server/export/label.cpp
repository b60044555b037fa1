#include "export/label.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>

#include "export/hull.hpp"
#include "export/tessellate.hpp"

namespace oval4d::exports {

namespace {

constexpr double kLeastHeight = 1;    // millimetres, of a capital letter
constexpr double kMargin = 0.6;       // capital heights around the text
constexpr double kLeastDepth = 0.25;  // millimetres
constexpr double kMostDepth = 0.8;

/// The triangles of one cell, if they are one flat piece.
struct Face {
    std::vector<std::uint32_t> loop;  // counter-clockwise
    glm::dvec3 normal{0};
    glm::dvec3 middle{0};  // of the area
};

/// Where the text goes: across = right, up, the way of reading; a unit of the text is `height` millimetres.
struct Spot {
    std::uint32_t cell = kNoCell;
    const Lettering* text = nullptr;
    glm::dvec3 middle{0}, right{0}, up{0}, normal{0};
    double height = 0, depth = 0;
};

std::map<std::uint32_t, Face> facesOf(const Mesh& mesh) {
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> rims;
    std::map<std::uint32_t, Face> faces;
    std::map<std::uint32_t, std::map<std::pair<std::uint32_t, std::uint32_t>, int>> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& triangle = mesh.triangles[t];
        Face& face = faces[mesh.cells[t]];
        const glm::dvec3 across = normalOf(mesh, triangle);
        face.normal += across;
        for (int i = 0; i < 3; ++i) {
            face.middle += glm::length(across) / 3 * mesh.points[triangle[i]];
            edges[mesh.cells[t]][{triangle[i], triangle[(i + 1) % 3]}] = 1;
        }
    }
    for (auto& [cell, face] : faces) {
        const double area = glm::length(face.normal);
        std::map<std::uint32_t, std::uint32_t> next;
        bool simple = area > 0;
        for (const auto& [edge, one] : edges[cell]) {
            if (!edges[cell].contains({edge.second, edge.first})) simple &= next.emplace(edge).second;
        }
        if (!simple || next.empty()) continue;
        face.normal /= area;
        face.middle /= area;
        for (auto at = next.begin()->first; face.loop.size() < next.size(); at = next.at(at)) face.loop.push_back(at);
        if (next.at(face.loop.back()) != face.loop.front()) face.loop.clear();  // more than one rim
    }
    std::erase_if(faces, [](const auto& entry) { return entry.second.loop.empty(); });
    return faces;
}

/// The largest text on this face that leaves the margin, read along `right`. Its height is 0 where it does not fit.
Spot fit(const Mesh& mesh, const Face& face, const glm::dvec3& right, const Lettering& text) {
    Spot spot{kNoCell, &text, face.middle, right, glm::cross(face.normal, right), face.normal, 1e300, 0};
    if (spot.up.z < -1e-9 || (std::abs(spot.up.z) < 1e-9 && spot.up.y < 0)) {
        spot.right = -spot.right;
        spot.up = -spot.up;
    }
    const glm::dvec2 half = text.size / 2.0 + kMargin;
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
        const glm::dvec3& a = mesh.points[face.loop[i]];
        const glm::dvec3& b = mesh.points[face.loop[(i + 1) % face.loop.size()]];
        const glm::dvec3 outward = glm::normalize(glm::cross(b - a, face.normal));
        const double room = glm::dot(a - face.middle, outward);
        const double need =
            half.x * std::abs(glm::dot(outward, spot.right)) + half.y * std::abs(glm::dot(outward, spot.up));
        spot.height = std::min(spot.height, room / need);
    }
    return spot;
}

/// How deep the box under the text may reach, with as much again below it, until it meets another face.
double depthAt(const Spot& spot, const std::map<std::uint32_t, Face>& faces, const Mesh& mesh) {
    double depth = kMostDepth;
    const glm::dvec2 half = (spot.text->size / 2.0 + kMargin / 2) * spot.height;
    for (const auto& [cell, face] : faces) {
        const double sinking = glm::dot(face.normal, -spot.normal);
        if (cell == spot.cell || sinking <= 0) continue;
        const double room = glm::dot(face.normal, mesh.points[face.loop[0]] - spot.middle) -
                            half.x * std::abs(glm::dot(face.normal, spot.right)) -
                            half.y * std::abs(glm::dot(face.normal, spot.up));
        depth = std::min(depth, room / sinking / 2);
    }
    return std::min(depth, spot.height / 4);
}

bool isConvex(const Mesh& mesh, const std::map<std::uint32_t, Face>& faces, const Grid& grid) {
    std::size_t corners = 0;
    for (const auto& [cell, face] : faces) {
        corners += face.loop.size() - 2;
        for (const glm::dvec3& p : mesh.points) {
            if (glm::dot(p - face.middle, face.normal) > 4 * grid.step()) return false;
        }
    }
    return corners == mesh.triangles.size();
}

/// Replaces the face by one with the text cut out, walls and floors. False if that does not come out closed.
bool cut(Mesh& mesh, const Face& face, const Spot& spot, const Grid& grid) {
    const auto flat = [&](const glm::dvec3& p) {
        return glm::dvec2(glm::dot(p - spot.middle, spot.right), glm::dot(p - spot.middle, spot.up));
    };
    std::vector<Contour> holed(1);
    std::vector<Contour> letters;
    std::vector<std::uint32_t> rim = face.loop;  // points of the mesh by the corners of `holed`
    std::vector<std::uint32_t> floor;            // by those of `letters`
    std::vector<std::uint32_t> brink;            // likewise: the points above
    for (const std::uint32_t p : face.loop) holed[0].push_back(flat(mesh.points[p]));
    Mesh made = mesh;
    for (const Contour& outline : spot.text->contours) {
        Contour contour;
        const std::size_t first = brink.size();
        for (const glm::dvec2& p : outline) {
            const glm::dvec3 top = grid.snap(spot.middle + spot.height * (p.x * spot.right + p.y * spot.up));
            if (brink.size() > first && made.points[brink.back()] == top) continue;
            brink.push_back(static_cast<std::uint32_t>(made.points.size()));
            made.points.push_back(top);
            contour.push_back(flat(top));
        }
        letters.push_back(contour);
        holed.emplace_back(contour.rbegin(), contour.rend());
        rim.insert(rim.end(), brink.rbegin(), brink.rbegin() + static_cast<std::ptrdiff_t>(contour.size()));
    }
    for (const std::uint32_t p : brink) {
        floor.push_back(static_cast<std::uint32_t>(made.points.size()));
        made.points.push_back(grid.snap(made.points[p] - spot.depth * spot.normal));
    }
    made.triangles.clear();
    made.cells.clear();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        if (mesh.cells[t] != spot.cell) made.add(a, b, c, mesh.cells[t]);
    }
    for (const auto& [a, b, c] : triangulate(holed)) made.add(rim[a], rim[b], rim[c], spot.cell);
    for (const auto& [a, b, c] : triangulate(letters)) made.add(floor[a], floor[b], floor[c], kNoCell);
    std::size_t first = 0;
    for (const Contour& contour : letters) {
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const std::size_t p = first + i;
            const std::size_t q = first + (i + 1) % contour.size();
            made.add(brink[p], brink[q], floor[q], kNoCell);
            made.add(brink[p], floor[q], floor[p], kNoCell);
        }
        first += contour.size();
    }
    if (!isClosedManifold(made)) return false;
    mesh = std::move(made);
    return true;
}

}  // namespace

Caption::Caption(const std::string& name, const std::string& w)
    : versions_{letteringOf({name + "  " + w}), letteringOf({name, w})} {}

bool Caption::engrave(Mesh& mesh, double size, const Grid& grid) const {
    const auto faces = facesOf(mesh);
    if (!isConvex(mesh, faces, grid)) return false;
    std::vector<Spot> spots;
    for (const auto& [cell, face] : faces) {
        for (std::size_t i = 0; i < face.loop.size(); ++i) {
            const glm::dvec3 along = mesh.points[face.loop[(i + 1) % face.loop.size()]] - mesh.points[face.loop[i]];
            const glm::dvec3 right = glm::normalize(along - glm::dot(along, face.normal) * face.normal);
            for (const Lettering& text : versions_) {
                Spot spot = fit(mesh, face, right, text);
                spot.cell = cell;
                spot.height = std::min(spot.height, size / 10);
                if (spot.height < kLeastHeight) continue;
                spot.depth = depthAt(spot, faces, mesh);
                if (spot.depth >= kLeastDepth) spots.push_back(spot);
            }
        }
    }
    std::ranges::stable_sort(spots, std::greater<>{}, &Spot::height);
    return std::ranges::any_of(spots, [&](const Spot& spot) { return cut(mesh, faces.at(spot.cell), spot, grid); });
}

Mesh Caption::plate(double size, const Grid& grid) const {
    const double height = std::clamp(size / 15, 3.0, 12.0);
    const Lettering& text = versions_.back();
    const glm::dvec2 extent = (text.size + 2.2 * kMargin) * height;
    constexpr double kThickness = 2;
    std::vector<glm::dvec3> corners;
    for (const double x : {-extent.x / 2, extent.x / 2}) {
        for (const double y : {-extent.y, 0.0}) {
            for (const double z : {0.0, kThickness}) corners.push_back(grid.snap({x, y, z}));
        }
    }
    Mesh mesh = hullOf(corners, grid);
    // A face of a box is told by the axis and the side that it looks to.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 normal = normalOf(mesh, mesh.triangles[t]);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            if (normal[axis] != 0) mesh.cells[t] = 2 * axis + (normal[axis] > 0 ? 1 : 0);
        }
    }
    const auto faces = facesOf(mesh);
    const Face& top = faces.at(5);
    Spot spot = fit(mesh, top, {1, 0, 0}, text);
    spot.cell = 5;
    spot.height = height;
    spot.depth = std::min(kMostDepth, height / 4);
    if (!cut(mesh, top, spot, grid)) throw std::runtime_error("a label cannot be cut into its plate");
    std::ranges::fill(mesh.cells, kNoCell);
    return mesh;
}

}  // namespace oval4d::exports

#include "export/label/label.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>

#include "export/mesh/hull.hpp"
#include "export/mesh/tessellate.hpp"

namespace oval4d::exports {

namespace {

constexpr double kMinHeight = 1;    // minimum height of a capital letter, in millimeters
constexpr double kMargin = 0.6;     // margin around the text, in heights of a capital letter
constexpr double kMinDepth = 0.25;  // minimum depth of letters, in millimeters
constexpr double kMaxDepth = 0.8;   // maximum depth of letters, in millimeters

/// A face of a body: all triangles of the mesh with the same cell.
struct BodyFace {
    std::vector<std::uint32_t> loop;  // indices of mesh points, counterclockwise
    glm::dvec3 normal{0};
    glm::dvec3 middle{0};  // centroid of the face
};

/// A place for the text on a face. `middle` is the center of the text, `right` the reading direction, and `up` the
/// direction from the feet of letters to their tops. `normal` is the outward normal of the face. `height` is the height
/// of a capital letter, and `depth` the depth of letters, both in millimeters.
struct TextPlacement {
    std::uint32_t cell = kNoCell;
    const TextOutlines* text = nullptr;
    glm::dvec3 middle{0}, right{0}, up{0}, normal{0};
    double height = 0, depth = 0;
};

/// Returns the faces of the mesh. The key of a face is its cell. Leaves out faces without area, faces with holes, and
/// faces in several parts.
std::map<std::uint32_t, BodyFace> facesOf(const Mesh& mesh) {
    std::map<std::uint32_t, BodyFace> faces;
    std::map<std::uint32_t, std::map<std::pair<std::uint32_t, std::uint32_t>, int>> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& triangle = mesh.triangles[t];
        BodyFace& face = faces[mesh.cells[t]];
        const glm::dvec3 across = doubleAreaNormalOf(mesh, triangle);
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
        if (next.at(face.loop.back()) != face.loop.front()) face.loop.clear();  // the face has several boundary loops
    }
    std::erase_if(faces, [](const auto& entry) { return entry.second.loop.empty(); });
    return faces;
}

/// Returns a place with the text in the middle of `face`, in the largest size that leaves a margin of kMargin. The text
/// runs along `right` or, if the letters would then be upside down, in the opposite direction. The caller must set
/// `cell` and `depth` of the result.
TextPlacement largestTextPlacement(const Mesh& mesh, const BodyFace& face, const glm::dvec3& right,
                                   const TextOutlines& text) {
    TextPlacement placement{kNoCell, &text, face.middle, right, glm::cross(face.normal, right), face.normal, 1e300, 0};
    if (placement.up.z < -1e-9 || (std::abs(placement.up.z) < 1e-9 && placement.up.y < 0)) {
        placement.right = -placement.right;
        placement.up = -placement.up;
    }
    const glm::dvec2 half = text.size / 2.0 + kMargin;
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
        const glm::dvec3& a = mesh.points[face.loop[i]];
        const glm::dvec3& b = mesh.points[face.loop[(i + 1) % face.loop.size()]];
        const glm::dvec3 outward = glm::normalize(glm::cross(b - a, face.normal));
        const double room = glm::dot(a - face.middle, outward);
        const double need =
            half.x * std::abs(glm::dot(outward, placement.right)) + half.y * std::abs(glm::dot(outward, placement.up));
        placement.height = std::min(placement.height, room / need);
    }
    return placement;
}

/// Returns the depth of letters, the least of three lengths: kMaxDepth; a quarter of the letters' height; and half the
/// distance by which the rectangle around the text can be moved into the body before it meets the plane of another
/// face.
double engravingDepthAt(const TextPlacement& placement, const std::map<std::uint32_t, BodyFace>& faces,
                        const Mesh& mesh) {
    double depth = kMaxDepth;
    const glm::dvec2 half = (placement.text->size / 2.0 + kMargin / 2) * placement.height;
    for (const auto& [cell, face] : faces) {
        const double sinking = glm::dot(face.normal, -placement.normal);
        if (cell == placement.cell || sinking <= 0) continue;
        const double room = glm::dot(face.normal, mesh.points[face.loop[0]] - placement.middle) -
                            half.x * std::abs(glm::dot(face.normal, placement.right)) -
                            half.y * std::abs(glm::dot(face.normal, placement.up));
        depth = std::min(depth, room / sinking / 2);
    }
    return std::min(depth, placement.height / 4);
}

/// Returns whether the mesh is convex and consists of exactly these faces, none of which has a hole. Points may lie up
/// to four grid steps outside the plane of a face. Throws ExportRefused if the time limit is exceeded or a stop was
/// requested.
bool isConvex(const Mesh& mesh, const std::map<std::uint32_t, BodyFace>& faces, const RoundingGrid& grid,
              const ExportBudget& budget) {
    std::size_t triangles = 0;
    for (const auto& [cell, face] : faces) {
        budget.checkTimeAndStop();
        triangles += face.loop.size() - 2;
        for (const glm::dvec3& p : mesh.points) {
            if (glm::dot(p - face.middle, face.normal) > 4 * grid.step()) return false;
        }
    }
    return triangles == mesh.triangles.size();
}

/// Engraves the text into a face of `mesh`: cuts holes for letters into the face, and adds the walls and floors of the
/// letters. Returns false and leaves the mesh unchanged if the result would not be a closed manifold.
bool engraveText(Mesh& mesh, const BodyFace& face, const TextPlacement& placement, const RoundingGrid& grid) {
    const auto flat = [&](const glm::dvec3& p) {
        return glm::dvec2(glm::dot(p - placement.middle, placement.right),
                          glm::dot(p - placement.middle, placement.up));
    };
    std::vector<Contour> holed(1);
    std::vector<Contour> letters;
    std::vector<std::uint32_t> boundary = face.loop;  // for each corner of `holed`: the mesh point there
    std::vector<std::uint32_t> bottoms;               // for each corner of `letters`: the mesh point below it
    std::vector<std::uint32_t> tops;                  // for each corner of `letters`: the mesh point there
    for (const std::uint32_t p : face.loop) holed[0].push_back(flat(mesh.points[p]));
    Mesh result = mesh;
    for (const Contour& outline : placement.text->contours) {
        Contour contour;
        const std::size_t first = tops.size();
        for (const glm::dvec2& p : outline) {
            const glm::dvec3 top =
                grid.snap(placement.middle + placement.height * (p.x * placement.right + p.y * placement.up));
            if (tops.size() > first && result.points[tops.back()] == top) continue;
            tops.push_back(static_cast<std::uint32_t>(result.points.size()));
            result.points.push_back(top);
            contour.push_back(flat(top));
        }
        letters.push_back(contour);
        holed.emplace_back(contour.rbegin(), contour.rend());
        boundary.insert(boundary.end(), tops.rbegin(), tops.rbegin() + static_cast<std::ptrdiff_t>(contour.size()));
    }
    for (const std::uint32_t p : tops) {
        bottoms.push_back(static_cast<std::uint32_t>(result.points.size()));
        result.points.push_back(grid.snap(result.points[p] - placement.depth * placement.normal));
    }
    result.triangles.clear();
    result.cells.clear();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        if (mesh.cells[t] != placement.cell) result.add(a, b, c, mesh.cells[t]);
    }
    for (const auto& [a, b, c] : triangulate(holed)) result.add(boundary[a], boundary[b], boundary[c], placement.cell);
    for (const auto& [a, b, c] : triangulate(letters)) result.add(bottoms[a], bottoms[b], bottoms[c], kNoCell);
    std::size_t first = 0;
    for (const Contour& contour : letters) {
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const std::size_t p = first + i;
            const std::size_t q = first + (i + 1) % contour.size();
            result.add(tops[p], tops[q], bottoms[q], kNoCell);
            result.add(tops[p], bottoms[q], bottoms[p], kNoCell);
        }
        first += contour.size();
    }
    if (!isClosedManifold(result)) return false;
    mesh = std::move(result);
    return true;
}

}  // namespace

LabelText::LabelText(const std::string& name, const std::string& w)
    : versions_{textOutlinesOf({name + "  " + w}), textOutlinesOf({name, w})} {}

bool LabelText::engrave(Mesh& mesh, double size, const RoundingGrid& grid, const ExportBudget& budget) const {
    const auto faces = facesOf(mesh);
    if (!isConvex(mesh, faces, grid, budget)) return false;
    std::vector<TextPlacement> placements;
    for (const auto& [cell, face] : faces) {
        for (std::size_t i = 0; i < face.loop.size(); ++i) {
            budget.checkTimeAndStop();
            const glm::dvec3 along = mesh.points[face.loop[(i + 1) % face.loop.size()]] - mesh.points[face.loop[i]];
            const glm::dvec3 right = glm::normalize(along - glm::dot(along, face.normal) * face.normal);
            for (const TextOutlines& text : versions_) {
                TextPlacement placement = largestTextPlacement(mesh, face, right, text);
                placement.cell = cell;
                placement.height = std::min(placement.height, size / 10);
                if (placement.height < kMinHeight) continue;
                placement.depth = engravingDepthAt(placement, faces, mesh);
                if (placement.depth >= kMinDepth) placements.push_back(placement);
            }
        }
    }
    std::ranges::stable_sort(placements, std::greater<>{}, &TextPlacement::height);
    return std::ranges::any_of(placements, [&](const TextPlacement& placement) {
        budget.checkTimeAndStop();
        return engraveText(mesh, faces.at(placement.cell), placement, grid);
    });
}

Mesh LabelText::makeLabelPlate(double size, const RoundingGrid& grid) const {
    const double height = std::clamp(size / 15, 3.0, 12.0);
    const TextOutlines& text = versions_.back();
    const glm::dvec2 extent = (text.size + 2.2 * kMargin) * height;
    constexpr double kThickness = 2;
    std::vector<glm::dvec3> corners;
    for (const double x : {-extent.x / 2, extent.x / 2}) {
        for (const double y : {-extent.y, 0.0}) {
            for (const double z : {0.0, kThickness}) corners.push_back(grid.snap({x, y, z}));
        }
    }
    Mesh mesh = convexHullOfGridPoints(corners, grid);
    // Number the faces of the box: the two faces across an axis get 2 · axis and, on the positive side, 2 · axis + 1.
    // So face 5 is the top.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 normal = doubleAreaNormalOf(mesh, mesh.triangles[t]);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            if (normal[axis] != 0) mesh.cells[t] = 2 * axis + (normal[axis] > 0 ? 1 : 0);
        }
    }
    const auto faces = facesOf(mesh);
    const BodyFace& top = faces.at(5);
    TextPlacement placement = largestTextPlacement(mesh, top, {1, 0, 0}, text);
    placement.cell = 5;
    placement.height = height;
    placement.depth = std::min(kMaxDepth, height / 4);
    if (!engraveText(mesh, top, placement, grid)) throw std::runtime_error("the label cannot be engraved in its plate");
    std::ranges::fill(mesh.cells, kNoCell);
    return mesh;
}

}  // namespace oval4d::exports

#include "polytopes/polytope.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "geometry/index.hpp"
#include "polytopes/cell_types.hpp"
#include "polytopes/convexity.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;

using FaultLocation = InvalidPolytope::FaultLocation;

[[noreturn]] void throwInvalidPolytope(const std::string& what) {
    throw InvalidPolytope(FaultLocation::whole, 0, what);
}

std::string nameOf(FaultLocation part, std::size_t index) {
    if (part == FaultLocation::whole) return {};
    return (part == FaultLocation::face ? "2-face " : "cell ") + std::to_string(index) + ' ';
}

// Throws InvalidPolytope if two consecutive vertices of a 2-face's loop are equal, or its last and its first vertex.
void checkLoops(const geometry::JaggedArray& faces) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto loop = faces[f];
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (loop[i] == loop[(i + 1) % loop.size()])
                throw InvalidPolytope(FaultLocation::face, f, "repeats vertex " + std::to_string(loop[i]));
        }
    }
}

// Returns +1 if the vertex loop of the 2-face traverses its i-th edge from the smaller to the larger vertex index, else
// −1.
int edgeSignInLoop(const Polytope& p, std::uint32_t face, std::size_t i) {
    return p.edges[p.faceEdges[face][i]][0] == p.faces[face][i] ? 1 : -1;
}

// Orients the boundary coherently: assigns a sign to every incidence (pair of a cell and one of its 2-faces,
// identified by its index in cells.items). If the vertex loops with negative signs are reversed, the 2-faces of a
// cell traverse each edge of the cell once in each direction. A 2-face has opposite signs in its two cells.
class BoundaryOrienter {
  public:
    explicit BoundaryOrienter(Polytope& p)
        : p_(p), incidencesOfFace_(p.faces.size(), {kNone, kNone}), done_(p.cells.size()) {
        p_.cellSigns.assign(p_.cells.items.size(), 0);
        cellOfIncidence_.resize(p_.cells.items.size());
        for (std::uint32_t c = 0; c < p_.cells.size(); ++c) {
            for (std::uint32_t incidence = p_.cells.begin[c]; incidence < p_.cells.begin[c + 1]; ++incidence)
                recordIncidence(c, incidence);
        }
        for (std::size_t f = 0; f < incidencesOfFace_.size(); ++f) {
            if (incidencesOfFace_[f][1] == kNone)
                throw InvalidPolytope(FaultLocation::face, f, "does not lie in two cells");
        }
        for (std::uint32_t incidence = 0; incidence < p_.cellSigns.size(); ++incidence) {
            if (p_.cellSigns[incidence] == 0) orientComponent(incidence);
        }
        for (const auto& [one, other] : incidencesOfFace_) {
            const bool ordered = p_.cellSigns[one] < p_.cellSigns[other];
            p_.faceCells.push_back({cellOfIncidence_[ordered ? one : other], cellOfIncidence_[ordered ? other : one]});
        }
    }

  private:
    // An edge of a 2-face of the current cell. `direction` is +1 if the loop of the 2-face goes from the edge's
    // smaller vertex index to the larger, else −1 (see edgeSignInLoop()).
    struct DirectedEdge {
        std::uint32_t edge, incidence;
        int direction;
    };

    void recordIncidence(std::uint32_t cell, std::uint32_t incidence) {
        cellOfIncidence_[incidence] = cell;
        const std::uint32_t face = p_.cells.items[incidence];
        auto& incidences = incidencesOfFace_[face];
        if (incidences[1] != kNone) throw InvalidPolytope(FaultLocation::face, face, "lies in more than two cells");
        incidences[incidences[0] == kNone ? 0 : 1] = incidence;
    }

    // Orients one connected component of the boundary, beginning with the incidence `first`. Of the two
    // orientations, chooses the outward one, in which the sum of scaledConeVolume() over the cells is negative.
    // Then the face loops of each slice are counterclockwise, seen from outside the slice.
    void orientComponent(std::uint32_t first) {
        std::vector<std::uint32_t> cells;
        std::vector<std::uint32_t> waiting{first};
        p_.cellSigns[first] = 1;
        double hypervolume = 0;
        while (!waiting.empty()) {
            const std::uint32_t incidence = waiting.back();
            waiting.pop_back();
            const std::uint32_t cell = cellOfIncidence_[incidence];
            if (!orientCell(cell)) continue;
            cells.push_back(cell);
            hypervolume += scaledConeVolume(cell);
            for (std::uint32_t s = p_.cells.begin[cell]; s < p_.cells.begin[cell + 1]; ++s) {
                const auto& pair = incidencesOfFace_[p_.cells.items[s]];
                const std::uint32_t other = pair[0] == s ? pair[1] : pair[0];
                if (p_.cellSigns[other] == 0) {
                    p_.cellSigns[other] = static_cast<std::int8_t>(-p_.cellSigns[s]);
                    waiting.push_back(other);
                } else if (p_.cellSigns[other] == p_.cellSigns[s]) {
                    throw InvalidPolytope(FaultLocation::face, p_.cells.items[s],
                                          "lies where the boundary cannot be oriented consistently");
                }
            }
        }
        if (hypervolume < 0) return;
        for (const std::uint32_t cell : cells) {
            for (std::uint32_t s = p_.cells.begin[cell]; s < p_.cells.begin[cell + 1]; ++s) {
                p_.cellSigns[s] = static_cast<std::int8_t>(-p_.cellSigns[s]);
            }
        }
    }

    // Sets the signs of all 2-faces of the cell to agree with the sign of one of these 2-faces, which the caller must
    // have set. Returns false, without changing anything, if the cell was oriented before. Throws InvalidPolytope if
    // the cell is not a connected closed orientable surface.
    bool orientCell(std::uint32_t cell) {
        if (done_[cell]) return false;
        done_[cell] = true;
        const std::uint32_t begin = p_.cells.begin[cell];
        const std::uint32_t end = p_.cells.begin[cell + 1];
        const auto signs = std::span(p_.cellSigns).subspan(begin, end - begin);
        std::vector<DirectedEdge> directedEdges;
        for (std::uint32_t incidence = begin; incidence < end; ++incidence) {
            const std::uint32_t face = p_.cells.items[incidence];
            for (std::size_t i = 0; i < p_.faces[face].size(); ++i) {
                directedEdges.push_back({p_.faceEdges[face][i], incidence, edgeSignInLoop(p_, face, i)});
            }
        }
        std::sort(directedEdges.begin(), directedEdges.end(),
                  [](const DirectedEdge& a, const DirectedEdge& b) { return a.edge < b.edge; });
        for (std::size_t i = 0; i < directedEdges.size(); i += 2) {
            if (i + 1 == directedEdges.size() || directedEdges[i].edge != directedEdges[i + 1].edge ||
                (i + 2 < directedEdges.size() && directedEdges[i + 2].edge == directedEdges[i].edge)) {
                throw InvalidPolytope(FaultLocation::cell, cell,
                                      "is not closed: one of its edges does not lie in exactly two of its 2-faces");
            }
        }
        propagateSigns(directedEdges, begin, end);
        if (std::count(signs.begin(), signs.end(), 0) != 0) {
            throw InvalidPolytope(FaultLocation::cell, cell, "consists of several disconnected pieces");
        }
        for (std::size_t i = 0; i < directedEdges.size(); i += 2) {
            if (p_.cellSigns[directedEdges[i].incidence] * directedEdges[i].direction +
                    p_.cellSigns[directedEdges[i + 1].incidence] * directedEdges[i + 1].direction !=
                0) {
                throw InvalidPolytope(FaultLocation::cell, cell, "is not orientable");
            }
        }
        return true;
    }

    // Gives a sign to every 2-face of a cell that is connected, across edges, to a 2-face that already has a sign. The
    // incidences of the cell are `begin` … `end` − 1. Entries 2i and 2i + 1 of `directedEdges` belong to the same edge.
    void propagateSigns(const std::vector<DirectedEdge>& directedEdges, std::uint32_t begin, std::uint32_t end) {
        auto& signs = p_.cellSigns;
        std::vector<std::vector<std::size_t>> directedEdgesOf(end - begin);
        for (std::size_t i = 0; i < directedEdges.size(); ++i)
            directedEdgesOf[directedEdges[i].incidence - begin].push_back(i);
        std::vector<std::uint32_t> waiting;
        for (std::uint32_t incidence = begin; incidence < end; ++incidence) {
            if (signs[incidence] != 0) waiting.push_back(incidence);
        }
        while (!waiting.empty()) {
            const std::uint32_t incidence = waiting.back();
            waiting.pop_back();
            for (const std::size_t i : directedEdgesOf[incidence - begin]) {
                const DirectedEdge& other = directedEdges[i ^ 1U];
                if (signs[other.incidence] != 0) continue;
                signs[other.incidence] =
                    static_cast<std::int8_t>(-signs[incidence] * directedEdges[i].direction * other.direction);
                waiting.push_back(other.incidence);
            }
        }
    }

    // Returns 24 times the signed hypervolume of the cone over the cell. The apex, `tip`, is a vertex of the polytope.
    // If the apex were the origin, rounding errors would dominate for a polytope that is far from the origin. The
    // result is the sum of sign · det(v, a, b, c) over all triangles (a, b, c) of the 2-faces, each divided as a fan.
    // `sign` is the sign of the 2-face in the cell, and v is a fixed vertex of the cell; v, a, b and c are relative to
    // `tip`.
    double scaledConeVolume(std::uint32_t cell) const {
        double sum = 0;
        const glm::dvec4 tip = p_.vertices[p_.faces.items[0]];
        const auto from = [&](std::uint32_t vertex) { return p_.vertices[vertex] - tip; };
        const glm::dvec4 fromTipToCell = from(p_.faces[p_.cells[cell][0]][0]);
        for (std::uint32_t incidence = p_.cells.begin[cell]; incidence < p_.cells.begin[cell + 1]; ++incidence) {
            const auto loop = p_.faces[p_.cells.items[incidence]];
            for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
                sum += p_.cellSigns[incidence] *
                       glm::determinant(glm::dmat4(fromTipToCell, from(loop[0]), from(loop[i]), from(loop[i + 1])));
            }
        }
        return sum;
    }

    Polytope& p_;
    std::vector<std::array<std::uint32_t, 2>> incidencesOfFace_;
    std::vector<std::uint32_t> cellOfIncidence_;
    std::vector<bool> done_;
};

void checkIndices(const geometry::JaggedArray& lists, std::size_t below, FaultLocation owner, const char* member,
                  std::size_t least) {
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (lists[i].size() < least)
            throw InvalidPolytope(owner, i, "has fewer than " + std::to_string(least) + ' ' + member);
        for (const std::uint32_t item : lists[i]) {
            if (item < below) continue;
            throw InvalidPolytope(
                owner, i,
                "lists index " + std::to_string(item) + ", but there are only " + std::to_string(below) + ' ' + member);
        }
    }
}

// Builds Polytope::edgeFaces, which lists the 2-faces around each edge in cyclic order. A cell has two 2-faces at
// each of its edges; their loops, oriented outward from the cell, traverse the edge in opposite directions. The
// order results from crossing a cell from one of these 2-faces to the other, then crossing the next cell, and so
// on. If the 2-faces around an edge form several cycles, the cycles are stored one after another.
void findFacesAtEdges(Polytope& p) {
    auto& [begin, items] = p.edgeFaces;
    begin.assign(p.edges.size() + 1, 0);
    for (const std::uint32_t e : p.faceEdges.items) ++begin[e + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    items.resize(p.faceEdges.items.size());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < p.faces.size(); ++f) {
        for (std::size_t i = 0; i < p.faces[f].size(); ++i) {
            items[next[p.faceEdges[f][i]]++] = 2 * f + (edgeSignInLoop(p, f, i) > 0 ? 1 : 0);
        }
    }
    std::vector<std::uint32_t> sideAfterCell(
        p.cells.size());  // for each cell at the edge e below, the index in `sides` of the 2-face that follows the cell
    for (std::size_t e = 0; e < p.edges.size(); ++e) {
        const auto sides = std::span(items).subspan(begin[e], begin[e + 1] - begin[e]);
        const auto cellBefore = [&](std::uint32_t side) { return p.faceCells[side >> 1U][side & 1U]; };
        const auto cellAfter = [&](std::uint32_t side) { return p.faceCells[side >> 1U][1 - (side & 1U)]; };
        for (std::uint32_t i = 0; i < sides.size(); ++i) sideAfterCell[cellBefore(sides[i])] = i;
        for (std::uint32_t i = 0; i + 1 < sides.size(); ++i) {
            const std::uint32_t follower = sideAfterCell[cellAfter(sides[i])];
            if (follower <= i) continue;  // the cycle is closed, and the next 2-face begins another cycle
            std::swap(sides[i + 1], sides[follower]);
            sideAfterCell[cellBefore(sides[follower])] = follower;
        }
    }
}

}  // namespace

InvalidPolytope::InvalidPolytope(FaultLocation element, std::size_t number, const std::string& fault)
    : std::invalid_argument(nameOf(element, number) + fault), part(element), index(number), detail(fault) {}

double maxDistanceFromMean(const Polytope& polytope) {
    glm::dvec4 middle(0);
    for (const glm::dvec4& v : polytope.vertices) middle += v;
    middle /= static_cast<double>(polytope.vertices.size());
    double extent = 0;
    for (const glm::dvec4& v : polytope.vertices) extent = std::max(extent, glm::distance(v, middle));
    return extent;
}

Polytope makePolytope(std::string name, std::vector<glm::dvec4> vertices, geometry::JaggedArray faces,
                      geometry::JaggedArray cells, std::vector<std::uint32_t> typeOfCell) {
    Polytope p;
    p.serial = geometry::nextSerial();
    p.name = std::move(name);
    p.vertices = std::move(vertices);
    p.faces = std::move(faces);
    p.cells = std::move(cells);
    if (p.cells.size() == 0) throwInvalidPolytope("there are no cells");
    for (const auto& v : p.vertices) {
        const double r = glm::length(v);
        if (!std::isfinite(r)) throwInvalidPolytope("a vertex is not finite");
        p.circumradius = std::max(p.circumradius, r);
    }
    if (!(p.circumradius > 0)) throwInvalidPolytope("all vertices are at the origin");
    checkIndices(p.faces, p.vertices.size(), FaultLocation::face, "vertices", 3);
    checkIndices(p.cells, p.faces.size(), FaultLocation::cell, "2-faces", 4);
    checkLoops(p.faces);
    findEdges(p);
    p.convexFaces = hasConvexFaces(p);
    BoundaryOrienter orient(p);
    findFacesAtEdges(p);
    numberCellTypes(p, typeOfCell.empty() ? cellTypesByShape(p) : std::move(typeOfCell));
    p.convex = isConvex(p);
    return p;
}

Polytope transformedTo(const Polytope& polytope, const geometry::ReferenceFrame& frame, std::uint64_t serial) {
    Polytope image = polytope;
    image.serial = serial;
    image.rebuildableFromName = false;
    image.circumradius = geometry::mapPoints(frame.matrix(), image.vertices);
    image.originInFile = frame.matrix() * polytope.originInFile;
    return image;
}

std::size_t memoryOf(const Polytope& polytope) {
    return sizeof polytope + memoryOfElements(polytope) + memoryOfRows(polytope.edgeFaces);
}

}  // namespace oval4d::polytopes

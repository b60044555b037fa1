#include "slicing/closed_surfaces/kuhn_sections.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace oval4d::slicing {

namespace {

using TetrahedralizedSection = std::vector<SectionTetrahedron>;

std::array<Pentatope, 24> makePentatopes() {
    std::array<Pentatope, 24> pentatopes;
    std::array<unsigned, 4> axes{0, 1, 2, 3};
    for (Pentatope& pentatope : pentatopes) {
        unsigned corner = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            corner |= 1U << axes[i];
            pentatope.corners[i + 1] = static_cast<std::uint8_t>(corner);
            // The pentatope is positively oriented if the permutation of the axes is even, that is, if the number of
            // its inversions is even.
            for (std::size_t j = 0; j < i; ++j) pentatope.positive ^= axes[j] > axes[i];
        }
        std::ranges::next_permutation(axes);
    }
    return pentatopes;
}

// Returns corner i of the reference pentatope. Its corners are 0, e_x, e_x + e_y, …, where e_x and e_y are unit
// vectors.
glm::dvec4 referenceCorner(std::size_t i) {
    glm::dvec4 corner(0);
    for (std::size_t axis = 0; axis < i; ++axis) corner[static_cast<int>(axis)] = 1;
    return corner;
}

// Returns whether the signed volume of `tetrahedron`, a part of the section of the reference pentatope by a hyperplane,
// is positive. The sign of the volume is that of det(b − a, c − a, d − a, u), where a, b, c and d are the corners of
// the tetrahedron, and u points to the upper side of the hyperplane. Bit i of `above` says whether corner i of the
// pentatope is on the upper side. The middles of the cut edges serve as the corners a, b, c and d.
bool hasPositiveVolume(const SectionTetrahedron& tetrahedron, unsigned above) {
    const auto middle = [&](const PentatopeEdge& edge) {
        return 0.5 * (referenceCorner(edge[0]) + referenceCorner(edge[1]));
    };
    const PentatopeEdge& edge = tetrahedron.edges[0];
    const glm::dvec4 first = middle(edge);
    const double up = (above >> edge[1] & 1U) != 0 ? 1 : -1;
    return glm::determinant(glm::dmat4(middle(tetrahedron.edges[1]) - first, middle(tetrahedron.edges[2]) - first,
                                       middle(tetrahedron.edges[3]) - first,
                                       up * (referenceCorner(edge[1]) - referenceCorner(edge[0])))) > 0;
}

// Sets tetrahedron.facets: for each face of the tetrahedron, the facet of the pentatope in which the face lies. The
// three corners of a face lie on edges of the pentatope. If these edges have only four of the five corners of the
// pentatope, the face lies in the facet opposite to the missing corner.
void findFacets(SectionTetrahedron& tetrahedron) {
    for (std::size_t k = 0; k < 4; ++k) {
        unsigned corners = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (i != k) corners |= 1U << tetrahedron.edges[i][0] | 1U << tetrahedron.edges[i][1];
        }
        const unsigned missing = ~corners & 31U;
        tetrahedron.facets[k] =
            missing == 0 ? SectionTetrahedron::kInner : static_cast<std::uint8_t>(std::countr_zero(missing));
    }
}

// Computes the result of pentatopeSection() for these arguments.
TetrahedralizedSection makePentatopeSection(unsigned above, bool positive) {
    // `few` has the corners on the side of the hyperplane that has fewer corners, and `many` has the corners on the
    // other side.
    std::vector<std::uint8_t> few, many;
    for (std::uint8_t i = 0; i < 5; ++i) ((above >> i & 1U) != 0 ? few : many).push_back(i);
    if (few.size() > many.size()) std::swap(few, many);
    const auto edge = [&](std::size_t i, std::size_t j) {
        const auto [low, high] = std::minmax(few[i], many[j]);
        return PentatopeEdge{low, high};
    };
    TetrahedralizedSection section;
    if (few.size() == 1) section.push_back({{edge(0, 0), edge(0, 1), edge(0, 2), edge(0, 3)}, {}});
    if (few.size() == 2) {  // the staircase triangulation of the product of an edge and a triangle
        section.push_back({{edge(0, 0), edge(1, 0), edge(1, 1), edge(1, 2)}, {}});
        section.push_back({{edge(0, 0), edge(0, 1), edge(1, 1), edge(1, 2)}, {}});
        section.push_back({{edge(0, 0), edge(0, 1), edge(0, 2), edge(1, 2)}, {}});
    }
    for (SectionTetrahedron& tetrahedron : section) {
        if (hasPositiveVolume(tetrahedron, above) != positive) std::swap(tetrahedron.edges[2], tetrahedron.edges[3]);
        findFacets(tetrahedron);
    }
    return section;
}

}  // namespace

int Pentatope::axisToNextCorner(std::size_t i) const {
    return std::countr_zero(static_cast<unsigned>(corners[i] ^ corners[i + 1]));
}

glm::ivec4 Pentatope::cornerAcrossFacet(std::size_t i) const {
    const bool isInner = i > 0 && i < 4;
    const unsigned bits = isInner ? corners[i - 1] ^ corners[i] ^ corners[i + 1] : i == 0 ? 15U : 0U;
    glm::ivec4 corner(bits & 1U, bits >> 1U & 1U, bits >> 2U & 1U, bits >> 3U & 1U);
    if (i == 0) ++corner[axisToNextCorner(0)];
    if (i == 4) --corner[axisToNextCorner(3)];
    return corner;
}

const std::array<Pentatope, 24>& kuhnPentatopes() {
    static const std::array<Pentatope, 24> kPentatopes = makePentatopes();
    return kPentatopes;
}

std::span<const SectionTetrahedron> pentatopeSection(unsigned above, bool positive) {
    static const std::array<std::array<TetrahedralizedSection, 32>, 2> kSections = [] {
        std::array<std::array<TetrahedralizedSection, 32>, 2> sections;
        for (unsigned corners = 0; corners < 32; ++corners) {
            sections[0][corners] = makePentatopeSection(corners, false);
            sections[1][corners] = makePentatopeSection(corners, true);
        }
        return sections;
    }();
    return kSections[positive ? 1 : 0][above];
}

}  // namespace oval4d::slicing

#include "polytopes/construction/coxeter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "geometry/point_index.hpp"

namespace oval4d::polytopes {

namespace {

constexpr double kPhi = std::numbers::phi;

// The branches p, q and r of a diagram that is a chain, and mirrors that meet at the angles of these branches. With
// these mirrors, the polytopes of the diagram have the coordinates that are usual in the literature.
struct DiagramWithMirrors {
    std::array<DiagramBranch, 3> branches;
    Mirrors mirrors;
};

Mirrors normalized(Mirrors mirrors) {
    for (auto& m : mirrors) m = glm::normalize(m);
    return mirrors;
}

const std::array<DiagramWithMirrors, 4>& familiesWithMirrors() {
    static const std::array<DiagramWithMirrors, 4> kPlaced = [] {
        // The mirrors of the 5-cell in Kageyama's paper, which README.md names. The normal of mirror i is the
        // difference of vertex i and vertex i + 1, so the reflection in the mirror swaps these two vertices.
        const double y = 1 / std::sqrt(3.0);
        const double z = -1 / std::sqrt(6.0);
        const double w = -1 / std::sqrt(10.0);
        const std::array<glm::dvec4, 5> simplex{
            {{-1, -y, z, w}, {1, -y, z, w}, {0, 2 * y, z, w}, {0, 0, std::sqrt(1.5), w}, {0, 0, 0, -4 * w}}};
        Mirrors a4;
        for (std::size_t i = 0; i < 4; ++i) a4[i] = simplex[i] - simplex[i + 1];
        const DiagramBranch three{3, 1};
        const DiagramBranch four{4, 1};
        const DiagramBranch five{5, 1};
        return std::array<DiagramWithMirrors, 4>{{
            {{three, three, three}, normalized(a4)},
            {{four, three, three}, normalized({{{0, 0, 0, 1}, {0, 0, 1, -1}, {0, 1, -1, 0}, {1, -1, 0, 0}}})},
            {{three, four, three}, normalized({{{1, -1, -1, -1}, {0, 0, 0, 1}, {0, 0, 1, -1}, {0, 1, -1, 0}}})},
            {{five, three, three},
             normalized({{{1, 0, 0, 0}, {-kPhi, 1, -1 / kPhi, 0}, {0, -1, 0, 0}, {0, 1, kPhi, -1 / kPhi}}})},
        }};
    }();
    return kPlaced;
}

// Returns mirrors that meet at the diagram's angles. The angles determine the Gram matrix of the unit normals of the
// mirrors; the rows of the Cholesky factor of this matrix are such normals.
Mirrors mirrorsFromAngles(const CoxeterDiagram& diagram) {
    Mirrors mirrors{};
    for (int i = 0; i < kMirrors; ++i) {
        for (int j = 0; j <= i; ++j) {
            const DiagramBranch b = diagram.branches[i][j];
            double rest = i == j ? 1 : -std::cos(std::numbers::pi * b.denominator / b.numerator);
            for (int k = 0; k < j; ++k) rest -= mirrors[i][k] * mirrors[j][k];
            if (i != j) {
                mirrors[i][j] = rest / mirrors[j][j];
            } else if (rest > 1e-9) {
                mirrors[i][i] = std::sqrt(rest);
            } else {
                throw std::invalid_argument(
                    "the mirrors of this diagram do not generate a finite group in four dimensions");
            }
        }
    }
    return mirrors;
}

// How the reflections permute the members of an orbit, which are numbered from 0. The reflection in mirror k maps
// member m to the member whose number is entry 4 · m + k.
using ReflectionImages = std::vector<std::uint32_t>;

struct Orbit {
    std::vector<glm::dvec4> points;
    ReflectionImages images;
};

Orbit orbitOf(const glm::dvec4& seed, const Mirrors& mirrors, std::size_t most) {
    Orbit orbit;
    geometry::EqualPointFinder index(1e-5 * glm::length(seed));
    index.findOrAdd(seed, orbit.points);
    for (std::size_t i = 0; i < orbit.points.size(); ++i) {
        for (const auto& mirror : mirrors) {
            const glm::dvec4 p = orbit.points[i];
            orbit.images.push_back(index.findOrAdd(p - 2 * glm::dot(p, mirror) * mirror, orbit.points).first);
        }
        if (orbit.points.size() > most)
            throw std::invalid_argument("the polytope has more than " + std::to_string(most) + " vertices");
    }
    return orbit;
}

// The orbits of sets under the reflections in the mirrors. A set is a 2-face, whose members are vertices, or a
// cell, whose members are 2-faces. A set is stored as a list of the numbers of its members. The list of the image
// of a set has the images of the members in the same order.
class OrbitsOfSets {
  public:
    geometry::JaggedArray lists;
    ReflectionImages images;

    /// Adds the orbit of `seed` to `lists`, and returns the index of `seed` in `lists`. Returns an empty optional
    /// if an orbit that was added before contains `seed`. `memberImages` holds the images of all members under the
    /// reflections.
    std::optional<std::uint32_t> addOrbit(const std::vector<std::uint32_t>& seed,
                                          const ReflectionImages& memberImages) {
        const auto first = static_cast<std::uint32_t>(lists.size());
        if (findOrAdd(seed) != first) return std::nullopt;
        std::vector<std::uint32_t> moved;
        for (std::size_t i = images.size() / kMirrors; i < lists.size(); ++i) {
            for (std::size_t mirror = 0; mirror < kMirrors; ++mirror) {
                moved.assign(lists[i].begin(), lists[i].end());
                for (auto& member : moved) member = memberImages[kMirrors * member + mirror];
                images.push_back(findOrAdd(moved));
            }
        }
        return first;
    }

  private:
    std::uint32_t findOrAdd(const std::vector<std::uint32_t>& list) {
        std::vector<std::uint32_t> sorted(list);
        std::sort(sorted.begin(), sorted.end());
        std::uint64_t hash = sorted.size();
        for (const auto member : sorted) hash = (hash ^ member) * 0x100000001b3ULL ^ hash >> 31U;
        auto& bucket = known_[hash];
        std::vector<std::uint32_t> other;
        for (const auto number : bucket) {
            other.assign(lists[number].begin(), lists[number].end());
            std::sort(other.begin(), other.end());
            if (other == sorted) return number;
        }
        bucket.push_back(static_cast<std::uint32_t>(lists.size()));
        lists.add(list);
        return bucket.back();
    }

    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> known_;
};

// Returns the vertex loop of the polygon that mirrors a and b generate from the generating vertex p (vertex 0). Let a·p
// be the reflection of p in mirror a, and ab the rotation that is the product of both reflections. The vertices of the
// polygon are the images of p and of a·p under the powers of ab. If only one of the two mirrors is ringed, p and a·p
// have the same images.
std::vector<std::uint32_t> polygonOfMirrors(const ReflectionImages& images, std::uint32_t a, std::uint32_t b) {
    const auto image = [&](std::uint32_t vertex, std::uint32_t mirror) { return images[kMirrors * vertex + mirror]; };
    if (image(0, a) == 0) std::swap(a, b);
    const std::uint32_t beside = image(0, a);
    const bool bothRinged = image(0, b) != 0;
    std::vector<std::uint32_t> loop;
    std::uint32_t first = 0;
    std::uint32_t second = beside;
    do {
        loop.push_back(first);
        if (bothRinged) loop.push_back(second);
        first = image(image(first, b), a);
        second = image(image(second, b), a);
    } while (first != 0);
    return loop;
}

// Returns the 2-faces of the cell that the mirrors of `set` generate. These 2-faces are the images of `seeds`, which
// are the cell's 2-faces at the generating vertex, under the group of these mirrors.
std::vector<std::uint32_t> cellFaces(MirrorSet set, const std::vector<std::uint32_t>& seeds,
                                     const ReflectionImages& faceImages) {
    std::vector<std::uint32_t> faces(seeds);
    std::unordered_set<std::uint32_t> known(seeds.begin(), seeds.end());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (int mirror = 0; mirror < kMirrors; ++mirror) {
            if (!containsMirror(set, mirror)) continue;
            const auto image = faceImages[kMirrors * faces[i] + mirror];
            if (known.insert(image).second) faces.push_back(image);
        }
    }
    return faces;
}

// Returns the least of the images of `set` under the symmetries of the diagram, compared as numbers. All sets of an
// orbit under these symmetries have the same least image.
MirrorSet leastImage(MirrorSet set, const std::vector<MirrorPermutation>& symmetries) {
    MirrorSet least = set;
    for (const MirrorPermutation& from : symmetries) {
        MirrorSet image = 0;
        for (int i = 0; i < kMirrors; ++i)
            image |= containsMirror(set, from.at(i)) ? 1U << static_cast<unsigned>(i) : 0U;
        least = std::min(least, image);
    }
    return least;
}

}  // namespace

Mirrors mirrorsOf(const CoxeterDiagram& diagram) {
    for (const auto& family : familiesWithMirrors()) {
        const auto& [p, q, r] = family.branches;
        if (CoxeterDiagram::linear(p, q, r, diagram.ringed).branches == diagram.branches) return family.mirrors;
        if (CoxeterDiagram::linear(r, q, p, diagram.ringed).branches == diagram.branches) {
            Mirrors reversed = family.mirrors;
            std::reverse(reversed.begin(), reversed.end());
            return reversed;
        }
    }
    return mirrorsFromAngles(diagram);
}

glm::dvec4 generatingVertex(const Mirrors& mirrors, const std::array<bool, 4>& ringed) {
    const glm::dmat4 rows = glm::transpose(glm::dmat4(mirrors[0], mirrors[1], mirrors[2], mirrors[3]));
    glm::dvec4 distances;
    for (int i = 0; i < kMirrors; ++i) distances[i] = ringed.at(i) ? 1 : 0;
    return glm::inverse(rows) * distances;
}

Polytope wythoffConstruction(std::string name, const CoxeterDiagram& diagram, const Mirrors& mirrors,
                             std::size_t maxVertices) {
    if (!generatesElement(diagram, 0xfU))
        throw std::invalid_argument("every connected part of the diagram needs a ringed node");
    Orbit vertices = orbitOf(generatingVertex(mirrors, diagram.ringed), mirrors, maxVertices);
    OrbitsOfSets faces;
    std::array<std::uint32_t, 16>
        // index: a MirrorSet of two mirrors; value: the 2-face that they generate at the generating vertex
        faceOfPair{};
    for (unsigned a = 0; a < kMirrors; ++a) {
        for (unsigned b = a + 1; b < kMirrors; ++b) {
            const MirrorSet pair = 1U << a | 1U << b;
            if (!generatesElement(diagram, pair)) continue;
            const auto face = faces.addOrbit(polygonOfMirrors(vertices.images, a, b), vertices.images);
            if (!face) throw std::invalid_argument("2-faces of " + name + " coincide");
            faceOfPair.at(pair) = *face;
        }
    }
    OrbitsOfSets cells;
    std::vector<std::uint32_t> cellTypes;
    const auto symmetries = automorphismsOf(diagram);
    for (int left = 0; left < kMirrors; ++left) {
        const MirrorSet three = 0xfU & ~(1U << static_cast<unsigned>(left));
        if (!generatesElement(diagram, three)) continue;
        std::vector<std::uint32_t> seeds;
        for (MirrorSet pair = 3; pair < 16; ++pair) {
            if ((pair & ~three) == 0 && std::popcount(pair) == 2 && generatesElement(diagram, pair))
                seeds.push_back(faceOfPair.at(pair));
        }
        cells.addOrbit(cellFaces(three, seeds, faces.images), faces.images);
        cellTypes.resize(cells.lists.size(), leastImage(three, symmetries));
    }
    return makePolytope(std::move(name), std::move(vertices.points), std::move(faces.lists), std::move(cells.lists),
                        std::move(cellTypes));
}

}  // namespace oval4d::polytopes

#include "polytopes/construction/polyhedra.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "polytopes/construction/coxeter.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/snub.hpp"

namespace oval4d::polytopes {

namespace {

constexpr auto kNamed = std::to_array<NamedPolyhedron>({
    {"tetrahedron", "tetrahedral", "x3o3o", "tepe"},
    {"cube", "cubic", "x4o3o", ""},
    {"octahedron", "octahedral", "o4o3x", "ope"},
    {"dodecahedron", "dodecahedral", "x5o3o", "dope"},
    {"icosahedron", "icosahedral", "o5o3x", "ipe"},
    {"truncated tetrahedron", "truncated tetrahedral", "x3x3o", "tuttip"},
    {"cuboctahedron", "cuboctahedral", "o4x3o", "cope"},
    {"truncated cube", "truncated cubic", "x4x3o", "ticcup"},
    {"truncated octahedron", "truncated octahedral", "o4x3x", "tope"},
    {"rhombicuboctahedron", "rhombicuboctahedral", "x4o3x", "sircope"},
    {"truncated cuboctahedron", "truncated cuboctahedral", "x4x3x", "gircope"},
    {"snub cube", "snub cubic", "s4s3s", "sniccup"},
    {"icosidodecahedron", "icosidodecahedral", "o5x3o", "iddip"},
    {"truncated dodecahedron", "truncated dodecahedral", "x5x3o", "tiddip"},
    {"truncated icosahedron", "truncated icosahedral", "o5x3x", "tipe"},
    {"rhombicosidodecahedron", "rhombicosidodecahedral", "x5o3x", "sriddip"},
    {"truncated icosidodecahedron", "truncated icosidodecahedral", "x5x3x", "griddip"},
    {"snub dodecahedron", "snub dodecahedral", "s5s3s", "sniddip"},
    {"small stellated dodecahedron", "small stellated dodecahedral", "x5/2o5o", ""},
    {"great dodecahedron", "great dodecahedral", "o5/2o5x", ""},
    {"great stellated dodecahedron", "great stellated dodecahedral", "x5/2o3o", ""},
    {"great icosahedron", "great icosahedral", "o5/2o3x", ""},
});

struct NamedPolygon {
    RegularPolygon polygon;
    std::string_view adjective, noun;
};
constexpr auto kPolygons = std::to_array<NamedPolygon>({
    {{3, 1}, "triangular", "triangle"},
    {{4, 1}, "square", "square"},
    {{5, 1}, "pentagonal", "pentagon"},
    {{6, 1}, "hexagonal", "hexagon"},
    {{7, 1}, "heptagonal", "heptagon"},
    {{8, 1}, "octagonal", "octagon"},
    {{9, 1}, "enneagonal", "enneagon"},
    {{10, 1}, "decagonal", "decagon"},
    {{11, 1}, "hendecagonal", "hendecagon"},
    {{12, 1}, "dodecagonal", "dodecagon"},
    {{9, 1}, "nonagonal", "nonagon"},
    {{5, 2}, "pentagrammic", "pentagram"},
});

// Returns the signature of the base of a prism. `prism` is the diagram of the prism; its first three mirrors are the
// mirrors of the base. Each pair of these mirrors that generates an element of the prism generates an orbit of faces of
// the base. The number of faces in the orbit is the order of the base's group divided by the order of the stabilizer of
// a face. The circumradius of the base is the distance of the generating vertex from the base's center.
PolyhedronSignature signatureOf(const CoxeterDiagram& prism) {
    PolyhedronSignature shape;
    const MirrorSet solid = 0x7;
    for (MirrorSet set = 0; set < solid; ++set) {
        if (!generatesElement(prism, set)) continue;
        const auto count =
            static_cast<std::uint32_t>(groupOrder(prism, solid) / groupOrder(prism, stabilizerOf(prism, set) & solid));
        if (set == 0) shape.vertices = count;
        if (std::popcount(set) != 2) continue;
        const int a = std::countr_zero(set);
        const int b = std::bit_width(set) - 1;
        RegularPolygon polygon = prism.branches[a][b];
        if (prism.ringed.at(a) && prism.ringed.at(b)) polygon.numerator *= 2;
        shape.faces[polygon] += count;
    }
    glm::dvec4 vertex = generatingVertex(mirrorsOf(prism), prism.ringed);
    vertex.w = 0;
    shape.circumradius = glm::length(vertex);
    return shape;
}

// Returns the diagram of the prism over a polyhedron that is not a snub.
CoxeterDiagram prismDiagram(const NamedPolyhedron& base) {
    return std::get<CoxeterDiagram>(parseDiagram(std::string(base.linearNotation) + " x"));
}

bool isSnub(const NamedPolyhedron& polyhedron) { return polyhedron.linearNotation.starts_with('s'); }

// Builds a polyhedron that is a snub.
PolyhedronWithFaceOrbits buildSnub(const NamedPolyhedron& polyhedron) {
    return snubOf({polyhedron.linearNotation[1] - '0', 1}, {polyhedron.linearNotation[3] - '0', 1});
}

PolyhedronSignature signatureOf(const PolyhedronWithFaceOrbits& snub) {
    PolyhedronSignature shape;
    shape.vertices = static_cast<std::uint32_t>(snub.vertices.size());
    shape.circumradius = glm::length(snub.vertices[0]);
    for (std::size_t f = 0; f < snub.faces.size(); ++f) ++shape.faces[{static_cast<int>(snub.faces[f].size()), 1}];
    return shape;
}

const std::vector<PolyhedronSignature>& namedPolyhedronSignatures() {
    static const std::vector<PolyhedronSignature> kShapes = [] {
        std::vector<PolyhedronSignature> shapes;
        for (const NamedPolyhedron& named : kNamed)
            shapes.push_back(isSnub(named) ? signatureOf(buildSnub(named)) : signatureOf(prismDiagram(named)));
        return shapes;
    }();
    return kShapes;
}

bool isNearlyEqual(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance * b; }

}  // namespace

std::span<const NamedPolyhedron> namedPolyhedra() { return kNamed; }

bool isConvex(const NamedPolyhedron& polyhedron) {
    return polyhedron.linearNotation.find('/') == std::string_view::npos;
}

std::vector<glm::dvec3> verticesOf(const NamedPolyhedron& polyhedron) {
    if (isSnub(polyhedron)) return buildSnub(polyhedron).vertices;
    const CoxeterDiagram prism = prismDiagram(polyhedron);
    std::vector<glm::dvec3> vertices;
    for (const glm::dvec4& vertex : wythoffConstruction({}, prism, mirrorsOf(prism)).vertices) {
        if (vertex.w > 0) vertices.emplace_back(vertex);
    }
    return vertices;
}

std::string adjectiveOf(RegularPolygon polygon) {
    for (const NamedPolygon& named : kPolygons) {
        if (named.polygon == polygon) return std::string(named.adjective);
    }
    return textOf(polygon) + "-gonal";
}

std::string polygonNoun(RegularPolygon polygon) {
    for (const NamedPolygon& named : kPolygons) {
        if (named.polygon == polygon) return std::string(named.noun);
    }
    return textOf(polygon) + "-gon";
}

std::optional<RegularPolygon> polygonNamed(std::string_view word) {
    for (const NamedPolygon& named : kPolygons) {
        if (word == named.adjective || word == named.noun) return named.polygon;
    }
    for (const std::string_view end : {"-gonal", " gonal", "gonal", "-gon", " gon", "gon"}) {
        if (word.ends_with(end)) {
            word.remove_suffix(end.size());
            break;
        }
    }
    return parseBranch(word);
}

std::optional<std::vector<RegularPolygon>> duoprismPolygonsNamed(std::vector<std::string> words) {
    // Splits "5,7" and "5x7" into two words, but not "hexagonal", which contains an x and names one polygon.
    if (words.size() == 1 && !polygonNamed(words[0])) {
        std::string pair = words[0];
        for (const std::string_view times : {"×", "*"}) {
            if (const std::size_t at = pair.find(times); at != std::string::npos) pair.replace(at, times.size(), ",");
        }
        const std::size_t between = std::min(pair.find(','), pair.find('x'));
        if (between != std::string::npos) words = {pair.substr(0, between), pair.substr(between + 1)};
    }
    std::vector<RegularPolygon> polygons;
    for (const std::string& word : words) {
        std::string own = word;
        if (own.ends_with(',')) own.pop_back();
        if (own == "gonal" || own.empty()) continue;
        const auto polygon = polygonNamed(own);
        if (!polygon) return {};
        polygons.push_back(*polygon);
    }
    if (polygons.size() == 1) polygons.push_back(polygons[0]);
    return polygons;
}

std::string nameOf(const PolyhedronSignature& shape, double tolerance) {
    for (std::size_t i = 0; i < kNamed.size(); ++i) {
        const PolyhedronSignature& known = namedPolyhedronSignatures()[i];
        if (known.faces == shape.faces && known.vertices == shape.vertices &&
            isNearlyEqual(shape.circumradius, known.circumradius, tolerance)) {
            return std::string(kNamed.at(i).name);
        }
    }
    for (const auto& [polygon, count] : shape.faces) {
        const auto n = static_cast<std::uint32_t>(polygon.numerator);
        if (count != 2 || shape.vertices != 2 * n || shape.faces.size() != 2) continue;
        const double angle = std::numbers::pi * polygon.denominator / polygon.numerator;
        const auto beside = [&](RegularPolygon side) {
            const auto found = shape.faces.find(side);
            return found == shape.faces.end() ? 0 : found->second;
        };
        if (beside({4, 1}) == n && isNearlyEqual(shape.circumradius, std::hypot(1, 1 / std::sin(angle)), tolerance))
            return adjectiveOf(polygon) + " prism";
        const double antiprism = std::sqrt((3 - 2 * std::cos(angle)) / (2 - 2 * std::cos(angle)));
        if (beside({3, 1}) == 2 * n && isNearlyEqual(shape.circumradius, antiprism, tolerance))
            return adjectiveOf(polygon) + " antiprism";
    }
    return {};
}

}  // namespace oval4d::polytopes

// Tests of the filled faces of the projection: the areas of the 2-faces of the whole object, which 2-faces are filled,
// and the section by the focus hyperplane.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "polytopes/import/import.hpp"
#include "polytopes/off.hpp"
#include "scene/composer.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"
#include "unit/slicing/surface_meshes.hpp"

namespace {

using namespace oval4d;
using scene::ProjectionKind;
using scene::Scene;
using support::named;

/// Returns the scene of a polytope, without its slices, that shows the projection of the whole object with its cells.
/// `steps` limits the filling of faces.
Scene sceneWithProjectedCells(const polytopes::Polytope& p, const geometry::Rotation& turn, scene::Look look,
                              ProjectionKind kind = ProjectionKind::orthogonal,
                              std::size_t steps = slicing::FaceFiller::kNoLimit) {
    look.projection.kind = kind;
    look.parts.projectionFaces = true;
    slicing::SliceSet slices;
    slicing::CellComplexSlicer().slice(p, turn, {0, 1, 1}, slices);
    scene::Composer composer;
    composer.limitFaceFilling(steps);
    Scene s;
    composer.compose(support::objectOf(p), turn, slices, 0, look, {}, s);
    s.slices = &slicing::kNoSlices;
    return s;
}

/// Returns the scene of a surface, without its slices, that shows the projection of the whole surface with its 2-faces.
Scene sceneWithProjectedSurface(const slicing::SurfacePtr& surface, const geometry::Rotation& turn, scene::Look look) {
    look.projection.kind = ProjectionKind::perspective;
    look.parts.projectionFaces = true;
    slicing::SliceSet slices;
    slicing::Slicer().sliceWithoutSurfaces(surface, turn, {-1, 3, 0.3}, slices);
    Scene s;
    scene::Composer().compose(surface, turn, slices, 0, look, {}, s);
    s.slices = &slicing::kNoSlices;
    return s;
}

/// Returns the total area of the pieces (convex polygons) of a filled face.
double filledAreaOf(const slicing::FilledFaces& fill, std::size_t face) {
    double sum = 0;
    for (auto k = fill.pieceBegin[face]; k < fill.pieceBegin[face + 1]; ++k) {
        const glm::dvec3& first = fill.corners[fill.cornerBegin[k]];
        glm::dvec3 twice(0);
        for (auto c = fill.cornerBegin[k] + 2; c < fill.cornerBegin[k + 1]; ++c)
            twice += glm::cross(fill.corners[c - 1] - first, fill.corners[c] - first);
        sum += glm::length(twice) / 2;
    }
    return sum;
}

/// Returns the area that a projected loop encloses. A region counts as often as the loop winds around it.
double enclosedAreaOf(const slicing::SliceSet& elements, std::uint32_t loop) {
    const auto corner = [&](std::uint32_t c) { return elements.vertices[elements.corners[c]]; };
    const glm::dvec3 first = corner(elements.cornerBegin[loop]);
    glm::dvec3 twice(0);
    for (auto c = elements.cornerBegin[loop] + 2; c < elements.cornerBegin[loop + 1]; ++c)
        twice += glm::cross(corner(c - 1) - first, corner(c) - first);
    return glm::length(twice) / 2;
}

constexpr double kAreaOfL = 3;

/// Returns the product of an L-shaped polygon in the xy plane and a square in the zw plane, as if the product was read
/// from a file.
polytopes::Polytope productOfLAndSquare() {
    const support::Polygon l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const support::Polygon square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const polytopes::Polytope made = support::product(l, square);
    auto read = polytopes::importPolytope(polytopes::PolytopeFileFormat::off4,
                                          polytopes::write4Off(made, made.vertices), "L", polytopes::ImportLimits());
    return std::get<polytopes::ImportedPolytope>(std::move(read)).polytope;
}

/// Expects that the four L-shaped 2-faces of productOfLAndSquare() are filled. The area of each is what `areaOf`
/// returns for the w of its first vertex before the rotation.
template <typename AreaOf>
void expectAreasOfL(const polytopes::Polytope& p, const Scene& s, AreaOf areaOf) {
    const slicing::FilledFaces& fill = s.projection.fill;
    int found = 0;
    for (std::size_t f = 0; f < fill.faceBegin[1]; ++f) {
        const auto loop = p.faces[fill.faces[f].source - p.cells.size()];
        if (loop.size() != 6) continue;
        ++found;
        EXPECT_EQ(fill.faces[f].winding, 1);
        EXPECT_NEAR(filledAreaOf(fill, f), areaOf(p.vertices[loop[0]].w), 1e-8);
    }
    EXPECT_EQ(found, 4);
}

TEST(ProjectionFill, OfANonconvexFaceFromAFileHasExactlyItsArea) {
    const polytopes::Polytope p = productOfLAndSquare();
    ASSERT_FALSE(p.convexFaces);
    expectAreasOfL(p, sceneWithProjectedCells(p, {}, {}), [](double) { return kAreaOfL; });
    // A rotation that does not change w turns the projection as a whole.
    geometry::RotationAngles turn;
    turn[geometry::Plane::xy] = 0.7;
    turn[geometry::Plane::xz] = -1.1;
    turn[geometry::Plane::yz] = 0.4;
    expectAreasOfL(p, sceneWithProjectedCells(p, geometry::Rotation(turn), {}), [](double) { return kAreaOfL; });
    // In the projection, a rotation in the plane xw shortens x.
    constexpr double kAngle = 0.6;
    const geometry::Rotation inXw(geometry::RotationAngles{geometry::Plane::xw, kAngle});
    expectAreasOfL(p, sceneWithProjectedCells(p, inXw, {}), [](double) { return kAreaOfL * std::cos(kAngle); });
    // A perspective projection magnifies what lies in a hyperplane w = c.
    const Scene s = sceneWithProjectedCells(p, {}, {}, ProjectionKind::perspective);
    const double eye = s.look.projection.eye * p.circumradius;
    expectAreasOfL(p, s, [&](double w) { return kAreaOfL * std::pow(eye / (eye - w), 2); });
}

// A filled pentagram contains its core once, in any orientation. The loop of a pentagram with the circumradius 1
// encloses the area 5/2 sin 144°, in which the core counts twice. The points inside form ten triangles between the
// center, a tip and an inner corner at the distance φ⁻²; their area is 5 φ⁻² sin 36°. A projection is an affine map,
// which does not change the quotient of the two areas, 2 φ⁻².
TEST(ProjectionFill, OfAPentagramContainsItsCoreOnceInAnyOrientation) {
    using std::numbers::phi;
    const double quotient = 2 / (phi * phi);
    std::mt19937 random(11);
    for (const char* name :
         {"small stellated 120-cell", "great stellated 120-cell", "great grand stellated 120-cell"}) {
        SCOPED_TRACE(name);
        const polytopes::Polytope& p = named(name);
        const Scene s = sceneWithProjectedCells(p, support::randomRotation(random), {});
        const slicing::FilledFaces& fill = s.projection.fill;
        ASSERT_EQ(fill.faceBegin[1], p.faces.size());
        for (std::size_t f = 0; f < p.faces.size(); ++f) {
            EXPECT_EQ(fill.faces[f].winding, 2);
            const double enclosed = enclosedAreaOf(s.projection.elements, fill.faces[f].firstLoop);
            ASSERT_NEAR(filledAreaOf(fill, f), quotient * enclosed, 1e-8 * p.circumradius * p.circumradius);
        }
    }
}

TEST(ProjectionFill, LeavesOutWhatTheEyeCannotSee) {
    const polytopes::Polytope& p = named("small stellated 120-cell");
    std::mt19937 random(12);
    const geometry::Rotation turn = support::randomRotation(random);
    scene::Look look;
    look.parts.back = false;
    look.coloring = scene::Coloring::light;
    const Scene s = sceneWithProjectedCells(p, turn, look, ProjectionKind::perspective);
    const scene::ObjectProjection& projection = s.projection;
    ASSERT_GT(projection.elements.faceCount(0), 0U);
    EXPECT_LT(projection.elements.faceCount(0), p.faces.size());
    ASSERT_EQ(projection.fill.faceBegin[1], projection.elements.faceCount(0));
    ASSERT_EQ(projection.fillCells.size(), projection.fill.faces.size());
    EXPECT_TRUE(projection.drawsPieces(0));
    EXPECT_TRUE(projection.drawsPieces(1)) << "the section of the focus hyperplane";
    for (std::size_t f = 0; f < projection.fill.faceBegin[1]; ++f) {
        const slicing::FilledFaces::FilledFace& face = projection.fill.faces[f];
        EXPECT_EQ(face.source, projection.elements.faceSource[f]);
        const auto& cells = p.faceCells[face.source - p.cells.size()];
        EXPECT_TRUE(projection.fillCells[f] == cells[0] || projection.fillCells[f] == cells[1]);
    }
}

TEST(ProjectionFill, IsEmptyIfAllFacesAreConvexOrHidden) {
    scene::Look look;
    look.parts.faces = false;  // if faces were shown, the section of a star would be filled
    for (const char* name : {"24-cell", "icosahedral 120-cell"}) {
        const Scene s = sceneWithProjectedCells(named(name), {}, look);
        EXPECT_EQ(s.projection.elements.faceCount(0), named(name).faces.size()) << name;
        EXPECT_TRUE(s.projection.fill.empty()) << name;
        EXPECT_FALSE(s.projection.drawsPieces(0)) << name;
    }
    // The same object without and with its cells in the projection must not leave filled faces in the scene.
    const polytopes::Polytope& p = named("small stellated 120-cell");
    slicing::SliceSet slices;
    slicing::CellComplexSlicer().slice(p, {}, {0, 1, 1}, slices);
    scene::Composer composer;
    Scene s;
    look.projection.kind = ProjectionKind::perspective;
    for (const bool cells : {true, false}) {
        look.parts.projectionFaces = cells;
        composer.compose(support::objectOf(p), {}, slices, 0, look, {}, s);
        EXPECT_EQ(s.projection.fill.empty(), !cells);
        EXPECT_EQ(s.projection.fillCells.empty(), !cells);
    }
}

TEST(ProjectionFill, IsRoughBeyondTheLimitWhichItSharesWithTheSlices) {
    const polytopes::Polytope& p = named("small stellated 120-cell");
    std::mt19937 random(13);
    const geometry::Rotation turn = support::randomRotation(random);
    const auto roughFaces = [](const Scene& s) {
        const slicing::FilledFaces& fill = s.projection.fill;
        return std::ranges::count(std::span(fill.faces).first(fill.faceBegin[1]), 0,
                                  &slicing::FilledFaces::FilledFace::winding);
    };
    const Scene rough = sceneWithProjectedCells(p, turn, {}, ProjectionKind::orthogonal, 0);
    EXPECT_EQ(roughFaces(rough), static_cast<std::ptrdiff_t>(p.faces.size()));
    EXPECT_EQ(rough.projection.fill.pieceBegin[p.faces.size()], 5 * p.faces.size()) << "a triangle for each side";
    // The number of steps that the projection takes is enough for the projection if the slices have no faces to fill.
    // If they have faces to fill, it is not enough.
    slicing::FilledFaces fill;
    const std::size_t limit = 100'000'000;
    const std::size_t steps =
        limit - slicing::FaceFiller().fill(rough.projection.elements, p.circumradius, fill, limit, 1);
    EXPECT_GT(steps, 0U);
    scene::Look withoutFaces;
    withoutFaces.parts.faces = false;
    EXPECT_EQ(roughFaces(sceneWithProjectedCells(p, turn, withoutFaces, ProjectionKind::orthogonal, steps)), 0);
    EXPECT_GT(roughFaces(sceneWithProjectedCells(p, turn, {}, ProjectionKind::orthogonal, steps)), 0);
}

TEST(ProjectedSurface, HasItsFlatFacesInOneColor) {
    std::mt19937 random(15);
    const slicing::SurfacePtr torus = support::cliffordTorus(8, 6);
    const Scene s = sceneWithProjectedSurface(torus, support::randomRotation(random), {});
    EXPECT_EQ(s.projection.elements.faceCount(0), 48U);
    EXPECT_TRUE(s.projection.fill.empty());
    EXPECT_DOUBLE_EQ(s.projection.parts[0].faceOpacity, 0.5);
    EXPECT_EQ(s.cellColors, std::vector{scene::plainColor()});
    EXPECT_EQ(s.projection.faceCells, std::vector<std::uint32_t>(48, 0));
}

TEST(ProjectedSurface, IsColoredByTheWOfItsFaces) {
    const slicing::SurfacePtr torus = support::cliffordTorus(8, 6);
    scene::Look look;
    look.coloring = scene::Coloring::w;
    scene::Composer composer;
    slicing::SliceSet slices;
    Scene s;
    look.projection.kind = ProjectionKind::orthogonal;
    std::mt19937 random(16);
    for (const bool faces : {true, false, true}) {
        const geometry::Rotation turn = support::randomRotation(random);
        slicing::Slicer().sliceWithoutSurfaces(torus, turn, {0, 1, 1}, slices);
        look.parts.projectionFaces = faces;
        composer.compose(torus, turn, slices, 0, look, {}, s);
        ASSERT_EQ(s.cellColors.size(), faces ? 48U : 0U);
        ASSERT_EQ(s.projection.faceCells.size(), s.cellColors.size());
        for (std::uint32_t f = 0; f < s.cellColors.size(); ++f) {
            EXPECT_EQ(s.projection.faceCells[f], f);
            glm::dvec4 center(0);
            for (const std::uint32_t v : torus->faces[f]) center += 0.25 * torus->vertices[v];
            // The centers of all 2-faces are equally far from the origin.
            const scene::Color expected = scene::divergingColor(turn(center).w / glm::length(center));
            for (const int shift : {0, 8, 16}) {
                const auto channel = [shift](scene::Color color) { return static_cast<int>(color >> shift & 255U); };
                EXPECT_NEAR(channel(s.cellColors[f]), channel(expected), 4) << "a step of the scale";
            }
        }
    }
}

TEST(ProjectedSurface, IsFilledUpToTheSidesOfFacesThatAreNotFlat) {
    std::mt19937 random(17);
    const slicing::SurfacePtr bottle = support::kleinBottle(12, 8);
    ASSERT_FALSE(bottle->convexFaces);
    const Scene s = sceneWithProjectedSurface(bottle, support::randomRotation(random), {});
    const slicing::FilledFaces& fill = s.projection.fill;
    const slicing::SliceSet& elements = s.projection.elements;
    ASSERT_EQ(fill.faces.size(), 96U);
    ASSERT_EQ(s.projection.fillCells, std::vector<std::uint32_t>(96, 0));
    std::size_t skew = 0;
    for (std::uint32_t f = 0; f < 96; ++f) {
        ASSERT_EQ(fill.faces[f].source, f);
        const std::uint32_t begin = fill.pieceBegin[f], end = fill.pieceBegin[f + 1];
        if (end - begin != 4) continue;
        ++skew;
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t corner = elements.corners[elements.cornerBegin[f] + i];
            EXPECT_EQ(fill.corners[fill.cornerBegin[begin + i] + 1], elements.vertices[corner]);
        }
    }
    EXPECT_GT(skew, 48U);
}

TEST(ProjectionFill, OfTheFocusSectionHasThePiecesOfItsSlice) {
    std::mt19937 random(14);
    for (const char* name : {"grand 600-cell", "icosahedral 120-cell", "great stellated 120-cell"}) {
        SCOPED_TRACE(name);
        const polytopes::Polytope& p = named(name);
        const geometry::Rotation turn = support::randomRotation(random);
        const double w = 0.3 * p.circumradius;
        slicing::SliceSet slices;
        slicing::CellComplexSlicer().slice(p, turn, {-1, 3, w}, slices);
        scene::Composer composer;
        Scene s;
        scene::Look look;
        look.projection.kind = ProjectionKind::perspective;
        const double eye = look.projection.eye * p.circumradius, magnification = eye / (eye - w);
        for (const bool all : {false, true}) {
            look.parts.allSections = all;
            composer.compose(support::objectOf(p), turn, slices, 1, look, {}, s);
            const slicing::FilledFaces &from = s.fill, &to = s.projection.fill;
            const slicing::SliceSet& elements = s.projection.elements;
            const std::size_t focus = all ? 3 : 1;
            ASSERT_EQ(s.projection.parts.size(), all ? 4U : 2U);
            ASSERT_EQ(s.projection.fillCells.size(), to.faces.size());
            for (std::size_t part = 0; part < s.projection.parts.size(); ++part) {
                EXPECT_EQ(s.projection.drawsPieces(part), part == focus);
                EXPECT_EQ(s.projection.parts[part].faceOpacity > 0, part == 0 || part == focus);
            }
            const std::uint32_t begin = to.faceBegin[focus], count = to.faceBegin[focus + 1] - begin;
            ASSERT_GT(count, 0U);
            ASSERT_EQ(count, from.faceBegin[3] - from.faceBegin[2]);
            for (std::uint32_t i = 0; i < count; ++i) {
                const slicing::FilledFaces::FilledFace &face = to.faces[begin + i],
                                                       &own = from.faces[from.faceBegin[2] + i];
                ASSERT_EQ(face.source, own.source);
                ASSERT_EQ(face.endLoop - face.firstLoop, own.endLoop - own.firstLoop);
                for (std::uint32_t loop = face.firstLoop; loop < face.endLoop; ++loop)
                    ASSERT_EQ(elements.faceSource[loop], face.source);
                ASSERT_EQ(s.projection.fillCells[begin + i], s.projection.faceCells[face.firstLoop]);
                ASSERT_NEAR(filledAreaOf(to, begin + i),
                            magnification * magnification * filledAreaOf(from, from.faceBegin[2] + i),
                            1e-9 * p.circumradius * p.circumradius);
                const std::uint32_t first = elements.corners[elements.cornerBegin[face.firstLoop]];
                const std::array points{to.corners[to.cornerBegin[to.pieceBegin[begin + i]]],
                                        elements.vertices[elements.vertexBegin[focus] + first]};
                for (const glm::dvec3& point : points)
                    ASSERT_NEAR(glm::dot(face.normal, point), face.offset, 1e-8 * p.circumradius);
            }
        }
        look.parts.faces = false;
        composer.compose(support::objectOf(p), turn, slices, 1, look, {}, s);
        EXPECT_TRUE(s.projection.fill.empty());
        EXPECT_EQ(s.projection.parts[3].faceOpacity, 0);
    }
}

}  // namespace

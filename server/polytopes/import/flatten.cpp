#include "polytopes/import/flatten.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "geometry/index.hpp"
#include "polytopes/import/simplex_division.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;

// A polytope counts as flat if no vertex is farther than kMaxDeviation from a hyperplane in which it must lie. The
// search for better places of the vertices ends when no vertex is farther than kGoalDeviation. Both distances are in
// units of the parameter `size` of flattenOrSplit(), but at least kMaxRounding or kGoalRounding times
// doublePrecisionErrorBound(), respectively.
constexpr double kMaxDeviation = 1e-12, kGoalDeviation = 1e-13;
constexpr double kMaxRounding = 2, kGoalRounding = 0.5;
// Two hyperplanes count as nearly parallel if the absolute value of the cosine of the angle between them is larger than
// this. Rounding errors then make the plane in which they meet too uncertain.
constexpr double kNearlyParallel = 0.995;
constexpr double kLeastExtent = 1e-9;  // an extent of a constraint's vertices below this number of radii
                                       // (CohyperplanarityConstraint::radius) counts as 0

constexpr int kMaxNewtonRounds = 16;            // the maximum number of rounds of Newton's method
constexpr std::size_t kMaxGradientSteps = 300;  // the maximum number of steps of conjugate gradients in a round
constexpr std::size_t kMaxWork = 150'000'000;   // the maximum number of equations and unknowns, added up over all steps
// A round of Newton's method ends when the gradient of the error is less than a tolerance times the gradient at the
// start of the round. The first round has the tolerance kFirstTolerance, which makes the result more precise by a few
// digits. If a round does not divide the deviation by at least kGoodProgress, some unknowns have little effect on the
// equations. Then the tolerance of the next round is multiplied by kTighter, but is at least kLeastTolerance.
constexpr double kFirstTolerance = 1e-2, kLeastTolerance = 1e-9, kTighter = 1e-3, kGoodProgress = 10;

// A set of vertices that must be moved into one hyperplane, and the hyperplane through their mean that fits them best.
// The set has one of two kinds:
// - The vertices of a cell with more than four vertices.
// - The vertices of a 2-face with more than three vertices, if the hyperplanes of its two cells are nearly parallel.
//   Such hyperplanes do not determine the plane of the 2-face. Therefore the 2-face is also moved into a third
//   hyperplane, which is perpendicular to the hyperplane of `cell`, one of the two cells.
struct CohyperplanarityConstraint {
    std::uint32_t cell, face;  // `face` is kNone if the set is a cell
    glm::dvec4 across{0};      // only for a 2-face: the normal of the hyperplane of `cell`; `normal` is perpendicular
                               // to it
    glm::dvec4 middle{0}, normal{0};
    double radius = 0;     // the largest distance of a vertex from `middle`
    double deviation = 0;  // the largest distance of a vertex from the hyperplane
};

// The changes of all unknowns in one round of Newton's method. `moves` holds the move of each vertex. For each
// constraint, `tilts` holds the change of its normal, multiplied by CohyperplanarityConstraint::radius, and `shifts`
// holds the negative of the change of its middle along the normal.
struct FlatteningUnknowns {
    std::vector<glm::dvec4> moves, tilts;
    std::vector<double> shifts;

    FlatteningUnknowns(std::size_t vertices, std::size_t constraints)
        : moves(vertices, glm::dvec4(0)), tilts(constraints, glm::dvec4(0)), shifts(constraints, 0) {}
    double squaredLength() const {
        double sum = 0;
        for (const glm::dvec4& move : moves) sum += glm::dot(move, move);
        for (const glm::dvec4& tilt : tilts) sum += glm::dot(tilt, tilt);
        for (const double shift : shifts) sum += shift * shift;
        return sum;
    }
    /// Sets this to `factor` · this + `times` · `other`.
    void scaleAndAdd(double factor, double times, const FlatteningUnknowns& other) {
        for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = factor * moves[i] + times * other.moves[i];
        for (std::size_t i = 0; i < tilts.size(); ++i) {
            tilts[i] = factor * tilts[i] + times * other.tilts[i];
            shifts[i] = factor * shifts[i] + times * other.shifts[i];
        }
    }
};

glm::dvec4 withoutComponents(glm::dvec4 v, std::span<const glm::dvec4> units) {
    for (int twice = 0; twice < 2; ++twice) {  // the second pass removes rounding errors of the first pass
        for (const glm::dvec4& unit : units) v -= glm::dot(v, unit) * unit;
    }
    return v;
}

// Returns a unit vector perpendicular to all of `units`, which are at most three orthonormal vectors.
glm::dvec4 unitPerpendicularTo(std::span<const glm::dvec4> units) {
    glm::dvec4 best(0);
    double most = 0;
    for (int axis = 0; axis < 4; ++axis) {
        glm::dvec4 unit(0);
        unit[axis] = 1;
        const glm::dvec4 rest = withoutComponents(unit, units);
        if (const double length = glm::length(rest); length > most) {
            most = length;
            best = rest / length;
        }
    }
    return best;
}

// Moves vertices to nearby places at which the vertices of each CohyperplanarityConstraint lie in its hyperplane, by
// Newton's method. Each vertex v of a constraint with the unit normal n and the middle m gives the equation
// n · (v − m) = 0 for the unknowns v, n and m. The conjugate gradient method finds the least change that solves the
// linearized equations, without storing their matrix (CGLS: Björck, Numerical Methods for Least Squares Problems, 7.4).
// The equations need not be independent.
class Flattener {
  public:
    Flattener(PolygonSoup& soup, double size) : soup_(soup) {
        const double rounding = doublePrecisionErrorBound(soup.vertices);
        maxDeviation_ = std::max(kMaxDeviation * size, kMaxRounding * rounding);
        goalDeviation_ = std::max(kGoalDeviation * size, kGoalRounding * rounding);
        addCellConstraints();
        fitHyperplanes();
        addFaceConstraints();
        fitHyperplanes();
    }

    double deviation() const { return farthest_ == kNone ? 0 : constraints_[farthest_].deviation; }
    /// Returns the cell of the constraint with the largest deviation; 0 if there are no constraints.
    std::uint32_t farthestCell() const { return farthest_ == kNone ? 0 : constraints_[farthest_].cell; }
    bool isFlat() const { return deviation() <= maxDeviation_; }

    /// Sets an entry of `faces` or `cells` to true if the 2-face or cell deviates from its hyperplane by more than
    /// maxDeviation_. Leaves the other entries unchanged.
    void markNonFlat(std::vector<bool>& faces, std::vector<bool>& cells) const {
        for (const CohyperplanarityConstraint& constraint : constraints_) {
            if (constraint.deviation <= maxDeviation_) continue;
            if (constraint.face == kNone) {
                cells[constraint.cell] = true;
            } else {
                faces[constraint.face] = true;
            }
        }
    }

    /// Moves the vertices until the vertices of each CohyperplanarityConstraint lie in its hyperplane, to within
    /// maxDeviation_. Returns false if this fails, or if a vertex moves by more than `maxDistance`; the caller must
    /// then restore the vertices.
    bool flatten(double maxDistance) {
        const std::vector<glm::dvec4> before = soup_.vertices;
        double tolerance = kFirstTolerance, best = std::numeric_limits<double>::infinity();
        std::size_t work = 0;
        for (int round = 0; round < kMaxNewtonRounds && work < kMaxWork; ++round) {
            if (deviation() <= goalDeviation_) return true;
            if (deviation() * kGoodProgress > best) tolerance = std::max(tolerance * kTighter, kLeastTolerance);
            best = std::min(best, deviation());
            const FlatteningUnknowns change = solveForChange(tolerance, work);
            for (std::size_t v = 0; v < before.size(); ++v) {
                soup_.vertices[v] += change.moves[v];
                if (!(glm::distance(soup_.vertices[v], before[v]) <= maxDistance)) return false;
            }
            fitHyperplanes();
        }
        return isFlat();
    }

  private:
    void add(const CohyperplanarityConstraint& constraint, std::vector<std::uint32_t>& corners) {
        constraints_.push_back(constraint);
        corners_.add(corners);
    }

    void addCellConstraints() {
        constraintOfCell_.assign(soup_.cells.size(), kNone);
        std::vector<std::uint32_t> corners;
        for (std::uint32_t c = 0; c < soup_.cells.size(); ++c) {
            corners.clear();
            for (const std::uint32_t f : soup_.cells[c])
                corners.insert(corners.end(), soup_.faces[f].begin(), soup_.faces[f].end());
            std::sort(corners.begin(), corners.end());
            corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
            if (corners.size() <= 4) continue;
            constraintOfCell_[c] = static_cast<std::uint32_t>(constraints_.size());
            add({c, kNone}, corners);
        }
    }

    // Adds a constraint for each 2-face between two cells whose hyperplanes are nearly parallel.
    void addFaceConstraints() {
        std::vector<std::array<std::uint32_t, 2>> cellsOf(soup_.faces.size(), {kNone, kNone});
        for (std::uint32_t c = 0; c < soup_.cells.size(); ++c) {
            for (const std::uint32_t f : soup_.cells[c]) cellsOf[f].at(cellsOf[f][0] == kNone ? 0 : 1) = c;
        }
        std::vector<std::uint32_t> corners;
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) {
            const auto [one, other] = cellsOf[f];
            if (soup_.faces[f].size() <= 3 || one == kNone || other == kNone) continue;
            if (constraintOfCell_[one] == kNone || constraintOfCell_[other] == kNone) continue;
            const glm::dvec4 normal = constraints_[constraintOfCell_[one]].normal;
            if (std::abs(glm::dot(normal, constraints_[constraintOfCell_[other]].normal)) <= kNearlyParallel) continue;
            corners.assign(soup_.faces[f].begin(), soup_.faces[f].end());
            add({one, f, normal}, corners);
        }
    }

    void fitHyperplanes() {
        offsets_.resize(corners_.items.size());
        distances_.resize(corners_.items.size());
        farthest_ = kNone;
        for (std::uint32_t i = 0; i < constraints_.size(); ++i) {
            fitHyperplane(i);
            // A deviation that is NaN counts as the largest.
            if (farthest_ == kNone || !(constraints_[i].deviation <= deviation())) farthest_ = i;
        }
    }

    // Fits the hyperplane of a CohyperplanarityConstraint to its vertices: first to a few vertices that are far apart,
    // then to all vertices by least squares. The second fit changes the hyperplane only a little, so it adds only small
    // rounding errors.
    void fitHyperplane(std::uint32_t i) {
        CohyperplanarityConstraint& constraint = constraints_[i];
        const auto corners = corners_[i];
        const auto offsets = std::span(offsets_).subspan(corners_.begin[i], corners.size());
        const auto distances = std::span(distances_).subspan(corners_.begin[i], corners.size());
        constraint.middle = glm::dvec4(0);
        for (const std::uint32_t v : corners) constraint.middle += soup_.vertices[v];
        constraint.middle /= static_cast<double>(corners.size());
        constraint.radius = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            offsets[k] = soup_.vertices[corners[k]] - constraint.middle;
            constraint.radius = std::max(constraint.radius, glm::length(offsets[k]));
        }

        const std::size_t own = constraint.face == kNone ? 3 : 2;
        std::array<glm::dvec4, 3> axes{};
        glm::dvec3 extents(0);
        rest_.assign(offsets.begin(), offsets.end());
        for (std::size_t a = 0; a < 3; ++a) {
            const auto before = std::span(axes).first(a);
            const glm::dvec4 far =
                a < own ? *std::max_element(
                              rest_.begin(), rest_.end(),
                              [](const glm::dvec4& p, const glm::dvec4& q) { return glm::dot(p, p) < glm::dot(q, q); })
                        : constraint.across;
            const glm::dvec4 axis = withoutComponents(far, before);
            const double length = glm::length(axis);
            const bool spans = length > kLeastExtent * (a < own ? constraint.radius : 1);
            axes.at(a) = spans ? axis / length : unitPerpendicularTo(before);
            if (spans && a < own) extents[static_cast<int>(a)] = length;
            for (glm::dvec4& rest : rest_) rest -= glm::dot(rest, axes.at(a)) * axes.at(a);
        }
        constraint.normal = unitPerpendicularTo(axes);

        glm::dmat3 gram(0);
        glm::dvec3 right(0);
        for (const glm::dvec4& offset : offsets) {
            glm::dvec3 along(0);  // the coordinates along `axes`, in units of `extents`
            for (int a = 0; a < 3; ++a) {
                if (extents[a] > 0) along[a] = glm::dot(offset, axes.at(static_cast<std::size_t>(a))) / extents[a];
            }
            gram += glm::outerProduct(along, along);
            right += glm::dot(offset, constraint.normal) * along;
        }
        for (int a = 0; a < 3; ++a) gram[a][a] += extents[a] > 0 ? 0 : 1;
        const glm::dvec3 slope = glm::inverse(gram) * right;
        for (int a = 0; a < 3; ++a) {
            if (extents[a] > 0) constraint.normal -= slope[a] / extents[a] * axes.at(static_cast<std::size_t>(a));
        }
        constraint.normal = glm::normalize(constraint.normal);

        constraint.deviation = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            distances[k] = glm::dot(offsets[k], constraint.normal);
            if (!(std::abs(distances[k]) <= constraint.deviation)) constraint.deviation = std::abs(distances[k]);
            if (constraint.radius > 0) offsets[k] /= constraint.radius;
        }
    }

    // Sets `out` to the product of the Jacobian and `change`. To the first order, element k is the change of
    // distances_[k].
    void multiplyByJacobian(const FlatteningUnknowns& change, std::vector<double>& out) const {
        for (std::size_t i = 0; i < constraints_.size(); ++i) {
            for (std::uint32_t k = corners_.begin[i]; k < corners_.begin[i + 1]; ++k) {
                out[k] = glm::dot(constraints_[i].normal, change.moves[corners_.items[k]]) +
                         glm::dot(offsets_[k], change.tilts[i]) + change.shifts[i];
            }
        }
    }

    // Sets `out` to the product of the transposed Jacobian and the vector `list`.
    void multiplyByTransposedJacobian(const std::vector<double>& list, FlatteningUnknowns& out) const {
        std::fill(out.moves.begin(), out.moves.end(), glm::dvec4(0));
        for (std::size_t i = 0; i < constraints_.size(); ++i) {
            glm::dvec4 tilt(0);
            double shift = 0;
            for (std::uint32_t k = corners_.begin[i]; k < corners_.begin[i + 1]; ++k) {
                out.moves[corners_.items[k]] += list[k] * constraints_[i].normal;
                tilt += list[k] * offsets_[k];
                shift += list[k];
            }
            out.tilts[i] = tilt;
            out.shifts[i] = shift;
        }
    }

    // Returns the least change of the unknowns that makes all distances_ 0, to the first order. `tolerance` is the
    // precision of the solution (see kFirstTolerance). Adds the number of equations and unknowns of each step to `work`
    // (see kMaxWork).
    FlatteningUnknowns solveForChange(double tolerance, std::size_t& work) const {
        FlatteningUnknowns change(soup_.vertices.size(), constraints_.size()), gradient = change;
        std::vector<double> error(distances_.size()), image(distances_.size());
        std::transform(distances_.begin(), distances_.end(), error.begin(), std::negate<>());
        multiplyByTransposedJacobian(error, gradient);
        FlatteningUnknowns direction = gradient;
        double square = gradient.squaredLength();
        const double goal = tolerance * tolerance * square;
        for (std::size_t step = 0; step < kMaxGradientSteps && square > goal && work < kMaxWork; ++step) {
            work += error.size() + change.moves.size() + change.tilts.size();
            multiplyByJacobian(direction, image);
            double steepness = 0;
            for (const double value : image) steepness += value * value;
            if (!(steepness > 0)) break;
            const double length = square / steepness;
            change.scaleAndAdd(1, length, direction);
            for (std::size_t k = 0; k < error.size(); ++k) error[k] -= length * image[k];
            multiplyByTransposedJacobian(error, gradient);
            const double next = gradient.squaredLength();
            direction.scaleAndAdd(next / square, 1, gradient);
            square = next;
        }
        return change;
    }

    PolygonSoup& soup_;
    double maxDeviation_, goalDeviation_;
    std::vector<CohyperplanarityConstraint> constraints_;
    std::vector<std::uint32_t>
        constraintOfCell_;           // the constraint of each cell; kNone for a cell of at most four vertices
    geometry::JaggedArray corners_;  // the vertices of each constraint
    std::vector<glm::dvec4>
        offsets_;  // the offset of each corner from CohyperplanarityConstraint::middle, divided by the radius
    std::vector<double> distances_;  // the signed distance of each corner from the hyperplane
    std::vector<glm::dvec4> rest_;
    std::uint32_t farthest_ = kNone;  // the constraint with the largest deviation
};

}  // namespace

FlatteningReport flattenOrSplit(PolygonSoup& soup, double size, double maxDistance, double rounding) {
    FlatteningReport result;
    Flattener flattener(soup, size);
    result.deviation = flattener.deviation();
    const std::uint32_t cell = flattener.farthestCell();
    result.leastFlatCell = cell < soup.cellSourcePositions.size() ? soup.cellSourcePositions[cell].number : cell;
    if (flattener.isFlat()) return result;
    std::vector<bool> faces(soup.faces.size(), false), cells(soup.cells.size(), false);
    flattener.markNonFlat(faces, cells);
    const std::vector<glm::dvec4> before = soup.vertices;
    if (flattener.flatten(maxDistance)) {
        for (std::size_t v = 0; v < before.size(); ++v) {
            const double distance = glm::distance(soup.vertices[v], before[v]);
            result.moved += distance > rounding ? 1 : 0;
            result.distance = std::max(result.distance, distance);
        }
        return result;
    }
    soup.vertices = before;
    result.split = static_cast<std::size_t>(std::count(cells.begin(), cells.end(), true));
    splitIntoSimplices(soup, std::move(faces), cells);
    return result;
}

}  // namespace oval4d::polytopes

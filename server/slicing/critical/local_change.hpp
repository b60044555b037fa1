#pragma once
// Refines a critical w of a field: a w at which the topology of the field's section changes. Samples the field on ever
// finer lattices around the point of the change.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "fields/field.hpp"
#include "fields/inside.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::slicing {

/// Finds the w at which the number of connected parts of a field's section changes near a given point. The parts are
/// those of the body (the region on the inner side of a level), or those of the rest of the section. The search needs
/// no derivatives. So it also works for arrays, whose critical points mostly lie where the derivatives of the
/// interpolation jump.
///
/// The search works in a window: a cube in the section with kSide lattice points along each side. It treats the
/// function as linear between these points. The parts in the window are then the connected components of a graph. The
/// nodes of the graph are the lattice points in the body (or outside of it). Two nodes are joined if they differ by
/// ±(i, j, k) lattice steps with i, j, k in {0, 1}: by an edge of the Freudenthal subdivision of the lattice cubes.
/// Bisection finds the w of the change that is nearest to a given w, and a lattice point that enters or leaves the body
/// at this w. The next window is kZoom times smaller, has this point in its middle, and has the same number of lattice
/// points. Changes that are due to the boundary of a window do not count: the point must lie in the interior of the
/// window, and at least two smaller windows must have the same change.
///
/// An object keeps its memory for the next search. Only one thread at a time may use it.
class LocalTopologyChangeSearch {
  public:
    static constexpr int kSide = 33;    // the number of lattice points along each side of a window
    static constexpr int kWindows = 4;  // the number of successive windows, each smaller than the one before
    static constexpr double kZoom = 4;  // the width of a window divided by that of the next one

    /// The kind of change to search for: which parts become more numerous, or fewer, while w increases.
    struct SoughtPartCountChange {
        bool ofBody = true;       ///< true: the parts inside the level; false: the parts outside
        bool becomesMore = true;  ///< true: the number of these parts grows; false: it falls
    };
    /// Where to search. Lengths and w are in the units of the object.
    struct SearchStart {
        glm::dvec3 point;  ///< the middle of the first window
        double half;       ///< half the width of the first window
        double w;          ///< the search finds the change whose w is nearest to this value
        double reach;      ///< the greatest distance in w from `w` to the change in the first window
        double tolerance;  ///< the allowed error of the w that is found
    };

    /// Prepares a search in `field`, rotated by `orientation`, for changes at `level`. `inside` says which side of the
    /// level is the body. find() calls `mustEnd` often; if it returns true, find() ends early, in general without a
    /// result. `field` must outlive this object.
    LocalTopologyChangeSearch(const fields::Field& field, const geometry::Rotation& orientation, double level,
                              fields::BodySide inside, std::function<bool()> mustEnd);

    /// Returns the w of the change nearest to `start.w`. Returns an empty optional if there is no change in the first
    /// window, if the next two windows do not have the same change, or if the search needs too many samples.
    std::optional<double> find(const SoughtPartCountChange& change, const SearchStart& start);

  private:
    // A cube in the section: see the comment of the class.
    struct SearchWindow {
        glm::dvec3 center;
        double half;  // half the width of the cube
    };
    // A change of the number of parts, at a value of w.
    struct PartCountEvent {
        double w;
        // The lattice points in the interior of the window that move from one side of the level to the other; at least
        // one.
        std::vector<glm::dvec3> points;
    };
    // Per lattice point of a window: 1 if the point is in the body, else 0.
    using InBodyFlags = std::vector<std::uint8_t>;

    std::optional<double> findInWindow(const SearchWindow& window, double w, double reach, int number);
    std::optional<PartCountEvent> changeInWindow(const SearchWindow& window, double w, double reach, int number);
    void sampleWindow(const SearchWindow& window, double w, InBodyFlags& inside);
    std::size_t countSoughtParts(const InBodyFlags& inside);
    std::size_t countSoughtPartsAt(const SearchWindow& window, double w);
    bool isSoughtChange(std::size_t before, std::size_t after) const {
        return change_.becomesMore ? after > before : after < before;
    }

    const fields::Field& field_;
    const glm::dmat4 toFunction_;
    const double level_;
    const fields::BodySide inside_;
    const std::function<bool()> mustEnd_;
    // The result of leastStepAlongW(): bisection does not halve an interval of w that is at most this long.
    double leastStep_ = 0;
    SoughtPartCountChange change_;
    double tolerance_ = 0;
    int samplings_ = 0;  // how often a window was sampled in the current search
    InBodyFlags flags_, otherFlags_;
    std::vector<std::uint32_t> parents_;
    std::vector<float> values_;
    std::vector<float> x_, y_, z_, w_;  // the arguments of the function at one layer of a window's points
};

}  // namespace oval4d::slicing

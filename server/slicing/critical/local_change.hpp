#pragma once
// Refines a critical w of a field on ever finer lattices around the point at which the topology changes.

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

/// Finds the w at which the number of connected parts changes in the section around a point. The parts are those of the
/// body of a level, or those of the rest of the section. Needs no derivatives, so it also works for arrays, whose
/// critical points mostly lie where the derivatives of the interpolation jump.
///
/// Works in a window: a cube in the section with kSide lattice points along each side. Treats the function as linear
/// between these points. The number of parts is then that of the graph whose nodes are the lattice points in the body
/// (or outside of it). Each node has the neighbors at the offsets ±(i, j, k) with i, j, k in {0, 1}: the edges of the
/// Freudenthal subdivision. Bisection finds the w of the change that is nearest to a given w, and a lattice point that
/// enters or leaves the body there. The next window is kZoom times smaller, has this point in its middle, and has the
/// same number of points. Changes that are due to the boundary of a window are not counted: the point must lie in the
/// interior of the window, and the next windows must have the same change.
///
/// Reuses its memory. Only one thread at a time may use an object of this class.
class LocalChangeSearch {
  public:
    static constexpr int kSide = 33;    // the number of lattice points along each side of a window
    static constexpr int kWindows = 4;  // the number of windows
    static constexpr double kZoom = 4;  // the width of a window divided by that of the next one

    /// What changes while w increases.
    struct PartCountChange {
        bool ofBody = true;       ///< true: the parts of the body; false: the parts outside of the body
        bool becomesMore = true;  ///< whether the number of these parts grows
    };
    /// Where to search. Lengths and w are in the units of the object.
    struct SearchStart {
        glm::dvec3 point;  ///< the middle of the first window
        double half;       ///< half the width of the first window
        double w;          ///< the search finds the change nearest to this w
        double reach;      ///< the greatest distance in w from `w` to the change in the first window
        double tolerance;  ///< the error of the w of the change that is small enough
    };

    /// `mustEnd` is called often. If it returns true, find() ends without a result. `field` must outlive this object.
    LocalChangeSearch(const fields::Field& field, const geometry::Rotation& orientation, double level,
                      fields::Inside inside, std::function<bool()> mustEnd);

    /// Returns the w of the change. Returns an empty optional if there is no change in the first window, or if the
    /// smaller windows do not have the same change.
    std::optional<double> find(const PartCountChange& change, const SearchStart& start);

  private:
    struct SearchWindow {
        glm::dvec3 center;
        double half;  // half the width
    };
    // A change of the number of parts, at a value of w.
    struct LocalEvent {
        double w;
        std::vector<glm::dvec3> points;  // lattice points in the interior of the window that change sides; not empty
    };
    using PointFlags = std::vector<std::uint8_t>;  // per point of a window: whether it is in the body

    std::optional<double> findIn(const SearchWindow& window, double w, double reach, int number);
    std::optional<LocalEvent> eventIn(const SearchWindow& window, double w, double reach, int number);
    void sample(const SearchWindow& window, double w, PointFlags& inside);
    std::size_t countParts(const PointFlags& inside);
    std::size_t partsAt(const SearchWindow& window, double w);
    bool isChange(std::size_t before, std::size_t after) const {
        return change_.becomesMore ? after > before : after < before;
    }

    const fields::Field& field_;
    const glm::dmat4 toFunction_;
    const double level_;
    const fields::Inside inside_;
    const std::function<bool()> mustEnd_;
    double leastStep_ = 0;  // the result of leastStepAlongW(): bisection stops at intervals of w of this length
    PartCountChange change_;
    double tolerance_ = 0;
    int samplings_ = 0;  // how often a window was sampled in the current search
    PointFlags flags_, otherFlags_;
    std::vector<std::uint32_t> parents_;
    std::vector<float> values_;
    std::vector<float> x_, y_, z_, w_;  // the coordinates of one layer of points
};

}  // namespace oval4d::slicing

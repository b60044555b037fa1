#pragma once
// Finds the critical values of w of an object: those at which the type of its section by the hyperplane w = const
// changes.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "errors/error.hpp"
#include "geometry/rotation.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/object.hpp"
#include "text/choice.hpp"

namespace oval4d::slicing {

/// What happens to the section of an object while w increases past a critical value. All changes except `vertices` are
/// changes of the body of a field: the region where the field's function is below a level, or above it.
enum class SectionChange : std::uint8_t {
    vertices,       ///< the hyperplane passes vertices or points of an object that is not a field
    appearance,     ///< a component appears
    disappearance,  ///< a component vanishes
    merge,          ///< components merge
    split,          ///< a component splits
    handle,         ///< a component gains or loses a handle
    cavity,         ///< a cavity of a component opens or closes
};
inline constexpr auto kSectionChanges =
    text::completeTable<text::NamedValue<SectionChange>>({{"vertices", SectionChange::vertices},
                                                          {"appears", SectionChange::appearance},
                                                          {"vanishes", SectionChange::disappearance},
                                                          {"merge", SectionChange::merge},
                                                          {"split", SectionChange::split},
                                                          {"handle", SectionChange::handle},
                                                          {"cavity", SectionChange::cavity}});

/// The topology of a section of a field's body, the region on the inner side of one level: the numbers of its connected
/// components and cavities, as in SurfaceMeasurements.
struct SectionTopology {
    std::size_t components = 0, cavities = 0;
    long euler = 0;  ///< the Euler characteristic of the surface of the section
    bool operator==(const SectionTopology&) const = default;
};

/// A critical value of w, and the change of the section there.
struct CriticalSection {
    double w = 0;  ///< the critical value of w, in the units of the object
    SectionChange change = SectionChange::vertices;
    std::size_t vertices = 0;    ///< the number of the object's vertices or points with this w; 0 for a field
    std::size_t levelIndex = 0;  ///< for a field: the index in FieldSettings::levels of the level whose body changes
    /// For a field: the topology of the section just below w, and just above it.
    SectionTopology before = {}, after = {};
};

/// All critical values of w of an object in one orientation.
struct CriticalSections {
    double least = 0, greatest = 0;  ///< the range of w in which the object, or the domain of a field, lies
    /// For a field: the search narrowed down each change of the section to an interval of w of at most this length,
    /// before it combined close changes (see `resolution`). For other objects: vertices count as having the same w if
    /// their w differ by at most about this.
    double tolerance = 0;
    /// For a field: successive changes of the body of a level count as one change if their distance in w is at most
    /// this. For other objects: 0. The search misses changes of a field whose distance from an end of the range of w is
    /// less than 1/80 of this range.
    double resolution = 0;
    std::vector<CriticalSection> all;  ///< all critical values of w, in ascending order
};

using CriticalSectionsPtr = std::shared_ptr<const CriticalSections>;

/// The limits on one search of findCriticalSections().
struct CriticalSearchLimits {
    /// The time limit of the search, in seconds. After this time, no further intervals of w are halved, so that
    /// CriticalSections::tolerance may be greater than usual. To find the SectionChange of a critical w, the search
    /// compares two sections around it. After 1.5 times this time, it no longer compares them, and derives the
    /// SectionChange from their numbers of components and cavities alone.
    std::chrono::duration<double> time{10};
    /// The search ends early if a stop is requested.
    std::stop_token stop = {};
};

/// Finds the critical values of w of `object`, rotated by `orientation`. For any object but a field, these are the w
/// coordinates of its vertices or points. For a field, these are the values of w at which a body (the region on the
/// inner side of one of `settings.levels`, within the domain) changes its topology. To find them, the field is cut at
/// more than kCriticalSections values of w. The intervals between sections of different topology are halved until their
/// lengths are at most kCriticalTolerance times the length of the range of w.
///
/// The search misses changes that cancel each other between two successive sections. It ignores connected parts whose
/// volume is less than that of eight lattice cubes; the lattice of a section has kCriticalCubes cubes along the longest
/// side of the section. If there are about a thousand changes or more, the search ends early, with a greater tolerance.
///
/// At a critical point of a smooth function f inside the domain, f equals the level, and the derivatives along x, y and
/// z are 0. If the field is a formula, Newton's method solves these equations to refine each critical w; a w at which
/// the method does not converge stays as it is. If the field is an array, finer lattices around a change refine the
/// critical w (see LocalTopologyChangeSearch). This refinement is done if parts of the body appear, vanish, merge or
/// split there, or if cavities open or close. The finest of these lattices is 256 times finer than that of a section.
/// The refined w is that of the interpolated function, with an error of at most about kCriticalTolerance times the
/// length of the range of w.
///
/// Error: `canceled` if a stop is requested. Throws std::runtime_error if the samples of a field are in a file that can
/// no longer be read.
Result<CriticalSections> findCriticalSections(const Object& object, const geometry::Rotation& orientation,
                                              const FieldSettings& settings, const CriticalSearchLimits& limits);
inline constexpr int kCriticalSections = 128, kCriticalCubes = 160;
/// For a field: the usual CriticalSections::tolerance, divided by the length of the range of w.
inline constexpr double kCriticalTolerance = 1e-4;
/// For a field: CriticalSections::resolution, divided by the length of the range of w.
inline constexpr double kCriticalResolution = 1e-3;

/// Returns the next critical w above `w` or, if `upward` is false, below it. Two values that differ by at most `same`
/// count as equal. Returns an empty optional if there is no such critical w.
std::optional<double> nextCriticalW(const CriticalSections& sections, double w, bool upward, double same);

}  // namespace oval4d::slicing

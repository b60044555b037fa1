#include "slicing/critical/critical_sections.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>

#include "fields/field.hpp"
#include "slicing/critical/critical_point.hpp"
#include "slicing/critical/local_change.hpp"
#include "slicing/element.hpp"
#include "slicing/field_slicer.hpp"
#include "slicing/surfaces/surface_measurements.hpp"

namespace oval4d::slicing {

namespace {

using Clock = std::chrono::steady_clock;
using TopologyByLevel = std::vector<SectionTopology>;

const Error kCanceled{ErrorCode::canceled,
                      "the search for critical w has ended because its result is no longer needed"};

// How far searchOnFinerLattices() searches beyond both ends of the interval of w in which whole sections show a change,
// as a fraction of the length of the range of w.
constexpr double kLocalReach = 5e-3;
// The search halves no more intervals of w once it has found about this many changes, of all levels together. A noisy
// field may have more changes.
constexpr std::size_t kMaxChanges = 1000;

/// Cuts one field by one hyperplane at a time.
class SectionCutter {
  public:
    SectionCutter(const fields::Field& field, const geometry::Rotation& orientation, const FieldSettings& settings)
        : field_(field), orientation_(orientation), settings_(settings) {}

    /// Returns the surfaces of the section at `w`. `topologyOnly` is SurfaceDetail::topologyOnly: whether the points
    /// need no exact positions, normals or growth. The reference is valid until the next call.
    const SliceSurface& cut(double w, bool topologyOnly = false) {
        const geometry::Hyperplanes plane{0, 1, 1, w};
        slicer_.slice(field_, orientation_, plane, settings_, {}, slice_);
        glm::dvec3 min(0), max(0);
        for (std::size_t i = 0; i < slice_.vertices.size(); ++i) {
            min = i == 0 ? slice_.vertices[i] : glm::min(min, slice_.vertices[i]);
            max = i == 0 ? slice_.vertices[i] : glm::max(max, slice_.vertices[i]);
        }
        const glm::dvec3 extent = max - min;
        cube_ = std::max({extent.x, extent.y, extent.z}) / kCriticalCubes;
        slicer_.slice(field_, orientation_, plane, settings_,
                      {.steps = {cube_}, .quality = Quality::full, .topologyOnly = topologyOnly}, slice_);
        return slice_.surfaces.front();
    }
    /// Returns the side of the lattice cubes of the last section, in the units of the object.
    double cubeSide() const { return cube_; }

    /// Returns whether a connected part of the section that has this volume is too small to count. Such a part may not
    /// exist in reality: sampling on a lattice may separate the tip of a sharp corner from the rest of the section.
    bool isTooSmall(double volume) const { return std::abs(volume) < 8 * cube_ * cube_ * cube_; }

    /// Returns, for each level, the topology of its body in the section at `w`. Leaves out the parts of the body that
    /// are too small to count.
    TopologyByLevel topologyByLevel(double w) {
        const SliceSurface& surface = cut(w, true);
        TopologyByLevel result;
        for (std::size_t level = 0; level < settings_.levels.size(); ++level) {
            SectionTopology& topology = result.emplace_back();
            for (const auto& [volume, euler] : findConnectedParts(surface, level).parts) {
                if (isTooSmall(volume)) continue;
                ++(volume > 0 ? topology.components : topology.cavities);
                topology.euler += euler;
            }
        }
        return result;
    }

  private:
    const fields::Field& field_;
    const geometry::Rotation& orientation_;
    const FieldSettings& settings_;
    FieldSlicer slicer_;
    SliceSet slice_;
    double cube_ = 0;
};

/// An interval of w, and the topologies of the sections at its two ends.
struct SearchInterval {
    double from = 0, to = 0;
    TopologyByLevel atFrom, atTo;

    double width() const { return to - from; }
    bool hasDifferentEnds() const { return atFrom != atTo; }
    bool operator<(const SearchInterval& other) const { return width() < other.width(); }
};

/// Returns the change between sections with two different topologies, as far as the numbers of components and cavities
/// determine it.
SectionChange topologyChangeBetween(const SectionTopology& before, const SectionTopology& after) {
    if (before.components == 0 && after.components > 0) return SectionChange::appearance;
    if (after.components == 0 && before.components > 0) return SectionChange::disappearance;
    if (after.components < before.components) return SectionChange::merge;
    if (after.components > before.components) return SectionChange::split;
    return before.cavities != after.cavities ? SectionChange::cavity : SectionChange::handle;
}

/// Compares the connected parts of the surfaces in two sections at close values of w, to find whether parts appear,
/// vanish, merge or split.
class SurfacePartMatching {
  public:
    /// Finds which parts of the surfaces `a` and `b` of the level with the index `level` have a partner in the other
    /// surface. A part has a partner if most of its points are close to parts of the other surface that are not too
    /// small: at a distance of at most twice the side of a lattice cube.
    SurfacePartMatching(const SliceSurface& a, const SliceSurface& b, std::size_t level, const SectionCutter& cutter)
        : cutter_(cutter),
          reach_(2 * cutter.cubeSide()),
          partsA_(findConnectedParts(a, level)),
          partsB_(findConnectedParts(b, level)) {
        toB_ = findPartners(a, partsA_, b, partsB_);
        toA_ = findPartners(b, partsB_, a, partsA_);
    }

    /// Returns the change from section `a` to section `b`. `before` and `after` are the topologies of these sections,
    /// and must differ.
    SectionChange change(const SectionTopology& before, const SectionTopology& after) const {
        if (countMissingPartners(partsB_, toA_) > 0) return SectionChange::appearance;
        if (countMissingPartners(partsA_, toB_) > 0) return SectionChange::disappearance;
        return topologyChangeBetween(before, after);
    }

  private:
    using PartnerFlags = std::vector<bool>;  // per part: whether it has a partner in the other surface

    // Returns the number of parts that have a positive volume (see SurfaceMeasurements::components), have no partner,
    // and are not too small.
    std::size_t countMissingPartners(const SurfaceComponents& parts, const PartnerFlags& partners) const {
        std::size_t lonely = 0;
        for (std::size_t i = 0; i < partners.size(); ++i) {
            const double volume = parts.parts[i].volume;
            lonely += volume > 0 && !cutter_.isTooSmall(volume) && !partners[i] ? 1 : 0;
        }
        return lonely;
    }

    // Returns a number that identifies a cell of the grid into which findPartners() sorts points. The sides of the
    // cells have the length reach_.
    std::uint64_t gridCellKey(glm::ivec3 cell) const {
        constexpr int kBias = 1 << 20;
        const glm::u64vec3 c(cell + kBias);
        return c.x | c.y << 21U | c.z << 42U;
    }
    glm::ivec3 gridCellAt(const glm::vec3& point) const { return glm::ivec3(glm::floor(glm::dvec3(point) / reach_)); }

    // Returns, for each part of the surface `own`, whether it has a partner in the surface `other`.
    PartnerFlags findPartners(const SliceSurface& own, const SurfaceComponents& parts, const SliceSurface& other,
                              const SurfaceComponents& otherParts) const {
        std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
        for (std::uint32_t i = 0; i < other.points.size(); ++i) {
            const std::uint32_t part = otherParts.ofPoint[i];
            if (part == SurfaceComponents::kNone || cutter_.isTooSmall(otherParts.parts[part].volume)) continue;
            cells[gridCellKey(gridCellAt(other.points[i]))].push_back(i);
        }
        const auto isNear = [&](const glm::vec3& point) {
            const glm::ivec3 center = gridCellAt(point);
            for (int i = 0; i < 27; ++i) {
                const auto cell = cells.find(gridCellKey(center + glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
                if (cell == cells.end()) continue;
                for (const std::uint32_t near : cell->second) {
                    if (glm::distance(glm::dvec3(point), glm::dvec3(other.points[near])) <= reach_) return true;
                }
            }
            return false;
        };
        std::vector<std::size_t> points(parts.parts.size()), near(parts.parts.size());
        for (std::size_t i = 0; i < own.points.size(); ++i) {
            const std::uint32_t part = parts.ofPoint[i];
            if (part == SurfaceComponents::kNone) continue;
            ++points[part];
            if (isNear(own.points[i])) ++near[part];
        }
        PartnerFlags result;
        for (std::size_t i = 0; i < points.size(); ++i) result.push_back(2 * near[i] > points[i]);
        return result;
    }

    const SectionCutter& cutter_;
    double reach_;
    SurfaceComponents partsA_, partsB_;
    PartnerFlags toB_, toA_;
};

/// An interval of w in which the topology of the body of one level changes.
struct TopologyChangeInterval {
    double from, to;
    std::size_t level;
    SectionTopology before, after;
};

/// One search for the critical values of w of a field.
class CriticalSearch {
  public:
    CriticalSearch(const fields::Field& field, const geometry::Rotation& orientation, const FieldSettings& settings,
                   const CriticalSearchLimits& limits, std::pair<double, double> range)
        : field_(field),
          orientation_(orientation),
          settings_(settings),
          limits_(limits),
          begin_(Clock::now()),
          end_(begin_ + std::chrono::duration_cast<Clock::duration>(limits.time)),
          cutter_(field, orientation, settings) {
        found_.least = range.first;
        found_.greatest = range.second;
        found_.tolerance = kCriticalTolerance * width();
        found_.resolution = kCriticalResolution * width();
    }

    Result<CriticalSections> run() {
        if (limits_.stop.stop_requested()) return kCanceled;
        findChangeIntervals();
        for (const TopologyChangeInterval& change : combinedChanges()) {
            if (limits_.stop.stop_requested()) break;
            found_.all.push_back(criticalSectionOf(change));
        }
        if (limits_.stop.stop_requested()) return kCanceled;
        std::ranges::stable_sort(found_.all, {}, &CriticalSection::w);
        return std::move(found_);
    }

  private:
    double width() const { return found_.greatest - found_.least; }
    bool mustEnd() const { return limits_.stop.stop_requested() || Clock::now() > end_; }

    // Sets intervals_ to the intervals of w in which the topology changes. Always halves the widest interval that is
    // left, so that the range of w is covered evenly even if the search ends early.
    void findChangeIntervals() {
        const double gap = width() / kCriticalSections;
        // Leaves out the ends of the range of w. There, the domain may be a wedge that is thinner than a lattice cube.
        const double margin = width() / 80;
        const double from = found_.least + margin, to = found_.greatest - margin;
        std::priority_queue<SearchInterval> open;
        open.push({from, to, cutter_.topologyByLevel(from), cutter_.topologyByLevel(to)});
        while (!open.empty()) {
            const SearchInterval widest = open.top();
            open.pop();
            const bool fine = widest.width() <= (widest.hasDifferentEnds() ? found_.tolerance : gap);
            if (!fine && !mustEnd() && intervals_.size() + open.size() < kMaxChanges + kCriticalSections) {
                const double middle = (widest.from + widest.to) / 2;
                const TopologyByLevel between = cutter_.topologyByLevel(middle);
                open.push({widest.from, middle, widest.atFrom, between});
                open.push({middle, widest.to, between, widest.atTo});
                continue;
            }
            if (!fine) found_.tolerance = std::max(found_.tolerance, widest.width());
            if (widest.hasDifferentEnds()) intervals_.push_back(widest);
        }
        std::ranges::sort(intervals_, {}, &SearchInterval::from);
    }

    // Returns the changes of the body of each level. Combines changes of a level that are at most the resolution apart
    // in w, because the lattice shows several changes where a surface touches itself along a curve.
    std::vector<TopologyChangeInterval> combinedChanges() const {
        std::vector<TopologyChangeInterval> all;
        for (std::size_t level = 0; level < settings_.levels.size(); ++level) {
            const std::size_t first = all.size();
            for (const SearchInterval& interval : intervals_) {
                if (interval.atFrom[level] == interval.atTo[level]) continue;
                if (all.size() > first && interval.from - all.back().to <= found_.resolution) {
                    all.back().to = interval.to;
                    all.back().after = interval.atTo[level];
                } else {
                    all.push_back({interval.from, interval.to, level, interval.atFrom[level], interval.atTo[level]});
                }
            }
        }
        std::erase_if(all, [](const TopologyChangeInterval& change) { return change.before == change.after; });
        return all;
    }

    // Returns the critical section for a change: its w, and the kind of the change.
    CriticalSection criticalSectionOf(const TopologyChangeInterval& change) {
        if (Clock::now() > end_ + (end_ - begin_) / 2) {
            // 1.5 times the time limit has passed, so the sections at both ends of the interval are not compared.
            return {(change.from + change.to) / 2,
                    topologyChangeBetween(change.before, change.after),
                    0,
                    change.level,
                    change.before,
                    change.after};
        }
        const SliceSurface before = cutter_.cut(change.from);
        const SliceSurface& after = cutter_.cut(change.to);
        CriticalSection result{
            (change.from + change.to) / 2, SectionChange::handle, 0, change.level, change.before, change.after};
        result.change = SurfacePartMatching(before, after, change.level, cutter_).change(change.before, change.after);
        if (mustEnd()) return result;
        std::optional<double> best;
        if (field_.formula.empty()) {
            best = searchOnFinerLattices(change, result.change, before, after);
        } else {
            searchNearTangentPoints(change, before, change.from, best);
            searchNearTangentPoints(change, after, change.to, best);
        }
        result.w = best.value_or(result.w);
        return result;
    }

    // Searches for critical points near those points of `surface`, the section at `w`, at which the level set is most
    // nearly tangent to the hyperplane. Ignores critical points whose w is farther than the resolution from the
    // interval of the change. `best` is the best critical w that is known, if any. Replaces `best` by the w of a
    // critical point if that is nearer to the middle of the interval.
    void searchNearTangentPoints(const TopologyChangeInterval& change, const SliceSurface& surface, double w,
                                 std::optional<double>& best) const {
        constexpr std::size_t kStarts = 24;
        const TransformedFunction placed{*field_.function, field_.toFunction * orientation_.inverse().matrix(),
                                         field_.center, field_.circumradius};
        const double middle = (change.from + change.to) / 2;
        const double cube = cutter_.cubeSide();
        for (const std::uint32_t i : tangentPoints(surface, change.level, 4 * cube, kStarts)) {
            const auto point =
                findCriticalPoint(placed, settings_.levels[change.level], {glm::dvec3(surface.points[i]), w}, 8 * cube);
            if (!point || point->w < change.from - found_.resolution || point->w > change.to + found_.resolution)
                continue;
            if (!best || std::abs(point->w - middle) < std::abs(*best - middle)) best = point->w;
        }
    }

    // Returns the critical w of a change of kind `kind`, refined on finer lattices around points where the level set is
    // most nearly tangent to the hyperplane. Where parts merge or vanish, such points are in the section `before`;
    // where parts split or appear, they are in the section `after`. The points of this section are tried first. Returns
    // an empty optional if no point leads to a result, and for a change of handles, because finer lattices show
    // additional handles where the surface has creases.
    std::optional<double> searchOnFinerLattices(const TopologyChangeInterval& change, SectionChange kind,
                                                const SliceSurface& before, const SliceSurface& after) const {
        constexpr std::size_t kStarts = 24;
        if (kind == SectionChange::handle) return std::nullopt;
        const bool ofBody = kind != SectionChange::cavity;
        const bool becomesMore = ofBody ? kind == SectionChange::appearance || kind == SectionChange::split
                                        : change.after.cavities > change.before.cavities;
        const double cube = cutter_.cubeSide();
        LocalTopologyChangeSearch search(field_, orientation_, settings_.levels[change.level], settings_.inside,
                                         [this] { return mustEnd(); });
        for (const SliceSurface* surface : {becomesMore ? &after : &before, becomesMore ? &before : &after}) {
            for (const std::uint32_t i : tangentPoints(*surface, change.level, 4 * cube, kStarts)) {
                const auto w =
                    search.find({ofBody, becomesMore}, {.point = glm::dvec3(surface->points[i]),
                                                        .half = 4 * cube,
                                                        .w = (change.from + change.to) / 2,
                                                        .reach = kLocalReach * width() + (change.to - change.from) / 2,
                                                        .tolerance = kCriticalTolerance * width()});
                if (w) return w;
            }
        }
        return std::nullopt;
    }

    // Returns the indices of up to `count` points of the level set where it is most nearly tangent to the hyperplane:
    // those with the greatest |growth| (see SliceSurface::growth). Any two of these points are more than `distance`
    // apart.
    static std::vector<std::uint32_t> tangentPoints(const SliceSurface& surface, std::size_t level, double distance,
                                                    std::size_t count) {
        std::vector<std::uint32_t> candidates;
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            if (surface.levelAndCap[t] != level) continue;
            for (const std::uint32_t point : surface.triangles[t]) candidates.push_back(point);
        }
        std::ranges::sort(candidates);
        candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
        std::ranges::stable_sort(candidates, std::ranges::greater{},
                                 [&](std::uint32_t point) { return std::abs(surface.growth[point]); });
        std::vector<std::uint32_t> chosen;
        for (const std::uint32_t point : candidates) {
            if (chosen.size() == count) break;
            const bool apart = std::ranges::all_of(chosen, [&](std::uint32_t other) {
                return glm::distance(surface.points[point], surface.points[other]) > distance;
            });
            if (apart) chosen.push_back(point);
        }
        return chosen;
    }

    const fields::Field& field_;
    const geometry::Rotation& orientation_;
    const FieldSettings& settings_;
    const CriticalSearchLimits& limits_;
    const Clock::time_point begin_, end_;
    SectionCutter cutter_;
    std::vector<SearchInterval> intervals_;
    CriticalSections found_;
};

}  // namespace

Result<CriticalSections> findCriticalSections(const Object& object, const geometry::Rotation& orientation,
                                              const FieldSettings& settings, const CriticalSearchLimits& limits) {
    const auto range = rangeOfW(object, orientation);
    if (const fields::Field* field = fieldIn(object))
        return CriticalSearch(*field, orientation, settings, limits, range).run();
    CriticalSections found{range.first, range.second, kOnPlaneTolerance * infoOf(object).circumradius, 0, {}};
    for (const auto& [w, vertexCount] : vertexHeights(object, orientation))
        found.all.push_back({w, SectionChange::vertices, vertexCount, 0, {}, {}});
    return found;
}

std::optional<double> nextCriticalW(const CriticalSections& sections, double w, bool upward, double same) {
    std::optional<double> next;
    for (const CriticalSection& section : sections.all) {
        if (upward && section.w > w + same) return section.w;
        if (!upward && section.w < w - same) next = section.w;
    }
    return next;
}

}  // namespace oval4d::slicing

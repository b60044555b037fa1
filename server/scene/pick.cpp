#include "scene/pick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "scene/density_strip_lines.hpp"

namespace oval4d::scene {

namespace {

using slicing::Element;
using slicing::ElementKind;
using slicing::SliceSet;
using slicing::Visibility;

// Returns the element of the object from which an element of a slice was cut. `source` is the source number of the
// slice element (see SliceSet). A number less than `count` is the index of an element of the kind `cut` that the
// hyperplane cuts. Any other number is `count` plus the index of an element of the kind `contained` that lies in the
// hyperplane.
Element elementOfSource(std::uint32_t source, ElementKind cut, std::size_t count, ElementKind contained) {
    if (source < count) return {cut, source};
    return {contained, source - count};
}

// Returns the length of one unit of the object in the panels of the matrix, in pixels.
double pixelsPerUnitOf(const Scene& scene) {
    return scene.matrix.panelScale(scene.circumradius) * scene.viewport.height;
}

// Finds the element that is nearest to the viewer at one pixel.
class ElementPicker {
  public:
    ElementPicker(const Scene& scene, const slicing::Object& object, glm::dvec2 point)
        : scene_(scene),
          counts_(slicing::elementCounts(object)),
          drawsFaces_(scene.look.parts.faces && slicing::fieldIn(object) == nullptr),
          view_(scene.camera.view()) {
        const double aspect = static_cast<double>(scene.viewport.width) / scene.viewport.height;
        projection_ = scene.camera.projection(aspect);
        size_ = {scene.viewport.width, scene.viewport.height};
        pixel_ = {point.x, size_.y - point.y};
        focalLength_ = 0.5 * projection_[1][1] * size_.y;
        ray_ = viewRayThrough(scene, point);
    }

    void pickSlices() {
        const ShownParts& parts = scene_.look.parts;
        for (std::size_t i = 0; i < scene_.placements.size(); ++i) {
            if (!scene_.placements[i].drawn) continue;
            // If balls are hidden, the points of a cloud can still be picked, but the balls that join bars cannot.
            const bool points = parts.balls || !scene_.slices->ballScale.empty();
            pickInSlice(*scene_.slices, i, scene_.placements[i].position, scene_.scale,
                        {points ? scene_.drawnBallRadius() : 0, parts.bars ? scene_.barRadius : 0, drawsFaces_},
                        {{}, PickLocation::slice, i});
        }
    }

    void pickProjection() {
        if (!scene_.projectionPlacement.shown) return;
        const ObjectProjection& projection = scene_.projection;
        for (std::size_t i = 0; i < projection.parts.size(); ++i) {
            const ProjectionPartLook& part = projection.parts[i];
            pickInSlice(projection.elements, i, scene_.projectionPlacement.position, projection.scale,
                        {part.ballRadius, part.barRadius, part.faceOpacity > 0}, {{}, PickLocation::projection, 0});
        }
    }

    void pickMatrix() {
        const auto panel = scene_.matrix.panelAt(pixel_ / size_.y);
        if (!panel) return;
        const SectionMatrix& matrix = scene_.sectionMatrix;
        const auto [row, column] = *panel;
        const auto section = std::ranges::find_if(matrix.sections, [&](const slicing::PlanarSection& s) {
            return s.axes[0] == std::min(row, column) && s.axes[1] == std::max(row, column);
        });
        const auto& styles = matrix.styles[static_cast<std::size_t>(section - matrix.sections.begin())];
        const glm::dvec2 center = scene_.matrix.center(row, column) * size_.y;
        const double scale = pixelsPerUnitOf(scene_);
        const auto pixelAt = [&](std::size_t i) {
            const glm::dvec2& p = section->points[i];
            return center + scale * (row < column ? glm::dvec2(p.y, p.x) : p);
        };
        double nearest = std::numeric_limits<double>::max();
        const bool balls = scene_.look.parts.balls || !section->ballScale.empty();
        for (std::size_t i = 0; balls && i < section->points.size(); ++i) {
            const double own = section->ballScale.empty() ? 1 : section->ballScale[i];
            const double distance = glm::distance(pixelAt(i), pixel_);
            if (distance > std::max(scene_.matrix.pointRadius * size_.y * own, kHitRadius)) continue;
            if (distance > nearest || styles.points[i] == Visibility::hidden) continue;
            nearest = distance;
            picked_ = {elementOfSectionPoint(section->pointSource[i]), PickLocation::matrix, 0};
        }
        if (picked_) return;
        nearest = std::max(scene_.matrix.lineWidth / 2 * size_.y, kHitRadius);
        for (std::size_t e = 0; scene_.look.parts.bars && e < section->edges.size(); ++e) {
            const double distance = distanceFromLine(pixelAt(section->edges[e][0]), pixelAt(section->edges[e][1]));
            if (distance > nearest || styles.edges[e] == Visibility::hidden) continue;
            nearest = distance;
            picked_ = {elementOfSource(section->edgeSource[e], ElementKind::cell, counts_[3], ElementKind::face),
                       PickLocation::matrix, 0};
        }
    }

    void pickCoordinates() {
        const ParallelCoordinatesLayout& layout = scene_.coordinates;
        if (!scene_.look.parts.coordinates) return;
        const glm::dvec2 at = pixel_ / size_.y;
        if (layout.isDensityStrip) {
            if (const auto vertex = vertexInDensityStripAt(scene_, at))
                picked_ = {{ElementKind::vertex, *vertex}, PickLocation::coordinates, 0};
            return;
        }
        if (!layout.hasLines()) return;
        const double first = layout.left - layout.lineStep / 2;
        const double column = std::floor((at.x - first) / layout.columnStep);
        const double row = std::round((layout.zero - at.y) / layout.rowStep);
        if (column < 0 || column >= layout.perRow || row < 0 || row >= layout.rows) return;
        const bool inRow = std::abs(layout.zero - row * layout.rowStep - at.y) <= layout.amplitude;
        const bool inColumn = at.x - first - column * layout.columnStep <= 4 * layout.lineStep + layout.lineWidth;
        const double index = row * layout.perRow + column;
        if (!inRow || !inColumn || index >= static_cast<double>(counts_[0])) return;
        picked_ = {{ElementKind::vertex, static_cast<std::size_t>(index)}, PickLocation::coordinates, 0};
    }

    const std::optional<PickedElement>& picked() const { return picked_; }

  private:
    struct DrawnElementSizes {
        double ball, bar;  // the radii of balls and bars in world units; 0 if balls or bars are not drawn
        bool faces;
    };

    // Returns the element of the object from which a point of a planar section was cut. `source` is the source number
    // of the point (see PlanarSection).
    Element elementOfSectionPoint(std::uint32_t source) const {
        if (source < counts_[2]) return {ElementKind::face, source};
        return elementOfSource(source - static_cast<std::uint32_t>(counts_[2]), ElementKind::edge, counts_[1],
                               ElementKind::vertex);
    }

    // Returns the distance of the picked pixel from a line segment in the picture, in pixels.
    double distanceFromLine(const glm::dvec2& from, const glm::dvec2& to) const {
        const glm::dvec2 along = to - from;
        const double length = glm::dot(along, along);
        const double t = length > 0 ? std::clamp(glm::dot(pixel_ - from, along) / length, 0.0, 1.0) : 0;
        return glm::distance(from + t * along, pixel_);
    }

    // Finds the element at the pixel in slice i of `set`, or in part i of the projection. Sets picked_ to this element
    // if it is nearer to the eye than the element that picked_ has so far. `position` and `scale` map the units of the
    // object to world space. `where` has the values for PickedElement::in and PickedElement::slice.
    void pickInSlice(const SliceSet& set, std::size_t i, const glm::dvec3& position, double scale,
                     const DrawnElementSizes& sizes, const PickedElement& where) {
        const std::uint32_t v0 = set.vertexBegin[i], e0 = set.edgeBegin[i];
        points_.clear();
        pixels_.clear();
        for (std::uint32_t v = v0; v < set.vertexBegin[i + 1]; ++v) {
            points_.emplace_back(view_ * glm::dvec4(position + scale * set.vertices[v], 1));
            pixels_.push_back(pixelOf(points_.back()));
        }
        const auto isHidden = [](Visibility visibility) { return visibility == Visibility::hidden; };
        const auto add = [&](double depth, const Element& element) {
            if (depth >= nearest_ || depth < scene_.camera.near) return;
            nearest_ = depth;
            picked_ = where;
            picked_->element = element;
            picked_->depth = depth;
        };
        for (std::uint32_t v = v0; sizes.ball > 0 && v < set.vertexBegin[i + 1]; ++v) {
            if (!set.hasBall(v) || isHidden(scene_.visibilities.vertex(set.vertexSource[v]))) continue;
            const glm::dvec3& center = points_[v - v0];
            const double own = set.ballScale.empty() ? 1 : set.ballScale[v];
            if (isHitAtDistance(glm::distance(pixels_[v - v0], pixel_), sizes.ball * own, -center.z))
                add(-center.z - sizes.ball * own,
                    elementOfSource(set.vertexSource[v], ElementKind::edge, counts_[1], ElementKind::vertex));
        }
        for (std::uint32_t e = e0; sizes.bar > 0 && e < set.edgeBegin[i + 1]; ++e) {
            if (isHidden(scene_.visibilities.edge(set.edgeSource[e]))) continue;
            const auto& [start, end] = set.edges[e];
            const glm::dvec3 &a = points_[start], &b = points_[end];
            const glm::dvec2 from = pixels_[start], along = pixels_[end] - from;
            const double length = glm::dot(along, along);
            const double t = length > 0 ? std::clamp(glm::dot(pixel_ - from, along) / length, 0.0, 1.0) : 0;
            const double depth = -(a.z + t * (b.z - a.z));
            if (isHitAtDistance(glm::distance(from + t * along, pixel_), sizes.bar, depth))
                add(depth - sizes.bar,
                    elementOfSource(set.edgeSource[e], ElementKind::face, counts_[2], ElementKind::edge));
        }
        // The loops that were cut from one cell form a single face (see FilledFaces).
        for (std::uint32_t f = set.faceBegin[i], end = f; sizes.faces && f < set.faceBegin[i + 1]; f = end) {
            while (end < set.faceBegin[i + 1] && set.faceSource[end] == set.faceSource[f]) ++end;
            if (isHidden(scene_.visibilities.face(set.faceSource[f]))) continue;
            if (const auto depth = depthOfFace(set, f, end))
                add(*depth, elementOfSource(set.faceSource[f], ElementKind::cell, counts_[3], ElementKind::face));
        }
    }

    // Returns whether a ball or bar is hit at a distance of `pixels` pixels from its center or axis. `radius` is its
    // radius, in world units, and `depth` its distance from the eye along the view axis.
    bool isHitAtDistance(double pixels, double radius, double depth) const {
        return depth > 0 && pixels <= std::max(radius * focalLength_ / depth, kHitRadius);
    }

    glm::dvec2 pixelOf(const glm::dvec3& point) const {
        const glm::dvec4 clip = projection_ * glm::dvec4(point, 1);
        return (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * size_;
    }

    // Returns the depth at which the ray through the pixel meets the face with the loops firstLoop … endLoop − 1.
    // Returns an empty optional if the ray misses the face, or if a corner is behind the eye. A point is inside the
    // face if the sum of the winding numbers of the loops around the point is not 0.
    std::optional<double> depthOfFace(const SliceSet& set, std::uint32_t firstLoop, std::uint32_t endLoop) const {
        int winding = 0;
        glm::dvec3 area(0);
        for (std::uint32_t loop = firstLoop; loop < endLoop; ++loop) {
            const std::uint32_t begin = set.cornerBegin[loop], end = set.cornerBegin[loop + 1];
            for (std::uint32_t c = begin; c < end; ++c) {
                const std::uint32_t corner = set.corners[c], next = set.corners[c + 1 < end ? c + 1 : begin];
                const glm::dvec3 &p = points_[corner], &q = points_[next];
                area += glm::cross(p, q);
                if (p.z >= 0 || q.z >= 0) return std::nullopt;
                const glm::dvec2 a = pixels_[corner] - pixel_, b = pixels_[next] - pixel_;
                const double cross = a.x * b.y - a.y * b.x;
                if (a.y <= 0 && b.y > 0 && cross > 0) ++winding;
                if (a.y > 0 && b.y <= 0 && cross < 0) --winding;
            }
        }
        const double across = glm::dot(area, ray_);
        if (winding == 0 || across == 0) return std::nullopt;
        return glm::dot(area, points_[set.corners[set.cornerBegin[firstLoop]]]) / across;
    }

    const Scene& scene_;
    const std::array<std::size_t, 4> counts_;
    const bool drawsFaces_;  // whether the faces of slices are drawn; always false for a field
    const glm::dmat4 view_;
    glm::dmat4 projection_;
    // The size of the picture and the place of the pixel, in pixels from the lower left corner.
    glm::dvec2 size_, pixel_;
    double focalLength_ = 0;
    glm::dvec3 ray_;
    // Per vertex of the slice or part in which pickInSlice() searches: its view coordinates (points_) and its pixel
    // (pixels_). The pixel has no meaning for a vertex that is not in front of the eye.
    std::vector<glm::dvec3> points_;
    std::vector<glm::dvec2> pixels_;
    double nearest_ = std::numeric_limits<double>::max();  // the depth of the element in picked_
    std::optional<PickedElement> picked_;
};

}  // namespace

std::optional<PickedElement> pickElement(const Scene& scene, const slicing::Object& object, glm::dvec2 point) {
    ElementPicker picker(scene, object, point);
    picker.pickCoordinates();
    if (picker.picked()) return picker.picked();
    if (matrixPointAt(scene, point)) {  // panels cover the slices behind them, so slices are not searched
        picker.pickMatrix();
        return picker.picked();
    }
    if (isClearedOfSlices(scene, point)) return std::nullopt;
    picker.pickSlices();
    if (!picker.picked()) picker.pickProjection();  // slices are drawn over the projection, so they come first
    return picker.picked();
}

std::optional<glm::dvec4> matrixPointAt(const Scene& scene, glm::dvec2 point) {
    const double height = scene.viewport.height;
    const glm::dvec2 pixel{point.x, height - point.y};
    const auto panel = scene.matrix.panelAt(pixel / height);
    if (!panel) return std::nullopt;
    const auto [row, column] = *panel;
    const glm::dvec2 offset = (pixel - scene.matrix.center(row, column) * height) / pixelsPerUnitOf(scene);
    glm::dvec4 found = scene.sectionMatrix.point;
    found[column] = offset.x;
    found[row] = offset.y;
    return found;
}

glm::dvec3 viewRayThrough(const Scene& scene, glm::dvec2 point) {
    const glm::dvec2 size(scene.viewport.width, scene.viewport.height);
    const glm::dmat4 projection = scene.camera.projection(size.x / size.y);
    const glm::dvec2 ndc = 2.0 * glm::dvec2(point.x, size.y - point.y) / size - 1.0;
    return {(ndc.x + projection[2][0]) / projection[0][0], (ndc.y + projection[2][1]) / projection[1][1], -1};
}

bool isClearedOfSlices(const Scene& scene, glm::dvec2 point) {
    return scene.clearsCoordinatesArea() && point.y >= scene.viewport.height * (1 - scene.coordinates.top());
}

}  // namespace oval4d::scene

#pragma once
// Places the labels of slices, and decides which of them are shown.

#include <cstddef>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/arrangement.hpp"
#include "scene/camera.hpp"
#include "scene/layout.hpp"
#include "scene/picture_boxes.hpp"

namespace oval4d::scene {

/// Decides where the labels of slices are placed, how large they are, and which of them are shown.
class LabelLayout {
  public:
    /// Prepares the labels of the slices in `placements`. `decimals` is the number of decimals in the labels. `originW`
    /// is added to each w (see LayoutObjectInfo). Other functions of this object change the labels in `placements`.
    /// `arrangement` and `placements` must outlive this object.
    LabelLayout(const SliceArrangement& arrangement, int decimals, double originW,
                std::vector<SlicePlacement>& placements);

    /// Reduces the size of labels until they fit side by side in columns of the width `columnWidth`, in viewport
    /// heights (see SliceArrangement::labelColumns). The labels keep a minimum size, even if they do not fit at this
    /// size.
    void shrinkLabels(double columnWidth);

    /// Returns how far the labels extend beyond the slices on each side, in viewport heights. `bounds` are the bounds
    /// of the slices on the plane at distance 1 from the eye. `scale` is the length in the picture, in viewport
    /// heights, of one unit on this plane.
    Rect overhang(const Rect& bounds, double scale) const;

    /// Places each label on the outer side of the curve on which the slices stand, where there is no neighboring slice.
    /// Labels are below the focus slice (the middle one) of an oval, and below the slices of a row or grid. They are
    /// beside and somewhat below the slices on the arms of the oval, and to the right of the slices of a column.
    void placeLabels(const Camera& camera);

    /// Appends the name of the section to the label of the focus slice (the middle one), if there is room for it in the
    /// picture. `aspect` is the width of the picture in viewport heights. A label beside its slice grows only to the
    /// right, away from the slice.
    void appendNameToFocusLabel(std::string_view name, const Camera& camera, double aspect);

    /// Removes labels so that no two of them overlap. Keeps the label of the focus slice (the middle one) and, of the
    /// others, at most every k-th (see smallestLabelStep()). Also removes a label in these cases:
    /// - It is behind the eye, or extends beyond the picture.
    /// - It overlaps the kept label of a slice that is nearer to the focus slice.
    /// - The viewer has moved the camera (`isMoved`), and the label overlaps another slice or the axes symbol, whose
    ///   box is `axes`.
    /// - The viewer has moved the camera, and the label extends below `bottom`, the upper edge of the parallel
    ///   coordinates.
    void removeOverlappingLabels(const Camera& camera, double aspect, double bottom, const CenteredRect& axes,
                                 bool isMoved);

  private:
    // Returns the font size of a label, in viewport heights.
    static double fontSize(const SlicePlacement& placement);

    // Returns the gap between a slice and the text of its label, in viewport heights.
    double labelGapOf(const SlicePlacement& placement) const;

    // Returns half the size of a label's text, in viewport heights, without the name of a section.
    glm::dvec2 halfTextSize(const SlicePlacement& placement) const;

    // Returns half the size of the plate behind a label, in viewport heights, without the name of a section.
    glm::dvec2 halfPlateSize(const SlicePlacement& placement) const;

    // Returns the center of the slice with the parameter u, on the plane at distance 1 from the eye.
    glm::dvec2 sliceCenterOnPlane(double u) const;

    // Returns how far the slice with the parameter u, regarded as a sphere, extends on the screen from its center in
    // `direction`, a unit vector. The result is in viewport heights. At the depth of the center, a world unit appears
    // as `scale` viewport heights. Away from the optical axis, perspective stretches the picture of the sphere.
    //
    // Let n be `direction`, r the radius of the sphere, c the coordinates of its center parallel to the screen, and d
    // the depth of the center. A line on the screen perpendicular to n shows a plane through the eye: the points with
    // coordinates p and depth q for which n·p = e·q, for some number e. The plane touches the sphere if (n·c − e·d)² =
    // r²·(1 + e²). With the larger solution e, the sphere extends by e·d − n·c world units.
    double screenExtentOfSlice(double u, const glm::dvec2& direction, double scale) const;

    // Returns the vector on the screen from the center of slice i to the center of its label, in viewport heights. At
    // the depth of the slice, a world unit appears as `scale` viewport heights.
    glm::dvec2 labelOffset(std::size_t i, double scale) const;

    // Returns the box of label i before the viewer moves the camera, in viewport heights from the center of the focus
    // slice (the middle one). `scale` is the length in the picture, in viewport heights, of one unit on the plane at
    // distance 1 from the eye.
    CenteredRect labelBoxInInitialView(std::size_t i, double scale) const;

    // Returns where the point p, given in view coordinates, appears in the picture: in viewport heights from the lower
    // left corner. `aspect` is the width of the picture, in viewport heights.
    static glm::dvec2 screenPosition(const glm::dvec3& p, const Camera& camera, double aspect);

    // Returns whether the box of label i overlaps a slice other than slice i. `box` is the result of labelBoxSeenBy()
    // for this label. `toView` is camera.view(), which the caller computes once for all labels. `aspect` is the width
    // of the picture, in viewport heights.
    bool overlapsOtherSlice(std::ptrdiff_t i, const CenteredRect& box, const Camera& camera, const glm::dmat4& toView,
                            double aspect) const;

    // Returns the box that the label of `placement` takes up in the picture that `camera` takes, in viewport heights
    // from the lower left corner of the picture. The box of the focus slice's label includes the name of the section.
    // `toView` is camera.view(), which the caller computes once for all labels. `aspect` is the width of the picture,
    // in viewport heights.
    CenteredRect labelBoxSeenBy(const Camera& camera, const glm::dmat4& toView, double aspect,
                                const SlicePlacement& placement) const;

    // Returns the smallest k for which no two labels overlap if only every k-th label, counted from the focus slice
    // (the middle one), is kept. The camera is at its first place, before the viewer moves it. `scale` is the length in
    // the picture, in viewport heights, of one unit on the plane at distance 1 from the eye.
    std::ptrdiff_t smallestLabelStep(std::ptrdiff_t focus, double scale) const;

    const SliceArrangement& arrangement_;
    InitialViewSpace space_;
    double width_ = 0;  // the width of the longest number in a label, as a multiple of the font size
    // The width of the section's name in the focus slice's label, as a multiple of the font size.
    double nameWidth_ = 0;
    std::vector<SlicePlacement>& placements_;
};

}  // namespace oval4d::scene

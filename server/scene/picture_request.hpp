#pragma once

#include "geometry/hyperplanes.hpp"
#include "geometry/reference_frame.hpp"
#include "geometry/rotation.hpp"
#include "scene/camera.hpp"
#include "scene/look.hpp"
#include "slicing/object.hpp"
#include "slicing/surface_detail.hpp"

namespace oval4d::scene {

/// A request for a picture: all data that affect the pixels of the picture, and no other data.
struct PictureRequest {
    slicing::Object source;  ///< the object as it was built or loaded
    geometry::ReferenceFrame referenceFrame;
    slicing::Object object;  ///< `source` in the coordinates of `referenceFrame` (see slicing::transformedTo())
    geometry::Rotation orientation;
    geometry::Hyperplanes planes;  ///< evenly spaced: Hyperplanes::listed is empty
    int focus = 0;                 ///< the index n of the focus slice (see SlicePlacement::index)
    Look look;
    Viewport viewport;
    slicing::Quality quality = slicing::Quality::full;

    /// Returns the hyperplane of the focus slice (the middle one).
    geometry::Hyperplanes focusPlane() const { return {focus, 1, planes.spacing, planes.offset}; }
    bool operator==(const PictureRequest&) const = default;
};

}  // namespace oval4d::scene

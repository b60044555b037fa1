#pragma once

#include "scene/picture_request.hpp"
#include "slicing/object.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::pipeline {

/// Names the section in which the hyperplane of the focus slice (the middle one) cuts the object, for `state` messages.
/// Reuses memory between calls. Only one thread at a time may use a namer.
class FocusSectionNamer {
  public:
    /// Cuts the focus slice (the middle one) of the picture's object, and returns its two names (see
    /// slicing::SliceAndHullNames). A name is empty if the section has no such name. The names are valid until the
    /// process ends. Takes at most about as long as one slice of a picture.
    slicing::NamedSection name(const scene::PictureRequest& picture);
    /// Returns the names of the focus slice (the middle one) without cutting it. `slices` are the slices of this
    /// picture, which contain the focus slice.
    slicing::NamedSection name(const scene::PictureRequest& picture, const slicing::SliceSet& slices);
    /// Returns whether name() takes less than a millisecond for this object, because the object has few elements, or
    /// because its sections have no names.
    static bool isFast(const slicing::Object& object);

  private:
    slicing::Slicer slicer_;
    slicing::SliceSet slice_;
    slicing::SectionNamer namer_;
};

}  // namespace oval4d::pipeline

#pragma once

#include "scene/picture_request.hpp"
#include "slicing/object.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::pipeline {

/// Names the section in which the hyperplane of the focus slice cuts the object, for `state` messages. Reuses memory
/// between calls. May be used by one thread at a time.
class FocusSectionNamer {
  public:
    /// Cuts the focus slice of the object and names it (see slicing::SectionNamePair). A name is empty if it does not
    /// exist. The names are valid until the process ends. Takes at most about as long as one slice of a picture.
    slicing::NamedSection name(const scene::PictureRequest& picture);
    /// Names the focus slice among `slices`, the slices of this picture, without cutting it again.
    slicing::NamedSection name(const scene::PictureRequest& picture, const slicing::SliceSet& slices);
    /// Returns whether name() takes less than a millisecond: the object has few elements, or its sections have no
    /// names.
    static bool isFast(const slicing::Object& object);

  private:
    slicing::Slicer slicer_;
    slicing::SliceSet slice_;
    slicing::SectionNamer namer_;
};

}  // namespace oval4d::pipeline

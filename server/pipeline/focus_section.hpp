#pragma once

#include "session/session.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::pipeline {

/// Names the section in which a state's focus hyperplane cuts the object, for `state` messages. Reuses memory between
/// calls. May be used by one thread at a time.
class FocusSectionNamer {
  public:
    /// Cuts the focus slice of the object and returns its two names (see slicing::SectionNamePair). A name is empty if
    /// it does not exist. The names are valid until the process ends. Takes at most about as long as one slice of a
    /// picture.
    slicing::SectionNamePair names(const session::State& state);
    /// Returns whether names() takes less than a millisecond: the object has few elements, or its sections have no
    /// names.
    static bool isFast(const session::State& state);

  private:
    slicing::Slicer slicer_;
    slicing::SliceSet slice_;
    slicing::SectionNamer namer_;
};

}  // namespace oval4d::pipeline

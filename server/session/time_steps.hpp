#pragma once
// Appends time steps to an array.

#include "errors/error.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Returns the array `field`, extended at its end along w by the time steps of the array `added`. The time steps of
/// `field` keep their values of w. The added time steps follow at the same distance; at the distance 1 if `field` has
/// only one time step. The initial level and the side of it that is inside are computed again. Errors: `bad_field` if
/// an object is not an array, if the numbers of samples along x, y and z differ, or if `added` lacks the second array
/// that `field` has; `too_large` if the samples exceed `limits.maxFieldBytes`.
Result<slicing::Object> appendTimeSteps(const slicing::Object& field, const slicing::Object& added,
                                        const Limits& limits);

}  // namespace oval4d::session

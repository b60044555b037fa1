#pragma once
// Adds time steps to an array.

#include "errors/error.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Returns `field`, which is an array, extended at the end of w by the time steps of another array, `added`. The time
/// steps of `field` keep their values of w; the added time steps follow at the same distance, or at the distance 1 if
/// `field` has only one time step. The initial level, and which side of it is inside, are computed anew. Errors:
/// `bad_field` if one of the objects is not an array, if the numbers of samples along x, y and z differ, or if `added`
/// lacks the second array that `field` has; `too_large` if the samples exceed `limits.maxFieldBytes`.
Result<slicing::Object> appendTimeSteps(const slicing::Object& field, const slicing::Object& added,
                                        const Limits& limits);

}  // namespace oval4d::session

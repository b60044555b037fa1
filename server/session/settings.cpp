#include "session/settings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "session/cell_types.hpp"
#include "session/object_lookup.hpp"
#include "session/setting_table.hpp"
#include "slicing/visibility.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

// Returns the error for a value outside its range. The message states angles in radians and in degrees.
Error outOfRangeError(std::string_view name, const geometry::NumberRange& range, std::string_view unit, double value) {
    std::string allowed = text::outsideBoundsText(range.least, range.most, unit, value);
    if (unit == kRadians) {
        const auto degrees = [](double radians) {
            return text::roundedDecimal(radians * 180 / std::numbers::pi) + "°";
        };
        allowed.insert(allowed.find(kRadians) + kRadians.size(),
                       " (" + degrees(range.least) + " to " + degrees(range.most) + ")");
        allowed += std::string(kRadians) + " (" + degrees(value) + ")";
    }
    return {ErrorCode::out_of_range, std::string(name) + " must be " + allowed};
}

// Stores `value` in `into`; does nothing if `value` is empty. Error: `out_of_range` if the value is not in `range`. The
// error message contains `name` and `unit`.
Result<std::monostate> storeIfInRange(std::string_view name, std::optional<double> value,
                                      const geometry::NumberRange& range, double& into, std::string_view unit = "") {
    if (!value) return std::monostate{};
    if (!range.contains(*value)) return outOfRangeError(name, range, unit, *value);
    into = *value;
    return std::monostate{};
}

// Changes the frame of reference. Errors: `out_of_range`; the error of changeReferenceFrame().
Result<std::monostate> setReferenceFrame(State& state, const ChangeSettings& set, ObjectLoader& loader) {
    using geometry::ReferenceFrame;
    ReferenceFrame frame = state.referenceFrame;
    if (auto done = storeIfInRange("the pace", set.pace, ReferenceFrame::kPaceRange, frame.pace); !done) return done;
    for (int axis = 0; axis < 3 && set.follow; ++axis) {
        const std::string name = std::string("the velocity to follow along ") + "xyz"[axis];
        if (auto done = storeIfInRange(name, (*set.follow)[axis], ReferenceFrame::kFollowRange, frame.follow[axis]);
            !done)
            return done;
    }
    if (set.boost) {
        const double speed = glm::length(*set.boost);
        if (!(speed <= ReferenceFrame::kMaxBoost)) {
            return Error{ErrorCode::out_of_range,
                         "the speed of a boost must be from 0 to " + text::roundedDecimal(ReferenceFrame::kMaxBoost) +
                             ", where 1 is the speed of light, not " + text::roundedDecimal(speed)};
        }
        frame.boost = *set.boost;
    }
    return changeReferenceFrame(state, frame, loader);
}

Result<std::monostate> setHyperplaneSettings(State& state, const ChangeSettings& set, const Limits& limits) {
    if (set.count) {
        if (*set.count < 1 || *set.count > limits.maxSlices || *set.count % 2 == 0) {
            return Error{ErrorCode::out_of_range, "the number of slices must be odd and from 1 to " +
                                                      std::to_string(limits.maxSlices) + ", not " +
                                                      text::roundedDecimal(*set.count)};
        }
        setSliceCount(state, *set.count);
    }
    const double radius = slicing::infoOf(state.object).circumradius;
    if (auto done = storeIfInRange("the spacing", set.spacing, {kMinSpacing * radius, kMaxSpacing * radius},
                                   state.slices.spacing);
        !done) {
        return done;
    }
    if (set.focus) {
        if (*set.focus < -kMaxFocus || *set.focus > kMaxFocus) {
            return outOfRangeError("the focus", {-double{kMaxFocus}, double{kMaxFocus}}, "", *set.focus);
        }
        state.slices.focus = *set.focus;
    }
    if (set.focus || set.offset || set.focusW || set.focusPoint) state.playing = false;
    const double reach = kMaxOffset * radius;
    const glm::dvec4& origin = slicing::infoOf(state.object).originInFile;
    const auto around = [&](double middle) { return geometry::NumberRange{middle - reach, middle + reach}; };
    if (set.focusPoint) {
        // If `focus`, `offset` or `focusW` is present, the w of the point is neither used nor checked.
        const bool placed = set.focus || set.offset || set.focusW;
        glm::dvec4 point = origin;
        for (int axis = 0; axis < (placed ? 3 : 4); ++axis) {
            const std::string name = std::string("the point's ") + "xyzw"[axis];
            if (auto done = storeIfInRange(name, (*set.focusPoint)[axis], around(origin[axis]), point[axis]); !done)
                return done;
        }
        // Far from the origin of the file, around() rounds its bounds, origin ± reach. A point may then be accepted
        // although its distance from the origin of the object is slightly more than `reach`.
        point = glm::clamp(point - origin, -reach, reach);
        state.look.focusPoint = glm::dvec3(point);
        if (!placed) moveFocusTo(state, point.w);
    }
    if (set.focusW) {
        double w = 0;
        if (auto done = storeIfInRange("w", set.focusW, around(origin.w), w); !done) return done;
        moveFocusTo(state, w - origin.w);
    }
    return storeIfInRange("the offset", set.offset, around(0), state.slices.offset);
}

// Changes the levels, the inside and the fog of a field. Error: `out_of_range`, also if the object is not a field.
Result<std::monostate> setFieldSettings(State& state, const ChangeSettings& set) {
    if (!set.levels && !set.inside && !set.fog) return std::monostate{};
    if (slicing::fieldIn(state.object) == nullptr) {
        return Error{ErrorCode::out_of_range, "the " + slicing::infoOf(state.object).name +
                                                  " is not a field, so it has no levels, no inside and no fog"};
    }
    state.look.field.inside = set.inside.value_or(state.look.field.inside);
    if (set.fog) {
        if (!isValidTransferFunction(*set.fog)) {
            return Error{ErrorCode::out_of_range,
                         "the fog must be off, or " + std::to_string(slicing::kMinFogControlPoints) + " to " +
                             std::to_string(slicing::kMaxFogControlPoints) +
                             " points in the order of their values, which are different numbers from " +
                             text::roundedDecimal(-slicing::kMaxLevel) + " to " +
                             text::roundedDecimal(slicing::kMaxLevel) +
                             ", with opacities from 0 to 1 and, if any, colors from 0 to 16777215"};
        }
        state.look.field.fog = *set.fog;
    }
    if (!set.levels) return std::monostate{};
    std::vector<double> sorted = *set.levels;
    std::ranges::sort(sorted);
    if (sorted.empty() || sorted.size() > slicing::kMaxLevels ||
        !std::ranges::all_of(sorted, [](double level) { return std::abs(level) <= slicing::kMaxLevel; }) ||
        std::ranges::adjacent_find(sorted) != sorted.end()) {
        return Error{ErrorCode::out_of_range,
                     "the levels must be 1 to " + std::to_string(slicing::kMaxLevels) + " different numbers from " +
                         text::roundedDecimal(-slicing::kMaxLevel) + " to " + text::roundedDecimal(slicing::kMaxLevel)};
    }
    state.look.field.levels = *set.levels;
    return std::monostate{};
}

// Sets the settings that are reset on `occasion` back to their values in `initial`. Omits settings that are not stored
// in one member of State, such as `point`.
void resetSettings(State& state, ResetOccasion occasion, const State& initial) {
    forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            if constexpr (std::is_lvalue_reference_v<decltype(setting.ofState(state))>) {
                if (setting.setBack >= occasion) setting.ofState(state) = setting.ofState(initial);
            }
        }
    });
}

}  // namespace

bool isValidTransferFunction(std::span<const slicing::FogControlPoint> points) {
    constexpr std::uint32_t kWhite = 0xffffff;
    if (points.empty()) return true;
    return points.size() >= slicing::kMinFogControlPoints && points.size() <= slicing::kMaxFogControlPoints &&
           std::ranges::all_of(points,
                               [](const slicing::FogControlPoint& point) {
                                   return std::abs(point.value) <= slicing::kMaxLevel && point.opacity >= 0 &&
                                          point.opacity <= 1 && point.color.value_or(0) <= kWhite;
                               }) &&
           std::ranges::adjacent_find(points, std::greater_equal<>(), &slicing::FogControlPoint::value) == points.end();
}

slicing::FieldSettings initialFieldSettings(const fields::Field& field) {
    // Clamp the level. In an array, the initial level lies midway between the least and the greatest sample. One of
    // these may be a huge number that marks missing samples.
    const double level = std::clamp(field.initialLevel, -slicing::kMaxLevel, slicing::kMaxLevel);
    return {{level}, field.initialInside};
}

Result<std::monostate> replaceObject(State& state, slicing::Object source, ObjectLoader& loader) {
    if (source == state.source) return std::monostate{};
    auto image = loader.transformedTo(source, state.referenceFrame);
    if (!image) return image.error();
    slicing::Object object = std::move(*image);
    const double radius = slicing::infoOf(object).circumradius;
    const double spacing =
        state.slices.spacing * (slicing::initialSliceExtent(object) / slicing::initialSliceExtent(state.object));
    state.slices.spacing =
        std::clamp(spacing, kMinSpacing * radius, kMaxSpacing * radius);  // clamped because of rounding errors
    state.ongoingTurnToward.reset();
    state.playing = false;
    const fields::Field* field = slicing::fieldIn(object);
    const fields::Field* const before = slicing::fieldIn(state.source);
    const bool hasSecond = field != nullptr && field->second, hadSecond = before != nullptr && before->second;
    if (hasSecond && !hadSecond) state.look.coloring = scene::Coloring::value;
    if (hadSecond && !hasSecond && state.look.coloring == scene::Coloring::value)
        state.look.coloring = scene::Coloring::cell;
    State initial = initialState();
    if (field != nullptr) initial.look.field = initialFieldSettings(*field);
    resetSettings(state, ResetOccasion::by_another_object, initial);
    state.look.focusPoint = initial.look.focusPoint;  // resetSettings() has omitted the setting `point`
    state.source = std::move(source);
    state.object = std::move(object);
    return std::monostate{};
}

void carryOverFieldSettings(const State& before, const LoadObject& load, State& next) {
    const fields::Field* const field = slicing::fieldIn(before.source);
    if (field == nullptr || !field->source || field->name != load.name || slicing::fieldIn(next.source) == nullptr)
        return;
    const fields::FieldFileSource& source = *field->source;
    if (source.dataName != load.dataName || source.format != load.format || source.axes != load.axes ||
        source.variable != load.variable || source.secondFormula != load.secondFormula ||
        source.secondVariable != load.secondVariable)
        return;
    std::vector<double> initial = std::move(next.look.field.levels);
    next.look.field = before.look.field;
    if (before.look.field.levels == initialFieldSettings(*field).levels) next.look.field.levels = std::move(initial);
    if (slicing::infoOf(before.object).cellTypes == slicing::infoOf(next.object).cellTypes)
        next.look.cellTypes = before.look.cellTypes;
}

void returnToInitialOrientation(State& state) {
    state.orientation = {};
    state.turning = state.playing = false;
    state.ongoingTurnToward.reset();
}

void resetOrientationAndFocus(State& state) {
    returnToInitialOrientation(state);
    resetSettings(state, ResetOccasion::by_reset_or_another_object, initialState());
}

bool slicesSpanObject(const State& state) {
    constexpr double kSame = 1e-9;
    const double spanning = spanningSpacing(state.object, state.slices.count);
    return std::abs(state.slices.spacing - spanning) <= kSame * spanning;
}

Result<std::monostate> changeReferenceFrame(State& state, const geometry::ReferenceFrame& frame, ObjectLoader& loader) {
    if (frame == state.referenceFrame) return std::monostate{};
    auto image = loader.transformedTo(state.source, frame);
    if (!image) return image.error();
    const bool spans = slicesSpanObject(state);
    const double w = state.focusW();
    state.referenceFrame = frame;
    state.object = std::move(*image);
    state.ongoingTurnToward.reset();
    const double radius = slicing::infoOf(state.object).circumradius, reach = kMaxOffset * radius;
    state.look.focusPoint = glm::clamp(state.look.focusPoint, glm::dvec3(-reach), glm::dvec3(reach));
    if (spans) {
        // The box of a field may be so thin along w that spanningSpacing() is below the minimum.
        state.slices.spacing =
            std::clamp(spanningSpacing(state.object, state.slices.count), kMinSpacing * radius, kMaxSpacing * radius);
        moveFocusTo(state, std::clamp(w, -reach, reach));
    } else {
        state.slices.spacing = std::clamp(state.slices.spacing, kMinSpacing * radius, kMaxSpacing * radius);
        state.slices.offset = std::clamp(state.slices.offset, -reach, reach);
    }
    return std::monostate{};
}

void setSliceCount(State& state, int count) {
    if (count > 1 && state.slices.count > 1) {
        const double spacing = state.slices.spacing * (state.slices.count - 1) / (count - 1);
        const double radius = slicing::infoOf(state.object).circumradius;
        state.slices.spacing = std::clamp(spacing, kMinSpacing * radius, kMaxSpacing * radius);
    }
    state.slices.count = count;
}

Result<std::monostate> applySet(State& state, const ChangeSettings& set, const LoadedObjects& loaded,
                                const Limits& limits, ObjectLoader& loader) {
    if (set.object) {
        auto object = findObject(*set.object, loaded, limits, loader);
        if (!object) return object.error();
        if (auto done = replaceObject(state, std::move(*object), loader); !done) return done;
    }
    if (auto done = setReferenceFrame(state, set, loader); !done) return done;
    if (set.orientation && *set.orientation != state.orientation.matrix()) {
        const auto orientation = geometry::Rotation::fromMatrix(*set.orientation);
        if (!orientation) {
            return Error{ErrorCode::not_a_rotation,
                         "the orientation must be an orthogonal 4×4 matrix with determinant 1, to within 1e-6"};
        }
        state.orientation = *orientation;
        state.ongoingTurnToward.reset();
    }
    if (set.lastTurn) {
        if (auto valid = checkTurn(*set.lastTurn); !valid) return valid;
        state.lastTurn = set.lastTurn;
    }
    if (auto done = setHyperplaneSettings(state, set, limits); !done) return done;
    Result<std::monostate> plain = std::monostate{};
    forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kHasRange) {
            const NumberRangeRule& rule = setting.rule;
            if (plain)
                plain = storeIfInRange(rule.what, setting.ofSet(set), rule.range, setting.ofState(state), rule.unit);
        } else if constexpr (!Row::kIsCheckedByApplySet) {
            setting.ofState(state) = setting.ofSet(set).value_or(setting.ofState(state));
        }
    });
    if (!plain) return plain;
    if (auto done = applyCellTypeVisibility(state, set); !done) return done;
    if (auto done = setFieldSettings(state, set); !done) return done;
    if (set.highlight) {
        if (*set.highlight) {
            if (auto valid = checkElement(state.object, **set.highlight); !valid) return valid;
        }
        state.look.highlight = *set.highlight;
    }
    state.playing = set.playing.value_or(state.playing);
    state.turning = set.turning.value_or(state.turning);
    if (set.turning) state.ongoingTurnToward.reset();
    if (state.turning && !state.lastTurn) {
        return Error{ErrorCode::nothing_to_undo, "nothing to repeat: no rotation has been made yet"};
    }
    return std::monostate{};
}

ChangeSettings settingsOf(const State& state) {
    ChangeSettings set;
    forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            if (!setting.forFields || slicing::fieldIn(state.object) != nullptr)
                setting.ofSet(set) = setting.ofState(state);
        }
    });
    return set;
}

Result<std::monostate> checkTurn(const geometry::RotationAngles& turn) {
    for (const geometry::Plane plane : turn.planes()) {
        const double angle = *turn[plane];
        if (!(std::abs(angle) <= kMaxAngle)) {
            return outOfRangeError("an angle", {-kMaxAngle, kMaxAngle}, kRadians, angle);
        }
    }
    return std::monostate{};
}

Result<std::monostate> checkElement(const slicing::Object& object, const slicing::Element& element) {
    const std::size_t count = slicing::elementCount(object, element.kind);
    if (element.index < count) return std::monostate{};
    const std::string kind(text::nameOf(slicing::kElementKinds, element.kind));
    const std::string& name = slicing::infoOf(object).name;
    if (count == 0) return Error{ErrorCode::out_of_range, "the " + name + " has no " + kind};
    return Error{ErrorCode::out_of_range, "the number of the " + kind + " must be from 0 to " +
                                              std::to_string(count - 1) + " for the " + name + ", not " +
                                              std::to_string(element.index)};
}

void rotate(State& state, const geometry::RotationAngles& turn) {
    state.orientation = geometry::Rotation(turn) * state.orientation;
    state.lastTurn = turn;
    state.ongoingTurnToward.reset();
}

Result<std::monostate> turnToward(State& state, const TurnToward& command) {
    slicing::Element element{command.element, command.number.value_or(0)};
    if (auto valid = checkElement(state.object, element); !valid) return valid;
    if (!command.number) {
        const auto& lit = state.look.highlight;
        element = slicing::elementToTurnTo(state.object, command.element, state.orientation, lit).value_or(element);
    }
    const geometry::Rotation way = slicing::rotationToW(state.object, element, state.orientation);
    const geometry::Rotation goal = way * state.orientation;
    state.turning = false;
    state.ongoingTurnToward.reset();
    constexpr double kRadiansPerSecond = std::numbers::pi / 2;
    const double seconds = way.largerAngle() / kRadiansPerSecond;
    constexpr double kShortest = 1e-3;  // in seconds; a shorter turn would not be visible, so it is not animated
    if (command.immediately || seconds < kShortest) {
        state.orientation = goal;
    } else {
        state.ongoingTurnToward = OngoingTurnToward{goal, seconds};
    }
    return std::monostate{};
}

Result<std::monostate> highlightNeighbor(State& state, slicing::ElementKind kind, bool forward) {
    if (auto valid = checkElement(state.object, {kind, 0}); !valid) return valid;
    const std::size_t count = slicing::elementCount(state.object, kind);
    slicing::VisibilityBySource visibilities;
    slicing::findVisibilities(state.object, state.look.cellTypes.hidden, state.look.cellTypes.faded, visibilities);
    const auto isVisible = [&](std::size_t index) {
        return slicing::visibilityOf(state.object, visibilities, {kind, index}) != slicing::Visibility::hidden;
    };
    std::optional<slicing::Element>& highlight = state.look.highlight;
    std::optional<std::size_t> found;
    if (highlight && highlight->kind == kind) {
        const std::size_t step = forward ? 1 : count - 1;  // `count` − 1 steps forward are one step backward
        std::size_t index = highlight->index;
        for (std::size_t i = 0; i < count && !found; ++i) {
            index = (index + step) % count;
            if (isVisible(index)) found = index;
        }
    } else {
        const geometry::Hyperplanes focusSlice{state.slices.focus, 1, state.slices.spacing, state.slices.offset};
        const std::vector<bool> isCut = slicing::elementsCutBy(state.object, kind, state.orientation, focusSlice);
        for (std::size_t index = 0; index < count; ++index) {
            if (!isVisible(index)) continue;
            if (!found) found = index;
            if (!isCut[index]) continue;
            found = index;
            break;
        }
    }
    if (!found) {
        return Error{ErrorCode::out_of_range, "every " + std::string(text::nameOf(slicing::kElementKinds, kind)) +
                                                  " of the " + slicing::infoOf(state.object).name + " is hidden"};
    }
    highlight = slicing::Element{kind, *found};
    return std::monostate{};
}

void moveFocusTo(State& state, double w) {
    const double spacing = state.slices.spacing;
    // If the spacing is very small, w may lie beyond the slice with index kMaxFocus. The offset then covers the rest.
    const double limit = kMaxFocus;
    state.slices.focus = static_cast<int>(std::clamp(std::round(w / spacing), -limit, limit));
    state.slices.offset = w - state.slices.focus * spacing;
}

Result<std::monostate> moveFocusToNextCritical(State& state, bool upward, ObjectLoader& loader) {
    std::optional<double> w;
    if (slicing::fieldIn(state.object) == nullptr) {
        w = slicing::nextVertexHeight(state.object, state.orientation, state.focusW(), upward);
    } else {
        const auto sections = loader.criticalSections(state);
        if (!sections) return sections.error();
        const double same = slicing::kOnPlaneTolerance * slicing::infoOf(state.object).circumradius;
        w = slicing::nextCriticalW(**sections, state.focusW(), upward, same);
    }
    if (w) {
        moveFocusTo(state, *w);
        state.playing = false;
    }
    return std::monostate{};
}

}  // namespace oval4d::session

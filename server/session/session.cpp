#include "session/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string_view>
#include <tuple>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "fields/field.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/command_line.hpp"
#include "session/field_replacement.hpp"
#include "session/history.hpp"
#include "session/keymap.hpp"
#include "session/object_loader.hpp"
#include "session/object_lookup.hpp"
#include "session/query.hpp"
#include "session/setting_text.hpp"
#include "session/settings.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

using VoidResult = Result<std::monostate>;

// Combines the rotations of an undo step into one turn, from the state `before` the step to `next`. `current` is the
// state before the newest rotation, which is `next.lastTurn`. Returns `before.lastTurn` if the rotations cancel out.
std::optional<geometry::RotationAngles> turnOfStep(const State& before, const State& current, const State& next) {
    constexpr double kSame = 1e-9;
    const geometry::Rotation whole = next.orientation * before.orientation.inverse();
    if (whole.largerAngle() < kSame) return before.lastTurn;
    if (current.lastTurn && next.lastTurn) {
        // Turns in the same planes add up, even beyond half a turn.
        const geometry::RotationAngles sum = *current.lastTurn + *next.lastTurn;
        if (checkTurn(sum) && (geometry::Rotation(sum) * whole.inverse()).largerAngle() < kSame) return sum;
    }
    return whole.smallestAngles();
}

// Moves the focus to and fro along w for `seconds` seconds. State::playing must be true.
void advancePlayback(State& state, double seconds) {
    const auto [least, most] = slicing::rangeOfW(state.object, state.orientation);
    const double distance = state.playSpeed * seconds * (most - least) / kSecondsFromEndToEnd;
    const double w = state.focusW() + (state.playsDownward ? -distance : distance);
    moveFocusTo(state, std::clamp(w, least, most));
    if (w >= most) {
        state.playsDownward = true;
    } else if (w <= least) {
        state.playsDownward = false;
    }
}

// Returns whether a query parameter describes the connection or the size of a picture, and not the view.
bool isConnectionParameter(std::string_view name) { return name == "token" || name == "width" || name == "height"; }

// Returns a random rotation; all rotations are equally probable. Its two unit quaternions are uniformly distributed (K.
// Shoemake, "Uniform random rotations", Graphics Gems III, 1992). The same seed gives the same rotation.
geometry::Rotation randomRotation(std::optional<std::uint64_t> seed) {
    std::mt19937_64 random(seed ? *seed : std::random_device()());
    // A random number u with 0 ≤ u < 1.
    const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11U), -53); };
    const auto quaternion = [&] {
        const double u = uniform(), a = 2 * std::numbers::pi * uniform(), b = 2 * std::numbers::pi * uniform();
        const double first = std::sqrt(1 - u), second = std::sqrt(u);
        return glm::dquat(first * std::cos(a), first * std::sin(a), second * std::cos(b), second * std::sin(b));
    };
    const glm::dquat left = quaternion();
    return {left, quaternion()};
}

// Computes the outcome of a command that may need an object or critical values of w from the loader. Does not change
// the session.
class CommandOutcomeComputer {
  public:
    CommandOutcomeComputer(const Session& session, const Limits& limits, ObjectLoader& loader)
        : session_(session), limits_(limits), loader_(loader) {}

    Result<CommandOutcome> compute(const KeyBinding& binding) const {
        CommandOutcome outcome{session_.current};
        ActionContext context{outcome.next,  session_.loaded,          limits_,        loader_,
                              binding.plane, binding.isDoubleRotation, binding.inverse};
        if (VoidResult done = binding.action->onState(context); !done) return done.error();
        return outcome;
    }
    Result<CommandOutcome> compute(const ChangeSettings& command) const {
        CommandOutcome outcome{session_.current};
        if (command.formula) {
            outcome.loaded = session_.loaded;
            if (VoidResult done = loadFormula(*command.formula, *outcome.loaded); !done) return done.error();
        }
        const LoadedObjects& loaded = outcome.loaded ? *outcome.loaded : session_.loaded;
        if (VoidResult done = applySet(outcome.next, command, loaded, limits_, loader_); !done) return done.error();
        return outcome;
    }
    // LoadObject::append must be false.
    Result<CommandOutcome> compute(const LoadObject& command) const {
        if (VoidResult room = checkLoadedObjectLimit(session_.loaded, command.name); !room) return room.error();
        const auto reading = loader_.objectFrom(command);
        if (!reading) return reading.error();
        CommandOutcome outcome{session_.current, session_.loaded};
        State& next = outcome.next;
        if (VoidResult done = replaceObject(next, reading->object, loader_); !done) return done.error();
        const State& before = session_.current;
        if (command.continues && slicing::fieldIn(before.object) != nullptr &&
            slicing::fieldIn(next.object) != nullptr) {
            next.look.field = before.look.field;
            if (slicing::infoOf(before.object).circumradius == slicing::infoOf(next.object).circumradius) {
                next.look.focusPoint = before.look.focusPoint;
                next.slices = before.slices;
                next.playing = before.playing;
            }
        } else {
            carryOverFieldSettings(before, command, next);
        }
        outcome.loaded->insert_or_assign(command.name, reading->object);
        return outcome;
    }
    Result<CommandOutcome> compute(const ShowLinkedView& command) const {
        auto query = parseQuery(command.query);
        if (!query) {
            return Error{ErrorCode::bad_expression,
                         "in the query of an address, two hexadecimal digits must follow each %, as in 5%25"};
        }
        std::erase_if(*query, [](const auto& parameter) { return isConnectionParameter(parameter.first); });
        const auto has = [&](std::string_view name) {
            return std::ranges::find(*query, name, &QueryParameters::value_type::first) != query->end();
        };
        State start = session_.current;
        // The rotations in an address start from the initial orientation.
        if (has("rotate") || has(kPolytope) || has(kField) || has(kFormula)) returnToInitialOrientation(start);
        auto next = stateFromQuery(*query, limits_, loader_, std::move(start));
        if (!next) return next.error();
        CommandOutcome outcome{std::move(*next)};
        const auto formula = std::ranges::find(*query, kFormula, &QueryParameters::value_type::first);
        if (formula != query->end()) {
            if (VoidResult room = checkLoadedObjectLimit(session_.loaded, formula->first); !room) return room.error();
            outcome.loaded = session_.loaded;
            outcome.loaded->insert_or_assign(formula->first, outcome.next.source);
        }
        return outcome;
    }

    // Returns the loaded array `command.name`, extended by the time steps in the file of `command`.
    Result<slicing::Object> extendedField(const LoadObject& command) const {
        const auto loaded = session_.loaded.find(command.name);
        if (loaded == session_.loaded.end())
            return Error{ErrorCode::not_found, "no field called " + text::inQuotes(command.name) + " is loaded"};
        const auto added = loader_.objectFrom(command);
        if (!added) return added.error();
        return loader_.fieldWithTimeSteps(loaded->second, added->object);
    }

  private:
    VoidResult checkLoadedObjectLimit(const LoadedObjects& loaded, const std::string& name) const {
        if (loaded.size() < limits_.maxLoaded || loaded.contains(name)) return std::monostate{};
        return Error{ErrorCode::too_many, "a session holds at most " + std::to_string(limits_.maxLoaded) +
                                              " loaded objects; load under a name that is in use to replace one"};
    }

    // Adds the field of a formula to `loaded`, unless `loaded` or the example fields have the same field with this
    // name.
    VoidResult loadFormula(const LoadObject& load, LoadedObjects& loaded) const {
        if (const auto present = findLoadedOrExample(load.name, loaded)) {
            const fields::Field* const field = slicing::fieldIn(*present);
            const std::string second = field != nullptr && field->second ? field->second->formula : "";
            if (field != nullptr && field->formula == load.data && second == load.secondFormula &&
                field->box == load.box)
                return std::monostate{};
        }
        if (VoidResult room = checkLoadedObjectLimit(loaded, load.name); !room) return room;
        const auto reading = loader_.objectFrom(load);
        if (!reading) return reading.error();
        loaded.insert_or_assign(load.name, reading->object);
        return std::monostate{};
    }

    const Session& session_;
    const Limits& limits_;
    ObjectLoader& loader_;
};

// A visitor that applies commands to a session. Changes a copy of the state, and stores the copy only on success.
class CommandApplier {
  public:
    // `computed` is the outcome of the command if needsLoading() has computed it, else empty.
    CommandApplier(Session& session, const Limits& limits, ObjectLoader& loader, ComputedOutcome computed)
        : session_(session), limits_(limits), outcome_(session, limits, loader), computed_(std::move(computed)) {}

    VoidResult operator()(const KeyPress& key) {
        std::string pending = session_.pendingKey;
        const auto binding = bindingOf(key, pending);
        if (!binding) return binding.error();
        session_.pendingKey = std::move(pending);  // a failed action ends the sequence of keys, too
        return *binding ? runKeyAction(**binding) : VoidResult(std::monostate{});
    }
    VoidResult operator()(const Rotate& command) {
        if (VoidResult valid = checkTurn(command.turn); !valid) return valid;
        State next = session_.current;
        rotate(next, command.turn);
        const State* const before = command.continues ? stateBeforeAmendableStep(session_) : nullptr;
        // During continuous turning, the orientation also changes between the commands of a step. turnOfStep() cannot
        // be used then, because it compares orientations.
        if (before != nullptr && !next.turning) next.lastTurn = turnOfStep(*before, session_.current, next);
        (command.continues ? amendUndoStep : commitUndoStep)(session_, std::move(next), limits_);
        return std::monostate{};
    }
    VoidResult operator()(const TurnToward& command) {
        State next = session_.current;
        if (VoidResult done = turnToward(next, command); !done) return done;
        commitUndoStep(session_, std::move(next), limits_);
        return std::monostate{};
    }
    VoidResult operator()(const TurnAtRandom& command) {
        State next = session_.current;
        next.orientation = randomRotation(command.seed);
        next.ongoingTurnToward.reset();
        commitUndoStep(session_, std::move(next), limits_);
        return std::monostate{};
    }
    VoidResult operator()(const ChangeSettings& command) { return storeOutcome(outcomeOf(command), command.continues); }
    VoidResult operator()(const LoadObject& command) {
        return command.append ? append(command) : storeOutcome(outcomeOf(command), command.continues);
    }
    VoidResult operator()(const Undo& /*command*/) { return undo(session_); }
    VoidResult operator()(const Redo& /*command*/) { return redo(session_); }
    VoidResult operator()(const ResetOrientationAndFocus& /*command*/) {
        State next = session_.current;
        resetOrientationAndFocus(next);
        commitUndoStep(session_, std::move(next), limits_);
        return std::monostate{};
    }
    VoidResult operator()(const CommandLine& command) {
        const auto parsed = parseCommandLine(command.line, session_.current);
        if (!parsed) return parsed.error();
        return std::visit(*this, *parsed);
    }
    VoidResult operator()(const ShowLinkedView& command) { return storeOutcome(outcomeOf(command), false); }

  private:
    Result<CommandOutcome> outcomeOf(const auto& command) {
        return computed_ ? std::move(*computed_) : outcome_.compute(command);
    }

    // Stores the outcome of a command in the session, or returns its error. `continues` says whether undo treats the
    // command and the previous command as one step.
    VoidResult storeOutcome(Result<CommandOutcome> outcome, bool continues) {
        if (!outcome) return outcome.error();
        if (outcome->loaded) session_.loaded = std::move(*outcome->loaded);
        (continues ? amendUndoStep : commitUndoStep)(session_, std::move(outcome->next), limits_);
        return std::monostate{};
    }

    // Appends time steps to a loaded array. Undo does not remove them: all states of the history get the longer array,
    // so that only one array is in memory.
    VoidResult append(const LoadObject& command) {
        const auto extended = outcome_.extendedField(command);
        if (!extended) return extended.error();
        const slicing::Object before = session_.loaded.at(command.name);
        replaceField(session_, before, *extended, FieldReplacementKind::longer);
        return std::monostate{};
    }

    VoidResult runKeyAction(const KeyBinding& binding) {
        if (binding.action->onSession != nullptr) return binding.action->onSession(session_);
        return storeOutcome(outcomeOf(binding), false);
    }

    Session& session_;
    const Limits& limits_;
    const CommandOutcomeComputer outcome_;
    ComputedOutcome computed_;
};

// A visitor that computes the outcome of a command, so that the loader notes what the command needs. Returns an empty
// outcome for commands that need nothing from the loader, and for appended time steps.
class CommandNeedsFinder {
  public:
    CommandNeedsFinder(const Session& session, const Limits& limits, ObjectLoader& loader)
        : session_(session), outcome_(session, limits, loader) {}

    ComputedOutcome operator()(const KeyPress& key) const {
        std::string pending = session_.pendingKey;
        const auto binding = bindingOf(key, pending);
        if (!binding || !*binding || !(*binding)->action->mayNeedLoading) return {};
        return outcome_.compute(**binding);
    }
    ComputedOutcome operator()(const ChangeSettings& command) const {
        // A formula needs nothing from the loader, because its field is made at once.
        if (!command.object && !command.pace && !command.follow && !command.boost) return {};
        return outcome_.compute(command);
    }
    ComputedOutcome operator()(const LoadObject& command) const {
        if (!command.append) return outcome_.compute(command);
        static_cast<void>(outcome_.extendedField(command));
        return {};
    }
    ComputedOutcome operator()(const CommandLine& command) const {
        const auto parsed = parseCommandLine(command.line, session_.current);
        return parsed ? std::visit(*this, *parsed) : ComputedOutcome();
    }
    ComputedOutcome operator()(const ShowLinkedView& command) const { return outcome_.compute(command); }
    ComputedOutcome operator()(const Rotate& /*command*/) const { return {}; }
    ComputedOutcome operator()(const TurnToward& /*command*/) const { return {}; }
    ComputedOutcome operator()(const TurnAtRandom& /*command*/) const { return {}; }
    ComputedOutcome operator()(const Undo& /*command*/) const { return {}; }
    ComputedOutcome operator()(const Redo& /*command*/) const { return {}; }
    ComputedOutcome operator()(const ResetOrientationAndFocus& /*command*/) const { return {}; }

  private:
    const Session& session_;
    const CommandOutcomeComputer outcome_;
};

}  // namespace

geometry::Hyperplanes State::hyperplanes() const {
    return {slices.focus - (slices.count - 1) / 2, slices.count, slices.spacing, slices.offset};
}

State initialState() {
    constexpr double kAngle = std::numbers::pi / 36;
    State state;
    state.source = state.object = polytopes::fiveCell();
    state.alpha = state.beta = kAngle;
    state.step = std::numbers::pi / 180;
    state.slices.spacing = spanningSpacing(state.object, state.slices.count);
    return state;
}

double spanningSpacing(const slicing::Object& object, int count) {
    const double reach = slicing::initialSliceExtent(object);
    return count > 1 ? 2 * reach / (count - 1) : reach;
}

bool needsLoading(const Session& session, const Command& command, const Limits& limits, ObjectLoader& loader,
                  ComputedOutcome& outcome) {
    outcome = std::visit(CommandNeedsFinder(session, limits, loader), command);
    if (loader.isPending()) outcome.reset();  // `outcome` has only the error that something is missing
    return loader.isPending();
}

VoidResult apply(Session& session, const Command& command, const Limits& limits, ObjectLoader& loader,
                 ComputedOutcome outcome) {
    return std::visit(CommandApplier(session, limits, loader, std::move(outcome)), command);
}

std::size_t historyMemoryWithoutObjects(const Session& session) {
    return sizeof(State) * (session.undoSteps.size() + session.redoSteps.size());
}

std::size_t unsharedMemory(const slicing::Object& object) {
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    const fields::Field* const field = slicing::fieldIn(object);
    const bool shared =
        (info.rebuildableFromName && polytopes::findEntry(info.name) != nullptr) || (field != nullptr && field->shared);
    return shared ? 0 : slicing::memoryOf(object);
}

std::size_t unsharedMemoryOfObjects(const Session& session) {
    std::map<const void*, const slicing::Object*> objects;
    const auto add = [&](const slicing::Object& object) { objects.try_emplace(slicing::identityOf(object), &object); };
    auto addAll = [&, last = static_cast<const State*>(nullptr)](const State& state) mutable {
        const State* previous = std::exchange(last, &state);
        // Most states have the same objects as the previous state. Skip them, because they have been added already.
        if (previous != nullptr && previous->object == state.object && previous->source == state.source) return;
        for (const slicing::Object* object : state.sourceAndObject()) add(*object);
    };
    addAll(session.current);
    for (const auto& [name, object] : session.loaded) add(object);
    for (const State& state : session.undoSteps) addAll(state);
    for (const State& state : session.redoSteps) addAll(state);
    std::size_t bytes = 0;
    for (const auto& [identity, object] : objects) bytes += unsharedMemory(*object);
    return bytes;
}

void advanceMotionBy(Session& session, double seconds) {
    State& state = session.current;
    const auto moving = [&state] {
        return std::tuple(state.orientation, state.ongoingTurnToward, state.slices, state.playsDownward);
    };
    const auto before = moving();
    if (state.ongoingTurnToward) {
        auto& [goal, left] = *state.ongoingTurnToward;
        if (seconds < left) {
            const geometry::Rotation way = goal * state.orientation.inverse();
            state.orientation = way.power(seconds / left) * state.orientation;
            left -= seconds;
        } else {
            state.orientation = goal;
            state.ongoingTurnToward.reset();
        }
    } else if (state.turning && state.lastTurn) {
        state.orientation =
            geometry::Rotation(state.lastTurn->scaled(kRotationRepeatsPerSecond * seconds)) * state.orientation;
    }
    if (state.playing) advancePlayback(state, seconds);
    if (before != moving()) ++session.revision;
}

}  // namespace oval4d::session

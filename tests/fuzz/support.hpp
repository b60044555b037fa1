#pragma once
// Helpers that the fuzzers share. They check invariants of sessions, and execute only commands that build no large
// polytopes.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/command_line.hpp"
#include "session/history.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "session/setting_table.hpp"
#include "session/settings.hpp"
#include "slicing/slicer.hpp"
#include "wire/messages.hpp"
#include "wire/parse.hpp"
#include "wire/state_message.hpp"

/// Begins the definition of a fuzzer: a function of `data` and `size`, the bytes of the input, that returns 0. For
/// libFuzzer, the function has the name that libFuzzer requires; for corpus_tests.cpp, it is named after its subject.
#ifdef OVAL4D_CORPUS_TESTS
#define OVAL4D_FUZZER(subject)                                      \
    int fuzz_##subject(const std::uint8_t* data, std::size_t size); \
    int fuzz_##subject(const std::uint8_t* data, std::size_t size)
#else
#define OVAL4D_FUZZER(subject)                                      \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, \
                                          std::size_t size)  // NOLINT(readability-identifier-naming)
#endif

namespace oval4d::fuzz {

/// Reports a fault that an input has found, and does not return. In a fuzzer, prints `message` and aborts the process;
/// libFuzzer reports this as a crash. In corpus_tests, makes the test of this input fail and throws an exception.
#ifdef OVAL4D_CORPUS_TESTS
[[noreturn]] void reportFault(const std::string& message);
#else
[[noreturn]] inline void reportFault(const std::string& message) {
    std::fprintf(stderr, "broken: %s\n", message.c_str());
    std::abort();
}
#endif

/// If `holds` is false, reports a fault with the message `what` followed by `detail`.
inline void require(bool holds, std::string_view what, std::string_view detail = {}) {
    if (!holds) reportFault(std::string(what) + (detail.empty() ? "" : " ") + std::string(detail));
}

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Removes and returns the text before the first `separator`, and also removes the separator. Without a separator,
/// removes and returns the whole text.
inline std::string_view takeUntil(std::string_view& text, char separator) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view head = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return head;
}

/// Small limits, with which each input takes only milliseconds.
inline const session::Limits kLimits{
    .maxSlices = 31, .maxUndo = 4, .maxLoaded = 2, .maxVertices = 120, .maxHullCells = 500};

/// Returns the cache of polytopes that all parts of the fuzzer use.
inline polytopes::PolytopeCache& cache() {
    static polytopes::PolytopeCache kCache;
    return kCache;
}

/// Returns whether a command with this polytope name runs fast. It does if polytopes::designNamed() refuses the name,
/// or if the polytope has at most kLimits.maxVertices vertices.
inline bool isSmall(std::string_view name) {
    const auto named = polytopes::designNamed(name, kLimits.maxVertices);
    const auto* design = std::get_if<polytopes::PolytopeDesign>(&named);
    return design == nullptr || polytopes::elementCounts(*design).vertices <= kLimits.maxVertices;
}

/// Returns the name of the object that a command selects; an empty string if it selects none.
inline std::string polytopeIn(const session::Command& command, const session::State& state) {
    if (const auto* line = std::get_if<session::CommandLine>(&command)) {
        const auto parsed = session::parseCommandLine(line->line, state);
        return parsed ? polytopeIn(*parsed, state) : "";
    }
    const auto* set = std::get_if<session::ChangeSettings>(&command);
    return set ? set->object.value_or("") : "";
}

/// Requires that a state meets the invariants of all states that clients can produce.
inline void requireSound(const session::State& state, const session::Limits& limits) {
    const auto within = [](double value, double most) { return std::abs(value) <= most; };
    require(slicing::identityOf(state.object) != nullptr, "a state has an object");
    const geometry::ObjectInfo& info = slicing::infoOf(state.object);
    using geometry::ReferenceFrame;
    const auto& [pace, follow, boost] = state.referenceFrame;
    require(ReferenceFrame::kPaceRange.contains(pace), "the pace is within its bounds");
    for (int axis = 0; axis < 3; ++axis)
        require(ReferenceFrame::kFollowRange.contains(follow[axis]), "the velocity is bounded");
    require(glm::length(boost) <= ReferenceFrame::kMaxBoost, "an observer is slower than light");
    require((state.object == state.source) == (state.referenceFrame == ReferenceFrame{}),
            "the default frame shows the object itself");
    require(slicing::elementCounts(state.object) == slicing::elementCounts(state.source), "an image has all elements");
    require(std::isfinite(info.circumradius) && info.circumradius > 0, "an image has an extent");
    const glm::dmat4 matrix = state.orientation.matrix();
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j)
            require(within(glm::dot(matrix[i], matrix[j]) - (i == j ? 1 : 0), 1e-9), "the orientation is orthogonal");
    }
    require(glm::determinant(matrix) > 0, "the orientation does not reflect");
    session::forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kHasRange) {
            const double value = setting.ofState(state);
            const bool isStoredStep =
                setting.name.text == "step" && value > 0 && value < session::State::kStepRange.least;
            require(setting.rule.range.contains(value) || isStoredStep, "a number is in its range:", setting.name.text);
        }
    });
    const auto& [count, spacing, focus, offset] = state.slices;
    require(count >= 1 && count <= limits.maxSlices && count % 2 == 1, "the number of slices is odd and allowed");
    require(within(focus, session::kMaxFocus), "the focus is within its bounds");
    const double ratio = spacing / info.circumradius;
    require(ratio >= session::kMinSpacing * (1 - 1e-9) && ratio <= session::kMaxSpacing * (1 + 1e-9),
            "the spacing is within its bounds");
    require(within(offset / info.circumradius, session::kMaxOffset * (1 + 1e-9)), "the offset is within its bounds");
    if (state.ongoingTurnToward) {
        require(!state.turning, "an object does not turn continuously and toward an element");
        const double seconds = state.ongoingTurnToward->seconds;
        require(seconds > 0 && seconds <= session::OngoingTurnToward::kMaxSeconds,
                "a turn toward an element ends within its bound");
    }
    require(session::isValidTransferFunction(state.look.field.fog), "the fog is a transfer function");
    require(slicing::fieldIn(state.object) != nullptr || state.look.field.fog.empty(), "only fields have fog");
    for (int axis = 0; axis < 3; ++axis)
        require(within(state.look.focusPoint[axis] / info.circumradius, session::kMaxOffset * (1 + 1e-9)),
                "the focus point is within its bounds");
    if (const auto& element = state.look.highlight)
        require(element->index < slicing::elementCount(state.object, element->kind), "what is highlighted exists");
    const auto& [hidden, faded] = state.look.cellTypes;
    std::vector<std::uint32_t> both = hidden;
    both.insert(both.end(), faded.begin(), faded.end());
    for (const auto* types : {&hidden, &faded})
        require(std::is_sorted(types->begin(), types->end()), "cell types are in order");
    std::sort(both.begin(), both.end());
    require(std::adjacent_find(both.begin(), both.end()) == both.end(), "a cell type is listed once");
    require(both.empty() || both.back() < info.cellTypes.size(), "cell types are the object's");
    require(!state.turning || state.lastTurn, "what turns has a rotation to turn with");
    if (state.lastTurn) {
        require(!state.lastTurn->planes().empty(), "a rotation has a plane");
        for (const geometry::Plane plane : geometry::kPlanes) {
            require(within((*state.lastTurn)[plane].value_or(0), session::kMaxAngle),
                    "the last rotation is within its bounds");
        }
    }
}

inline void requireSound(const session::Session& session, const session::Limits& limits) {
    requireSound(session.current, limits);
    for (const session::State& state : session.undoSteps) requireSound(state, limits);
    for (const session::State& state : session.redoSteps) requireSound(state, limits);
    require(session.undoSteps.size() <= limits.maxUndo, "no more than maxUndo steps are kept");
    require(session.loaded.size() <= limits.maxLoaded, "no more than maxLoaded objects are kept");
}

/// Parses a message and returns it. Requires that the message is a JSON object, and therefore valid UTF-8.
inline nlohmann::json requireJson(const std::string& text) {
    auto message = nlohmann::json::parse(text, nullptr, false);
    require(!message.is_discarded() && message.is_object(), "a message is a JSON object:", text);
    return message;
}

inline void requireSentence(const Error& error) {
    require(!error.message.empty(), "an error says what is wrong");
    require(error.message.size() < 4096, "an error is a sentence:", error.message);
    require(requireJson(wire::errorMessage(error, {})).at("message") == error.message, "an error travels whole");
}

/// Executes a command as the server does. Requires that the session then meets its invariants; after an error, that it
/// is unchanged. If the command must first load an object, executes it only if the object is small.
inline void execute(session::Session& session, const session::Command& command) {
    const session::Session before = session;
    const bool small =
        isSmall(polytopeIn(command, session.current)) && !std::holds_alternative<session::KeyPress>(command);
    session::ObjectLoader loader(kLimits, cache(), session::ObjectLoader::LoadingMode::deferred, session::readObject);
    session::ComputedOutcome outcome;
    for (int orders = 0; session::needsLoading(session, command, kLimits, loader, outcome); ++orders) {
        require(session == before, "what is not ready yet changes nothing");
        if (!small) return;
        require(orders < 3, "a command orders at most a file, the array to which it is added, and images");
        loader.completePending();
    }
    const auto done = session::apply(session, command, kLimits, loader, std::move(outcome));
    require(!loader.isPending(), "a command needs nothing that was not found before");
    if (!done) {
        requireSentence(done.error());
        session::Session expected = before;
        // A refused key also ends a key sequence that has begun.
        if (std::holds_alternative<session::KeyPress>(command) && session.pendingKey.empty())
            expected.pendingKey.clear();
        require(session == expected, "an error leaves the session as it was:", done.error().message);
    } else {
        requireSound(session, kLimits);
        require(session.current == before.current || session.revision == before.revision + 1, "a change counts once");
        require(session.revision == before.revision || session.current != before.current,
                "what changes nothing is not counted");
    }
}

/// Requires that undo leads through the whole history of a session, and redo leads back. Each step must be one change.
inline void requireHistory(session::Session session) {
    const session::State last = session.current;
    const auto move = [&](Result<std::monostate> (*toNext)(session::Session&)) {
        const session::State before = session.current;
        const std::uint64_t revision = session.revision;
        const bool moved = static_cast<bool>(toNext(session));
        require(moved == (session.current != before), "a step of the history changes something");
        require(session.revision == revision + (moved ? 1 : 0), "a step of the history counts once");
        return moved;
    };
    std::size_t undone = 0;
    while (move(session::undo)) ++undone;
    for (; undone > 0; --undone) require(move(session::redo), "what was undone can be redone");
    require(session.current == last, "redo leads back to the state before undo");
}

/// Requires that a state survives a message: encoding the state, and setting another session to the message, must give
/// an equal state.
inline void requireRoundTrip(const session::State& state, const session::LoadedObjects& loaded) {
    const std::string text = wire::stateMessage(state, {}, 7, 3);
    requireJson(text);
    const auto set = wire::setCommandFromState(text);
    require(static_cast<bool>(set), "a state message is read back:", set ? "" : set.error().message + " " + text);
    const std::string& name = slicing::infoOf(state.object).name;
    require(set->object == name, "an object's name travels whole");
    session::Session other;
    other.loaded = loaded;
    // The name of a loaded polytope does not find it if it was replaced or belongs to another session.
    const auto own = loaded.find(name);
    const bool named = own != loaded.end() ? own->second == state.source : isSmall(name);
    if (!named) return;
    session::ObjectLoader loader(kLimits, cache());
    const auto done = session::apply(other, *set, kLimits, loader);
    require(static_cast<bool>(done), "a state can be brought about again:", done ? "" : done.error().message);
    for (int i = 0; i < 4; ++i) {
        require(glm::length(other.current.orientation.matrix()[i] - state.orientation.matrix()[i]) < 1e-9,
                "the orientation survives");
    }
    other.current.orientation = state.orientation;
    require(other.current.source == state.source && other.current.referenceFrame == state.referenceFrame,
            "an object and its frame of reference survive");
    other.current.object = state.object;  // an equal image, which was made again
    if (!state.lastTurn) other.current.lastTurn.reset();
    other.current.playsDownward = state.playsDownward;  // a message does not contain this
    require(other.current == state, "a state survives:", text);
}

/// Slices the object of a state as for a picture, with at most 51 slices. Requires that all indices are in range.
inline void requireSlices(const session::State& state) {
    static slicing::Slicer slicer;
    static slicing::SliceSet slices;
    geometry::Hyperplanes planes = state.hyperplanes();
    planes.count = std::min(planes.count, 51);
    slicer.sliceWithoutSurfaces(state.object, state.orientation, planes, slices);
    for (int i = 0; i < planes.count; ++i) {
        const auto vertices = slices.vertexBegin[i + 1] - slices.vertexBegin[i];
        for (auto e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e)
            for (const std::uint32_t end : slices.edges[e]) require(end < vertices, "an edge ends at vertices");
        for (auto c = slices.cornerBegin[slices.faceBegin[i]]; c < slices.cornerBegin[slices.faceBegin[i + 1]]; ++c)
            require(slices.corners[c] < vertices, "a face has vertices for corners");
    }
}

}  // namespace oval4d::fuzz

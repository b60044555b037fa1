#include "store/codec.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "geometry/catalogue.hpp"

// Sessions are CBOR arrays, [version, …]; a state is an array too, and its polytope a number into the session's list of
// polytopes. The structured bindings name every member of what they take apart: with a new one they do not compile.

namespace oval4d::store {

using geometry::Polytope;
using nlohmann::json;
using session::PolytopePtr;
using session::Session;
using session::State;

namespace {

constexpr int kVersion = 1;

// Bounds of what is read, far beyond what a server allows: a damaged record is an error, not a picture of a million
// slices.
constexpr int kMostSlices = 100'001;
constexpr double kFarthest = 1e12;
constexpr std::size_t kMostVertices = 1'000'000;

[[noreturn]] void refuse(const std::string& what) { throw Unreadable(what); }

std::string bytesOf(const json& value) {
    std::string bytes;
    json::to_cbor(value, bytes);
    return bytes;
}

/// `read`, with the library's complaints as our own.
template <typename Read>
auto reading(Read read) {
    try {
        return read();
    } catch (const json::exception& fault) {
        refuse(fault.what());
    }
}

json parsed(std::string_view bytes) {
    json value = json::from_cbor(bytes);
    if (!value.is_array() || value.empty()) refuse("it is not a record of a session");
    if (value.at(0) != kVersion) {
        refuse("it is of version " + value.at(0).dump() + ", and this program reads version " +
               std::to_string(kVersion));
    }
    return value;
}

double finite(const json& value) {
    const auto number = value.get<double>();
    if (!(std::abs(number) <= kFarthest)) refuse("a number is out of range");
    return number;
}

template <typename Enum>
Enum enumerator(const json& value, Enum last) {
    const auto number = value.get<unsigned>();
    if (number > static_cast<unsigned>(last)) refuse("there is no such choice as " + std::to_string(number));
    return static_cast<Enum>(number);
}

json quaternion(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }

glm::dquat quaternionIn(const json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>(), value.at(3).get<double>()};
}

// --- Polytopes

bool isOfCatalogue(const PolytopePtr& polytope) {
    const auto named = geometry::designNamed(polytope->name, polytope->vertices.size());
    const auto* design = std::get_if<geometry::Design>(&named);
    return design != nullptr && geometry::elementCounts(*design).vertices == polytope->vertices.size() &&
           geometry::polytopeOf(*design) == polytope;  // one in use is built once only
}

PolytopePtr catalogued(const std::string& name) {
    const auto named = geometry::designNamed(name, kMostVertices);
    const auto* design = std::get_if<geometry::Design>(&named);
    if (design == nullptr) refuse("this program knows no polytope called '" + name + "'");
    return geometry::polytopeOf(*design);
}

/// The polytopes of a session, each once.
class Polytopes {
  public:
    explicit Polytopes(const KeyOf& keyOf) : keyOf_(keyOf) {}

    std::size_t number(const PolytopePtr& polytope) {
        const auto [found, isNew] = numbers_.try_emplace(polytope.get(), list.size());
        if (isNew) {
            // [name] of the catalogue's, [name, key] of others
            json entry = json::array({polytope->name});
            if (!isOfCatalogue(polytope)) entry.push_back(keyOf_(polytope));
            list.push_back(std::move(entry));
        }
        return found->second;
    }

    json list = json::array();

  private:
    const KeyOf& keyOf_;
    std::map<const Polytope*, std::size_t> numbers_;
};

using PolytopeList = std::vector<PolytopePtr>;

PolytopeList polytopesIn(const json& list, const PolytopeOf& polytopeOf) {
    PolytopeList polytopes;
    for (const json& entry : list) {
        polytopes.push_back(entry.size() == 1 ? catalogued(entry.at(0)) : polytopeOf(entry.at(1)));
        if (!polytopes.back()) refuse("a polytope is missing");
    }
    return polytopes;
}

// --- Parts of a state

json encoded(const std::optional<geometry::Turn>& turn) {
    if (!turn) return nullptr;
    const auto& [plane, alpha, beta] = *turn;
    return {static_cast<unsigned>(plane), alpha, beta ? json(*beta) : json()};
}

std::optional<geometry::Turn> turnIn(const json& value) {
    if (value.is_null()) return std::nullopt;
    geometry::Turn turn{enumerator(value.at(0), geometry::Plane::zw), finite(value.at(1)), {}};
    if (!value.at(2).is_null()) turn.beta = finite(value.at(2));
    return turn;
}

json encoded(const scene::Look& look) {
    const auto& [view, parts, orbit, colouring, kinds] = look;
    const auto& [faces, bars, balls, coordinates] = parts;
    const auto& [azimuth, elevation, zoom] = orbit;
    const auto& [hidden, faded] = kinds;
    return {static_cast<unsigned>(view),
            {faces, bars, balls, coordinates},
            {azimuth, elevation, zoom},
            static_cast<unsigned>(colouring),
            hidden,
            faded};
}

std::vector<std::uint32_t> kindsIn(const json& value, std::size_t count) {
    auto kinds = value.get<std::vector<std::uint32_t>>();
    const auto unsorted = std::ranges::adjacent_find(kinds, std::greater_equal<>());
    if (unsorted != kinds.end() || (!kinds.empty() && kinds.back() >= count))
        refuse("kinds of cells that are not there");
    return kinds;
}

scene::Look lookIn(const json& value, std::size_t kinds) {
    const json& parts = value.at(1);
    const json& orbit = value.at(2);
    return {enumerator(value.at(0), scene::View::single),
            {parts.at(0).get<bool>(), parts.at(1).get<bool>(), parts.at(2).get<bool>(), parts.at(3).get<bool>()},
            {finite(orbit.at(0)), finite(orbit.at(1)), finite(orbit.at(2))},
            enumerator(value.at(3), scene::Colouring::plain),
            {kindsIn(value.at(4), kinds), kindsIn(value.at(5), kinds)}};
}

// --- States

json encoded(const State& state, Polytopes& polytopes) {
    const auto& [polytope, orientation, alpha, beta, step, slices, look, turning, last] = state;
    const auto& [count, spacing, focus] = slices;
    return {polytopes.number(polytope),
            quaternion(orientation.left()),
            quaternion(orientation.right()),
            {alpha, beta, step},
            {count, spacing, focus},
            encoded(look),
            turning,
            encoded(last)};
}

State stateIn(const json& value, const PolytopeList& polytopes) {
    const auto number = value.at(0).get<std::size_t>();
    if (number >= polytopes.size()) refuse("a state's polytope is missing");
    const PolytopePtr& polytope = polytopes[number];
    const auto orientation = geometry::Rotation::fromQuaternions(quaternionIn(value.at(1)), quaternionIn(value.at(2)));
    if (!orientation) refuse("an orientation is no rotation");
    const json& angles = value.at(3);
    const json& slices = value.at(4);
    State state{polytope,
                *orientation,
                finite(angles.at(0)),
                finite(angles.at(1)),
                finite(angles.at(2)),
                {slices.at(0).get<int>(), finite(slices.at(1)), slices.at(2).get<int>()},
                lookIn(value.at(5), polytope->kinds.size()),
                value.at(6).get<bool>(),
                turnIn(value.at(7))};
    const auto& [count, spacing, focus] = state.slices;
    if (count < 1 || count > kMostSlices || count % 2 == 0 || !(spacing > 0)) refuse("slices that cannot be cut");
    return state;
}

/// The last of them, so many at most.
template <typename States>
json history(const States& states, std::size_t most, Polytopes& polytopes) {
    json list = json::array();
    for (std::size_t i = states.size() - std::min(states.size(), most); i < states.size(); ++i) {
        list.push_back(encoded(states[i], polytopes));
    }
    return list;
}

json flat(const geometry::Lists& lists) {
    json list = json::array();
    for (std::size_t i = 0; i < lists.size(); ++i) list.emplace_back(lists[i]);
    return list;
}

geometry::Lists listsIn(const json& value) {
    geometry::Lists lists;
    for (const json& list : value) lists.add(list.get<std::vector<std::uint32_t>>());
    return lists;
}

}  // namespace

std::string encodeHead(const Session& session, const KeyOf& keyOf) {
    Polytopes polytopes(keyOf);
    json now = encoded(session.now, polytopes);
    return bytesOf({kVersion, session.revision, polytopes.list, std::move(now)});
}

std::string encodeWhole(const Session& session, std::size_t maxUndo, const KeyOf& keyOf) {
    const auto& [now, past, future, loaded, pendingKey, revision] = session;
    Polytopes polytopes(keyOf);
    json state = encoded(now, polytopes);
    json before = history(past, maxUndo, polytopes);
    json after = history(future, maxUndo, polytopes);
    json own = json::array();
    for (const auto& [name, polytope] : loaded) own.push_back({name, polytopes.number(polytope)});
    return bytesOf({kVersion, revision, polytopes.list, std::move(state), std::move(before), std::move(after),
                    std::move(own), pendingKey});
}

Session decode(std::string_view whole, std::string_view head, const PolytopeOf& polytopeOf) {
    return reading([&] {
        const json value = parsed(whole);
        const PolytopeList polytopes = polytopesIn(value.at(2), polytopeOf);
        Session session;
        session.revision = value.at(1).get<std::uint64_t>();
        session.now = stateIn(value.at(3), polytopes);
        for (const json& state : value.at(4)) session.past.push_back(stateIn(state, polytopes));
        for (const json& state : value.at(5)) session.future.push_back(stateIn(state, polytopes));
        for (const json& own : value.at(6)) session.loaded[own.at(0)] = polytopes.at(own.at(1).get<std::size_t>());
        session.pendingKey = value.at(7).get<std::string>();
        if (head.empty()) return session;
        const json newer = parsed(head);
        const auto revision = newer.at(1).get<std::uint64_t>();
        if (revision <= session.revision) return session;
        session.past.push_back(std::move(session.now));
        session.future.clear();
        session.now = stateIn(newer.at(3), polytopesIn(newer.at(2), polytopeOf));
        session.revision = revision;
        session.pendingKey.clear();
        return session;
    });
}

std::string encodePolytope(const Polytope& polytope) {
    json vertices = json::array();
    for (const glm::dvec4& v : polytope.vertices) vertices.push_back({v.x, v.y, v.z, v.w});
    return bytesOf(
        {kVersion, polytope.name, std::move(vertices), flat(polytope.faces), flat(polytope.cells), polytope.cellKinds});
}

PolytopePtr decodePolytope(std::string_view bytes) {
    return reading([&] {
        const json value = parsed(bytes);
        std::vector<glm::dvec4> vertices;
        for (const json& v : value.at(2))
            vertices.emplace_back(finite(v.at(0)), finite(v.at(1)), finite(v.at(2)), finite(v.at(3)));
        geometry::Lists cells = listsIn(value.at(4));
        auto kinds = value.at(5).get<std::vector<std::uint32_t>>();
        if (kinds.size() != cells.size()) refuse("not every cell has its kind");
        try {
            return std::make_shared<const Polytope>(geometry::makePolytope(
                value.at(1), std::move(vertices), listsIn(value.at(3)), std::move(cells), std::move(kinds)));
        } catch (const geometry::Unsound& fault) {
            refuse(std::string("a polytope is not sound: ") + fault.what());
        }
    });
}

}  // namespace oval4d::store

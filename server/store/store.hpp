#pragma once
// Where sessions are kept.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace oval4d::store {

/// Wall-clock time: a store may outlive the process.
using Time = std::chrono::system_clock::time_point;
using Milliseconds = std::chrono::milliseconds;

/// What opens a session: its public name, and the secret that goes with it.
struct Ticket {
    std::string id, token;
};

/// Says who owns a session: each claim raises the number, and a save with a lower one than the record's is refused.
using Fence = std::uint64_t;

/// A session as it is kept: what codec.hpp writes. `polytopes` are those without a name in the catalogue, by their
/// keys.
struct Record {
    std::string whole, head;
    std::vector<std::pair<std::string, std::string>> polytopes;
    Fence fence = 0;
};

/// A change of a record.
struct Saving {
    Ticket ticket;
    Fence fence = 0;
    std::string head;                                            ///< empty: as it was
    std::string whole;                                           ///< empty: as it was; else `head` is forgotten
    std::vector<std::pair<std::string, std::string>> polytopes;  ///< to add
    std::vector<std::string> dropped;                            ///< keys of polytopes to forget
    bool last = false;                                           ///< nobody has the session open any more
};

/// What became of a saving.
enum class Saved : std::uint8_t {
    yes,
    taken,    ///< no: another has claimed the session since
    missing,  ///< no: the store does not have the session, and what was given is not the whole of it
};

/// A store that does not answer, or has no room.
class Outage : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Records by the ids of sessions. Every function may block, and throws Outage where the store fails; then nothing of
/// what was asked is sure to have happened, and it may be asked again. Called by one thread at a time.
class Store {
  public:
    Store() = default;
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;
    virtual ~Store() = default;

    /// How changes of a session in use reach the store.
    enum class Pace : std::uint8_t {
        at_close,  ///< when the last client leaves
        soon,      ///< within a second
        at_once,   ///< before they are acknowledged, for another server may have to go on
    };
    virtual Pace pace() const = 0;

    /// For people, without passwords: "sqlite:/var/lib/oval4d/sessions.sqlite".
    virtual std::string name() const = 0;

    /// The secret of a session that is kept, or nothing.
    virtual std::optional<std::string> token(const std::string& id) = 0;

    /// Takes a session over, from whoever had it; nothing if it is not kept.
    virtual std::optional<Record> claim(const std::string& id) = 0;

    /// Saves, and says of each what became of it. A record that the store has lost or never had is made anew.
    virtual std::vector<Saved> save(std::span<const Saving> savings) = 0;

    /// Puts off the expiry of sessions that are open.
    virtual void touch(std::span<const std::string> ids) = 0;

    /// Forgets what was not saved or touched for so long, if the store does not see to that itself; how many.
    virtual std::size_t expire(Milliseconds age) = 0;

    /// A sign of life: the sessions that others have claimed from this server since the last one.
    virtual std::vector<std::string> pulse() = 0;

    /// About how many sessions are kept, as of the last pulse.
    virtual std::size_t size() const = 0;
};

/// What an operator says of a store.
struct StoreOptions {
    std::string place = "memory";  ///< "memory", "sqlite:PATH", "redis://[user:password@]host[:port][/database]"
    Milliseconds expiry{1'800'000};
    Milliseconds timeout{1000};  ///< for an answer of a store over the network
};

/// Opens the store that `options.place` names. Throws std::invalid_argument for what is no such place, Outage for a
/// file that cannot be used. A store over the network need not be there yet.
std::unique_ptr<Store> openStore(const StoreOptions& options);

}  // namespace oval4d::store

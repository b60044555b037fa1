#pragma once
// Reads and writes sessions beside the rest of the server, so that nobody else waits for a disk or a network.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <random>
#include <thread>

#include "protocol/cpp/error.hpp"
#include "session/session.hpp"
#include "store/store.hpp"

namespace oval4d::store {

/// The sessions that are open on this server, and those whose last change is not yet in the store. A thread of the
/// keeper's own uses the store; of several changes of a session that wait, the newest is written. While the store
/// fails, changes wait here, the store is tried again with growing pauses, and nobody is kept waiting for it.
///
/// Every function may be called from any thread. Callbacks come from the keeper's thread, or from within the call, and
/// must be quick.
class Keeper {
  public:
    struct Settings {
        Milliseconds expiry{1'800'000};
        std::size_t maxUndo = 100;  ///< steps of a session's history that are kept
    };
    /// What others are told.
    struct Listener {
        std::function<void(const std::string& id)> taken;   ///< another server goes on with this session
        std::function<void(const std::string& id)> wanted;  ///< the store lacks this session: save the whole of it
        std::function<void()> back;  ///< the store answers again, and may have lost something: save all
        std::function<void(const char* what, double seconds, bool worked)> asked;  ///< the store was asked something
    };
    /// A session that was kept: as a value where it had not left this process, else to be read by codec.hpp.
    struct Fetched {
        std::optional<session::Session> session;
        Record record;
    };
    using Fetch = protocol::Result<Fetched>;
    /// The keys of a session's polytopes by their serials.
    using Keys = std::map<std::uint64_t, std::string>;
    using Written = std::function<void(bool)>;
    enum class Part : std::uint8_t { head, whole };

    Keeper(std::unique_ptr<Store> store, Settings settings, Listener listener);
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;
    ~Keeper();

    Store::Pace pace() const { return pace_; }
    const std::string& name() const { return name_; }

    /// A new session, open here. Nothing is kept of it before it is saved.
    Ticket create();

    /// Claims a session for this server. `done` has what was kept; or `not_found`, `bad_token`, or `internal` where the
    /// store does not answer.
    void fetch(Ticket ticket, std::function<void(Fetch)> done);

    /// What was learned by reading a session that was fetched.
    void know(const std::string& id, Keys keys);

    /// Writes a session, or of it what every command changes. `written` is told true once it is in the store, or at
    /// once while the store fails; false if the session is no longer this server's.
    void save(const std::string& id, session::Session value, Part part, Written written = {});

    /// Writes a session that nobody has open any more.
    void close(const std::string& id, session::Session value);

    /// Leaves a session that was fetched, but could not be read, as it is in the store.
    void letGo(const std::string& id);

    /// Sessions kept in the store or here, about; with a store that servers share, those that are here.
    std::size_t count() const;
    /// Sessions of which a change is not known to be in the store.
    std::size_t unsaved() const;
    /// Why the store fails; empty if it does not.
    std::string trouble() const;

    /// Writes what waits, for so long at most, and ends.
    void stop(Milliseconds limit);

  private:
    using Clock = std::chrono::steady_clock;
    using Value = std::shared_ptr<const session::Session>;
    struct Held {
        Ticket ticket;
        Fence fence = 1;
        Value head, whole;  ///< to be written
        std::vector<Written> waiting;
        bool saved = false;  ///< the store has had it
        bool queued = false;
        bool underway = false;  ///< the store is being asked to write it
        bool closed = false;    ///< nobody has it open: forgotten once written
        Clock::time_point closedAt;
    };
    /// What is written of one session at a time.
    struct Job {
        std::string id;
        Value head, whole;
        std::vector<Written> waiting;
        Keys added;
    };

    // The keeper's thread.
    void run();
    void write();
    void encode(Job& job, Saving& saving);
    void settle(Job& job, const Saving& saving, Saved said);
    void putBack(Job& job);
    void lose(const std::string& id);
    void pulse();
    void tidy();
    void answer(const Ticket& ticket, const std::function<void(Fetch)>& done);
    Fetch lookUp(const Ticket& ticket);
    template <typename Ask>
    auto ask(const char* what, Ask ask);
    void failed(const std::string& why);
    void worked();

    // With mutex_ held.
    void enqueue(const std::string& id, Held& held);
    bool mayWrite() const;
    Clock::time_point nextWake() const;

    const std::unique_ptr<Store> store_;
    const Store::Pace pace_;
    const std::string name_;
    const Settings settings_;
    const Listener listener_;

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Guarded by mutex_.
    std::map<std::string, Held, std::less<>> held_;
    std::deque<std::string> queue_;            // ids whose change waits
    std::deque<std::function<void()>> tasks_;  // for the thread, before it writes
    std::size_t kept_ = 0, created_ = 0;       // in the store at the last pulse; beside these, here only
    std::string trouble_;
    Clock::time_point retryAt_, pulseAt_;
    bool stopping_ = false;
    Clock::time_point stopAt_;

    // The thread's.
    std::map<std::string, Keys, std::less<>> keys_;  // of the polytopes that the store has
    int failures_ = 0;                               // one after the other
    Clock::time_point tidyAt_;
    std::minstd_rand random_;

    std::thread thread_;  // last: it uses the rest
};

}  // namespace oval4d::store

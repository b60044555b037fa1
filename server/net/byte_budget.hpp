#pragma once
// Limits on the memory and disk space that the server uses on behalf of clients.

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>

namespace oval4d::net {

/// Counts and limits the bytes that the server holds for clients. They are the bytes of four kinds of data:
/// - files, pictures and messages that clients have not yet read;
/// - long messages and uploads that the server is receiving;
/// - objects that clients have loaded or built by name;
/// - undo histories.
///
/// One budget covers all clients together. An Account counts the bytes of one client. The server reserves bytes on the
/// client's account before it uses them. Every function may be called from any thread.
class ByteBudget {
  public:
    class Account;

    /// Bytes reserved on an account; the destructor releases them.
    class Reservation {
      public:
        Reservation() = default;
        Reservation(Reservation&& other) noexcept;
        Reservation& operator=(Reservation&& other) noexcept;
        ~Reservation();

        std::size_t size() const { return size_; }
        /// Changes the size to `bytes` without checking the limits, because the bytes are already in use. Does nothing
        /// to a default-constructed or moved-from reservation.
        void forceResize(std::size_t bytes);
        /// Enlarges the reservation to `bytes`. Returns false, and changes nothing, if that would exceed a limit. The
        /// caller must ensure that `bytes` is at least size(), and that the reservation is neither default-constructed
        /// nor moved-from.
        [[nodiscard]] bool growTo(std::size_t bytes);

      private:
        friend Account;
        Reservation(std::shared_ptr<Account> account, std::size_t size) : account_(std::move(account)), size_(size) {}
        std::shared_ptr<Account> account_;
        std::size_t size_ = 0;
    };

    /// The account of one client in the budget. Its bytes exceed `limit` only through Account::forceReserve() and
    /// Reservation::forceResize().
    class Account : public std::enable_shared_from_this<Account> {
      public:
        Account(ByteBudget& budget, std::size_t limit) : budget_(budget), limit_(limit) {}

        /// Reserves `bytes` bytes. Returns an empty optional if the limit of the client or of the budget would be
        /// exceeded.
        std::optional<Reservation> reserve(std::size_t bytes);
        /// Reserves `bytes` bytes without checking the limits. Meant for data that the server cannot refuse.
        Reservation forceReserve(std::size_t bytes);
        /// Returns the number of bytes now reserved on this account.
        std::size_t heldBytes() const;

      private:
        friend Reservation;
        void adjustHeld(std::size_t from, std::size_t to);

        ByteBudget& budget_;
        const std::size_t limit_;
        std::size_t held_ = 0;  // guarded by the budget's mutex
    };

    /// `total` is the limit for all clients together, in bytes.
    explicit ByteBudget(std::size_t total) : total_(total) {}

    /// Returns the number of bytes now reserved on all accounts.
    std::size_t heldBytes() const;

  private:
    const std::size_t total_;
    mutable std::mutex mutex_;
    std::size_t held_ = 0;  // guarded by mutex_
};

}  // namespace oval4d::net

#include "net/byte_budget.hpp"

#include <utility>

namespace oval4d::net {

ByteBudget::Reservation::Reservation(Reservation&& other) noexcept
    : account_(std::move(other.account_)), size_(std::exchange(other.size_, 0)) {}

ByteBudget::Reservation& ByteBudget::Reservation::operator=(Reservation&& other) noexcept {
    std::swap(account_, other.account_);
    std::swap(size_, other.size_);
    return *this;
}

ByteBudget::Reservation::~Reservation() { forceResize(0); }

void ByteBudget::Reservation::forceResize(std::size_t bytes) {
    if (account_) account_->adjustHeld(std::exchange(size_, bytes), bytes);
}

bool ByteBudget::Reservation::growTo(std::size_t bytes) {
    auto more = account_->reserve(bytes - size_);
    if (!more) return false;
    size_ += std::exchange(more->size_, 0);
    return true;
}

std::optional<ByteBudget::Reservation> ByteBudget::Account::reserve(std::size_t bytes) {
    {
        const std::lock_guard lock(budget_.mutex_);
        // Sums are compared with the limits, because `limit_ - held_` would wrap around if forceReserve() has exceeded
        // the limit.
        if (held_ + bytes > limit_ || budget_.held_ + bytes > budget_.total_) return std::nullopt;
        held_ += bytes;
        budget_.held_ += bytes;
    }
    return Reservation(shared_from_this(), bytes);
}

ByteBudget::Reservation ByteBudget::Account::forceReserve(std::size_t bytes) {
    adjustHeld(0, bytes);
    return {shared_from_this(), bytes};
}

std::size_t ByteBudget::Account::heldBytes() const {
    const std::lock_guard lock(budget_.mutex_);
    return held_;
}

void ByteBudget::Account::adjustHeld(std::size_t from, std::size_t to) {
    const std::lock_guard lock(budget_.mutex_);
    held_ += to - from;
    budget_.held_ += to - from;
}

std::size_t ByteBudget::heldBytes() const {
    const std::lock_guard lock(mutex_);
    return held_;
}

}  // namespace oval4d::net

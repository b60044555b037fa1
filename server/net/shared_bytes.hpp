#pragma once
// A byte string that several owners share.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace oval4d::net {

/// An immutable byte string with shared ownership. Copies share the same memory.
class SharedBytes {
  public:
    SharedBytes() = default;
    explicit SharedBytes(std::string text);
    explicit SharedBytes(std::vector<std::uint8_t> bytes);
    /// Refers to the bytes of `view`. `owner` keeps these bytes alive.
    SharedBytes(std::string_view view, std::shared_ptr<const void> owner) : view_(view), owner_(std::move(owner)) {}

    std::string_view view() const { return view_; }
    std::size_t size() const { return view_.size(); }

    /// Returns `size` bytes from the offset `first`. The result shares the memory of this object.
    SharedBytes subrange(std::size_t first, std::size_t size) const;

    /// Returns the same bytes. The result also keeps `resource` alive.
    SharedBytes keepingAlive(std::shared_ptr<const void> resource) const;

  private:
    std::string_view view_;
    std::shared_ptr<const void> owner_;
};

}  // namespace oval4d::net

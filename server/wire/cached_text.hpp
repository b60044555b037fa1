#pragma once
// A cache for text that is written repeatedly from the same value.

#include <string>
#include <string_view>

namespace oval4d::wire {

/// Caches the text written from a value, and writes it again only if the value changes.
template <typename Value>
class CachedText {
  public:
    /// Returns the text of `value`. Calls `write(out)` to write it if it is not cached. The result is valid until the
    /// next call.
    template <typename Write>
    std::string_view of(const Value& value, Write write) {
        if (text_.empty() || value_ != value) {
            value_ = value;
            write(text_);
        }
        return text_;
    }

  private:
    Value value_;
    std::string text_;
};

}  // namespace oval4d::wire

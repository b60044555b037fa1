#pragma once
// A cache for the text of a value that is often written several times in a row.

#include <string>
#include <string_view>

namespace oval4d::wire {

/// A cache of one value and its text.
template <typename Value>
class CachedText {
  public:
    /// Returns the text of `value`. Calls `write(out)` at the first call, and whenever `value` differs from the value
    /// of the previous call. `write` must overwrite the std::string `out` with the text of `value`. The result is valid
    /// until the next call.
    template <typename Write>
    std::string_view textFor(const Value& value, Write write) {
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

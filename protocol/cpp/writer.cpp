#include "protocol/cpp/writer.hpp"

#include <algorithm>

namespace oval4d::protocol {

Buffer::Buffer(std::string& out) : out_(out) {
    out_.resize(out_.capacity());
    at_ = out_.data();
    end_ = at_ + out_.size();
}

void Buffer::grow(std::size_t size) {
    const auto used = static_cast<std::size_t>(at_ - out_.data());
    out_.resize(std::max(2 * out_.size(), used + size));
    out_.resize(out_.capacity());
    at_ = out_.data() + used;
    end_ = out_.data() + out_.size();
}

}  // namespace oval4d::protocol

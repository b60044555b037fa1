#include "wire/buffer.hpp"

namespace oval4d::wire {

OutputBuffer::OutputBuffer(std::string& out) : out_(out), at_(out_.data()), end_(at_ + out_.size()) {}

void OutputBuffer::grow(std::size_t size) {
    const auto used = static_cast<std::size_t>(at_ - out_.data());
    out_.resize(used + size + used / 8 + 256);
    at_ = out_.data() + used;
    end_ = out_.data() + out_.size();
}

}  // namespace oval4d::wire

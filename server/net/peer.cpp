#include "net/peer.hpp"

namespace oval4d::net {

Bytes::Bytes(std::string text) {
    auto owner = std::make_shared<const std::string>(std::move(text));
    view_ = *owner;
    owner_ = std::move(owner);
}

Bytes::Bytes(std::vector<std::uint8_t> bytes) {
    auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
    view_ = {reinterpret_cast<const char*>(owner->data()), owner->size()};
    owner_ = std::move(owner);
}

Message textMessage(std::string text) { return {Bytes(std::move(text)), false}; }

}  // namespace oval4d::net

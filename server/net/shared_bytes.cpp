#include "net/shared_bytes.hpp"

#include <utility>

namespace oval4d::net {

SharedBytes::SharedBytes(std::string text) {
    auto owner = std::make_shared<const std::string>(std::move(text));
    view_ = *owner;
    owner_ = std::move(owner);
}

SharedBytes::SharedBytes(std::vector<std::uint8_t> bytes) {
    auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
    view_ = {reinterpret_cast<const char*>(owner->data()), owner->size()};
    owner_ = std::move(owner);
}

SharedBytes SharedBytes::subrange(std::size_t first, std::size_t size) const {
    SharedBytes range(*this);
    range.view_ = view_.substr(first, size);
    return range;
}

SharedBytes SharedBytes::keepingAlive(std::shared_ptr<const void> resource) const {
    SharedBytes both(*this);
    both.owner_ = std::make_shared<const std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>>(
        owner_, std::move(resource));
    return both;
}

}  // namespace oval4d::net

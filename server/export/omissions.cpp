#include "export/omissions.hpp"

#include <algorithm>
#include <cstddef>

#include "text/message_text.hpp"

namespace oval4d::exports {

std::string omittedSlicesWarning(const geometry::Hyperplanes& planes, std::span<const int> slices,
                                 std::string_view reason, double origin) {
    constexpr std::size_t kListed = 12;
    const bool isOne = planes.count == 1;
    std::string out = isOne ? "the slice" : std::to_string(slices.size()) + " of " + std::to_string(planes.count);
    if (!isOne) out += " slices";
    out += slices.size() == 1 ? " is " : " are ";
    out += std::string(reason) + " and left out: w = ";
    for (std::size_t i = 0; i < std::min(slices.size(), kListed); ++i) {
        out += (i > 0 ? ", " : "") + text::roundedDecimal(planes.w(slices[i]) + origin);
    }
    if (slices.size() > kListed) out += " and " + std::to_string(slices.size() - kListed) + " more";
    return out;
}

}  // namespace oval4d::exports

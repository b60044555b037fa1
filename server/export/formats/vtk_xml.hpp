#pragma once
// Parts of XML files for the Visualization Toolkit, VTK (K. Martin et al., "VTK File Formats", in The VTK User's
// Guide).

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "export/formats/little_endian.hpp"
#include "fields/quantity.hpp"

namespace oval4d::exports {

/// Returns a complete file with one data set: an XML element with the name `type`, such as "PolyData". `attributes` are
/// the attributes of this element, each after a space. `elements` is the content of this element.
std::string vtkFile(std::string_view type, std::string_view attributes, std::string_view elements);

/// Appends a DataArray element that contains `bytes` in Base64. `bytes` must be little-endian numbers of the type
/// `type`, such as "Float32". Each tuple of the array has `components` numbers. `quantity` is what the numbers measure,
/// as far as known: the name of the quantity becomes the name of the first component, and its unit becomes the
/// information key vtkDataArray::UNITS_LABEL.
void appendVtkArray(std::string& out, std::string_view type, std::string_view name, int components,
                    std::string_view bytes, const fields::Quantity& quantity = {});

/// Appends a DataArray element that contains `numbers`. `components` and `quantity` are as in the function above.
template <typename Number>
void appendVtkArray(std::string& out, std::string_view name, int components, std::span<const Number> numbers,
                    const fields::Quantity& quantity = {}) {
    constexpr bool kReal = std::is_floating_point_v<Number>;
    constexpr std::size_t kBits = 8 * sizeof(Number);
    std::string bytes;
    bytes.reserve(numbers.size_bytes());
    for (const Number number : numbers) {
        if constexpr (kReal && sizeof(Number) == 8) {
            putLittleEndian(bytes, std::bit_cast<std::uint64_t>(number));
        } else if constexpr (kReal) {
            putLittleEndian(bytes, number);
        } else {
            putLittleEndian(bytes, static_cast<std::make_unsigned_t<Number>>(number));
        }
    }
    const std::string kind = kReal ? "Float" : std::is_signed_v<Number> ? "Int" : "UInt";
    appendVtkArray(out, kind + std::to_string(kBits), name, components, bytes, quantity);
}

}  // namespace oval4d::exports

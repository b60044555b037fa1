#include "export/formats/vtk_xml.hpp"

#include <sodium.h>

#include "export/formats/text.hpp"

namespace oval4d::exports {

std::string vtkFile(std::string_view type, std::string_view attributes, std::string_view elements) {
    std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"";
    out.append(type).append("\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<");
    out.append(type).append(attributes).append(">\n").append(elements);
    return out.append("</").append(type).append(">\n</VTKFile>\n");
}

void appendVtkArray(std::string& out, std::string_view type, std::string_view name, int components,
                    std::string_view bytes, const fields::Quantity& quantity) {
    // In VTK's format, the size of the data in bytes comes first. Size and data are encoded together as one Base64
    // text.
    std::string data;
    data.reserve(sizeof(std::uint64_t) + bytes.size());
    putLittleEndian(data, std::uint64_t{bytes.size()});
    data.append(bytes);
    out.append("<DataArray type=\"").append(type).append("\" Name=\"").append(xmlEscaped(name));
    out.append("\" NumberOfComponents=\"").append(std::to_string(components)).append("\"");
    if (!quantity.name.empty()) out.append(" ComponentName0=\"").append(xmlEscaped(quantity.name)).append("\"");
    out.append(" format=\"binary\">\n");
    const std::size_t begin = out.size();
    // The size includes a terminating zero.
    const std::size_t size = sodium_base64_encoded_len(data.size(), sodium_base64_VARIANT_ORIGINAL);
    out.resize(begin + size);
    sodium_bin2base64(out.data() + begin, size, reinterpret_cast<const unsigned char*>(data.data()), data.size(),
                      sodium_base64_VARIANT_ORIGINAL);
    out.resize(begin + size - 1);
    out.append("\n");
    // VTK expects the data before the unit.
    if (!quantity.unit.empty()) {
        out.append("<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">");
        out.append(xmlEscaped(quantity.unit)).append("</InformationKey>\n");
    }
    out.append("</DataArray>\n");
}

}  // namespace oval4d::exports

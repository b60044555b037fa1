#include "export/wish.hpp"

namespace oval4d::exports {

std::string_view nameOf(Format format) { return kFormats[static_cast<std::size_t>(format)].name; }

std::string_view mediaType(Format format) {
    switch (format) {
        case Format::stl:
            return "model/stl";
        case Format::three_mf:
            return "model/3mf";
        case Format::obj:
            return "model/obj";
        case Format::glb:
            return "model/gltf-binary";
        case Format::csv:
            return "text/csv; charset=utf-8";
        case Format::svg:
            return "image/svg+xml";
        case Format::off:
            return "text/plain; charset=utf-8";
        case Format::ply:
            break;
    }
    return "application/octet-stream";
}

}  // namespace oval4d::exports

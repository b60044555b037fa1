// Fuzzes the import of files. The importer must either refuse the bytes with a reason, or return an object that can be
// sliced.

#include "support.hpp"

using namespace oval4d;
using fuzz::require;

OVAL4D_FUZZER(import) {
    const std::string_view text = fuzz::textOf(data, size);
    session::Limits limits;
    limits.maxVertices = 200;
    limits.maxHullCells = 2'000;
    const auto read =
        session::readObject({"p", std::string(session::detectTextFormat(text)), std::string(text)}, limits);
    if (!read) {
        require(!read.error().message.empty(), "what is refused says why");
        return 0;
    }
    static slicing::Slicer slicer;
    static slicing::SliceSet slices;
    const geometry::Rotation turned(geometry::RotationAngles{geometry::Plane::zw, 0.3, {}});
    for (const geometry::Rotation& orientation : {geometry::Rotation{}, turned}) {
        const double spacing = slicing::infoOf(read->object).circumradius / 2;
        slicer.sliceWithoutSurfaces(read->object, orientation, {-2, 5, spacing}, slices);
        for (const std::uint32_t corner : slices.corners)
            require(corner < slices.vertices.size(), "a face has vertices for corners");
        for (const auto& [a, b] : slices.edges)
            require(std::max(a, b) < slices.vertices.size(), "an edge has vertices for ends");
    }
    return 0;
}

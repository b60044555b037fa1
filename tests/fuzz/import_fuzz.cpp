// Fuzzes the import of files: the importer refuses any bytes with a reason, or returns a polytope that can be sliced.

#include "polytopes/import/import.hpp"
#include "slicing/polytope_slicer.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;
using namespace oval4d::geometry;
using namespace oval4d::polytopes;
using namespace oval4d::slicing;

OVAL4D_FUZZER(import) {
    const std::string_view text = fuzz::textOf(data, size);
    const auto result = importPolytope(detectFileFormat(text), text, "p", {.maxVertices = 200, .maxHullCells = 2'000});
    if (const auto* error = std::get_if<FileError>(&result)) {
        require(!error->reason.empty(), "what is refused says why");
        return 0;
    }
    const polytopes::Polytope& polytope = std::get<polytopes::Imported>(result).polytope;
    static slicing::PolytopeSlicer slicer;
    static slicing::SliceSet slices;
    const geometry::Rotation turned(geometry::Turn{geometry::Plane::zw, 0.3, {}});
    for (const geometry::Rotation& orientation : {geometry::Rotation{}, turned}) {
        slicer.slice(polytope, orientation, {-2, 5, polytope.circumradius / 2}, slices);
        for (const std::uint32_t corner : slices.corners)
            require(corner < slices.vertices.size(), "a face has vertices for corners");
    }
    return 0;
}

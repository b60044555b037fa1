// Whatever bytes a file holds: the importer refuses them with a reason, or makes a polytope that can be sliced.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "geometry/import.hpp"
#include "geometry/slicer.hpp"

using namespace oval4d::geometry;

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto result = importPolytope(formatOf(text), text, "p", {.maxVertices = 200, .maxHullCells = 2'000});
    if (const auto* error = std::get_if<ImportError>(&result)) {
        if (error->reason.empty()) std::abort();
        return 0;
    }
    const Polytope& polytope = std::get<Imported>(result).polytope;
    static Slicer slicer;
    static SliceSet slices;
    const Rotation turned(Turn{Plane::zw, 0.3, {}});
    for (const Rotation& orientation : {Rotation{}, turned}) {
        slicer.slice(polytope, orientation, {-2, 5, polytope.circumradius / 2}, slices);
        for (const std::uint32_t corner : slices.corners) {
            if (corner >= slices.vertices.size()) std::abort();
        }
    }
    return 0;
}

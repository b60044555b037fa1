#include "export/mesh/tessellate.hpp"

#include <GL/glu.h>

#include <deque>
#include <memory>

namespace oval4d::exports {

namespace {

// The data that the callbacks of GLU's tessellator share. (The tessellator needs no OpenGL context.) The tessellator
// passes pointers to elements of `corners` to the callback vertex(). These elements were made by tessellate() or, where
// contours cross, by the callback addCrossing().
struct TessellatorData {
    // The position (x, y, 0) and the index of each corner. The index counts all corners in the order in which
    // tessellate() passes them to GLU. A corner made by addCrossing() has the index 0xffffffff. A deque keeps pointers
    // to its elements valid when elements are appended.
    std::deque<std::pair<std::array<double, 3>, std::uint32_t>> corners;
    std::vector<std::uint32_t> out;  // indices of the corners of the output, three for each triangle
    std::vector<Contour> contours;   // polygons of the output, if the outline was requested
    bool crossed = false;            // whether contours cross or touch, so that addCrossing() made a corner
    bool failed = false;             // whether GLU has reported an error
};

using TessellatorCorner = decltype(TessellatorData::corners)::value_type;

void beginContour(GLenum /*kind*/, void* to) { static_cast<TessellatorData*>(to)->contours.emplace_back(); }

void addOutputVertex(void* data, void* to) {
    auto* tessellation = static_cast<TessellatorData*>(to);
    const auto* corner = static_cast<TessellatorCorner*>(data);
    tessellation->out.push_back(corner->second);
    tessellation->contours.back().emplace_back(corner->first[0], corner->first[1]);
}

// An empty callback. If it is registered, GLU outputs separate triangles instead of strips and fans.
void ignoreEdgeFlag(GLboolean /*flag*/, void* /*to*/) {}

void addCrossing(GLdouble* at, void** /*joined*/, GLfloat* /*weights*/, void** made, void* to) {
    auto* tessellation = static_cast<TessellatorData*>(to);
    tessellation->crossed = true;
    tessellation->corners.push_back({{at[0], at[1], at[2]}, 0xffffffffU});
    *made = &tessellation->corners.back();
}

void recordFailure(GLenum /*code*/, void* to) { static_cast<TessellatorData*>(to)->failed = true; }

template <typename Function>
_GLUfuncptr asGluCallback(Function* function) {
    return reinterpret_cast<_GLUfuncptr>(function);
}

TessellatorData tessellate(const std::vector<Contour>& contours, bool outline) {
    TessellatorData tessellation;
    const std::unique_ptr<GLUtesselator, decltype(&gluDeleteTess)> tess(gluNewTess(), &gluDeleteTess);
    gluTessProperty(tess.get(), GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
    gluTessProperty(tess.get(), GLU_TESS_BOUNDARY_ONLY, outline ? GL_TRUE : GL_FALSE);
    gluTessNormal(tess.get(), 0, 0, 1);
    gluTessCallback(tess.get(), GLU_TESS_BEGIN_DATA, asGluCallback(&beginContour));
    gluTessCallback(tess.get(), GLU_TESS_VERTEX_DATA, asGluCallback(&addOutputVertex));
    gluTessCallback(tess.get(), GLU_TESS_COMBINE_DATA, asGluCallback(&addCrossing));
    gluTessCallback(tess.get(), GLU_TESS_ERROR_DATA, asGluCallback(&recordFailure));
    if (!outline) gluTessCallback(tess.get(), GLU_TESS_EDGE_FLAG_DATA, asGluCallback(&ignoreEdgeFlag));
    gluTessBeginPolygon(tess.get(), &tessellation);
    for (const Contour& contour : contours) {
        gluTessBeginContour(tess.get());
        for (const glm::dvec2& p : contour) {
            tessellation.corners.push_back({{p.x, p.y, 0}, static_cast<std::uint32_t>(tessellation.corners.size())});
            gluTessVertex(tess.get(), tessellation.corners.back().first.data(), &tessellation.corners.back());
        }
        gluTessEndContour(tess.get());
    }
    gluTessEndPolygon(tess.get());
    return tessellation;
}

}  // namespace

std::vector<Contour> outlineOf(const std::vector<Contour>& contours) {
    TessellatorData tessellation = tessellate(contours, true);
    return tessellation.failed ? std::vector<Contour>{} : std::move(tessellation.contours);
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Contour>& contours) {
    const TessellatorData tessellation = tessellate(contours, false);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (tessellation.failed || tessellation.crossed) return triangles;
    for (std::size_t i = 0; i + 2 < tessellation.out.size(); i += 3)
        triangles.push_back({tessellation.out[i], tessellation.out[i + 1], tessellation.out[i + 2]});
    return triangles;
}

}  // namespace oval4d::exports

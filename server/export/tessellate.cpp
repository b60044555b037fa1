#include "export/tessellate.hpp"

#include <GL/glu.h>

#include <deque>
#include <memory>

namespace oval4d::exports {

namespace {

// GLU's tessellator calls back with the pointers that it was given, and with those that `join` makes where contours
// cross. It draws nothing and needs no OpenGL.
struct Work {
    std::deque<std::pair<std::array<double, 3>, std::uint32_t>> corners;  // stay where they are
    std::vector<std::uint32_t> out;
    std::vector<Contour> contours;
    bool crossed = false;
    bool failed = false;
};

using Corner = decltype(Work::corners)::value_type;

void begin(GLenum /*kind*/, void* to) { static_cast<Work*>(to)->contours.emplace_back(); }

void vertex(void* data, void* to) {
    auto* work = static_cast<Work*>(to);
    const auto* corner = static_cast<Corner*>(data);
    work->out.push_back(corner->second);
    work->contours.back().emplace_back(corner->first[0], corner->first[1]);
}

// Its presence asks for triangles only, without strips and fans.
void edgeFlag(GLboolean /*flag*/, void* /*to*/) {}

void join(GLdouble* at, void** /*joined*/, GLfloat* /*weights*/, void** made, void* to) {
    auto* work = static_cast<Work*>(to);
    work->crossed = true;
    work->corners.push_back({{at[0], at[1], at[2]}, 0xffffffffU});
    *made = &work->corners.back();
}

void fail(GLenum /*code*/, void* to) { static_cast<Work*>(to)->failed = true; }

template <typename Function>
_GLUfuncptr callback(Function* function) {
    return reinterpret_cast<_GLUfuncptr>(function);
}

Work tessellate(const std::vector<Contour>& contours, bool outline) {
    Work work;
    const std::unique_ptr<GLUtesselator, decltype(&gluDeleteTess)> tess(gluNewTess(), &gluDeleteTess);
    gluTessProperty(tess.get(), GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
    gluTessProperty(tess.get(), GLU_TESS_BOUNDARY_ONLY, outline ? GL_TRUE : GL_FALSE);
    gluTessNormal(tess.get(), 0, 0, 1);
    gluTessCallback(tess.get(), GLU_TESS_BEGIN_DATA, callback(&begin));
    gluTessCallback(tess.get(), GLU_TESS_VERTEX_DATA, callback(&vertex));
    gluTessCallback(tess.get(), GLU_TESS_COMBINE_DATA, callback(&join));
    gluTessCallback(tess.get(), GLU_TESS_ERROR_DATA, callback(&fail));
    if (!outline) gluTessCallback(tess.get(), GLU_TESS_EDGE_FLAG_DATA, callback(&edgeFlag));
    gluTessBeginPolygon(tess.get(), &work);
    for (const Contour& contour : contours) {
        gluTessBeginContour(tess.get());
        for (const glm::dvec2& p : contour) {
            work.corners.push_back({{p.x, p.y, 0}, static_cast<std::uint32_t>(work.corners.size())});
            gluTessVertex(tess.get(), work.corners.back().first.data(), &work.corners.back());
        }
        gluTessEndContour(tess.get());
    }
    gluTessEndPolygon(tess.get());
    return work;
}

}  // namespace

std::vector<Contour> outlineOf(const std::vector<Contour>& contours) {
    Work work = tessellate(contours, true);
    return work.failed ? std::vector<Contour>{} : std::move(work.contours);
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Contour>& contours) {
    const Work work = tessellate(contours, false);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (work.failed || work.crossed) return triangles;
    for (std::size_t i = 0; i + 2 < work.out.size(); i += 3)
        triangles.push_back({work.out[i], work.out[i + 1], work.out[i + 2]});
    return triangles;
}

}  // namespace oval4d::exports

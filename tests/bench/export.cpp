// Measures one of two things: how long exported files take, or how long it takes to fill the faces of a star's slices,
// in comparison with GLU's tessellator. Prints one line of JSON with the milliseconds of each turn. In a turn,
// everything that is compared runs once.
//   bench_export files [POLYTOPE] [TURNS]
//   bench_export faces [POLYTOPE] [TURNS]
// The slices are as in pictures.cpp: hyperplanes from w = −1 to 1 for a circumradius of 4/√10, and a double rotation.

#include <GL/glu.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/export_pipeline.hpp"
#include "session/object_loader.hpp"
#include "session/picture.hpp"
#include "session/query.hpp"
#include "slicing/fill.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::bench {
namespace {

using nlohmann::json;

template <typename Work>
double millisecondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

session::State stateOf(const std::string& polytope) {
    polytopes::PolytopeCache cache;
    session::ObjectLoader loader(session::Limits{}, cache);
    const auto read = session::stateFromQuery({{"polytope", polytope}, {"slices", "21"}}, session::Limits{}, loader);
    if (!read) throw std::runtime_error(read.error().message);
    session::State state = *read;
    state.slices.spacing = std::sqrt(10.0) / 4 * slicing::infoOf(state.object).circumradius / 10;
    state.orientation = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, 0.3, 0.2});
    return state;
}

/// A kind of file to export: its format, its contents and its body.
struct FileToExport {
    const char* format;
    exports::ExportContentsKind contents;
    exports::BodyKind body;
    const char* about;  ///< a description of the contents
};
constexpr FileToExport kFiles[] = {
    {"stl", exports::ExportContentsKind::oval, exports::BodyKind::solid, "21 solid slices"},
    {"3mf", exports::ExportContentsKind::oval, exports::BodyKind::solid, "21 solid slices"},
    {"glb", exports::ExportContentsKind::oval, exports::BodyKind::solid, "21 solid slices"},
    {"stl", exports::ExportContentsKind::focus, exports::BodyKind::skeleton, "balls and bars of the focus slice"},
    {"3mf", exports::ExportContentsKind::focus, exports::BodyKind::skeleton, "balls and bars of the focus slice"},
    {"glb", exports::ExportContentsKind::focus, exports::BodyKind::skeleton, "balls and bars of the focus slice"},
};

json files(const std::string& polytope, int turns) {
    const scene::PictureRequest picture = session::pictureRequestOf(stateOf(polytope));
    json rows = json::array();
    for (const FileToExport& file : kFiles) {
        rows.push_back({{"format", file.format}, {"about", file.about}, {"bytes", 0}, {"ms", json::array()}});
    }
    for (int turn = -1; turn < turns; ++turn) {  // turn −1 is the warm-up
        for (std::size_t i = 0; i < std::size(kFiles); ++i) {
            exports::ExportRequest request = exports::defaultRequestFor(*exports::formatNamed(kFiles[i].format));
            request.contents = kFiles[i].contents;
            request.body = kFiles[i].body;
            std::size_t bytes = 0;
            const double time = millisecondsOf([&] {
                const auto exported = pipeline::exportFile(picture, request, exports::ExportLimits{});
                if (!exported) throw std::runtime_error(exported.error().message);
                bytes = exported->bytes.size();
            });
            if (turn < 0) continue;
            rows[i]["ms"].push_back(time);
            rows[i]["bytes"] = bytes;
        }
    }
    return rows;
}

/// Fills the faces of slices with GLU's tessellator. Uses the nonzero winding rule, like slicing::FaceFiller. Keeps its
/// memory and the tessellator between calls.
class GluFiller {
  public:
    GluFiller() : tess_(gluNewTess(), &gluDeleteTess) {
        if (!tess_) throw std::runtime_error("GLU has no tessellator");
        gluTessProperty(tess_.get(), GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
        gluTessCallback(tess_.get(), GLU_TESS_BEGIN_DATA, callback(&begin));
        gluTessCallback(tess_.get(), GLU_TESS_VERTEX_DATA, callback(&vertex));
        gluTessCallback(tess_.get(), GLU_TESS_COMBINE_DATA, callback(&combine));
        gluTessCallback(tess_.get(), GLU_TESS_ERROR_DATA, callback(&fail));
    }

    /// Fills all faces of the slices. Overwrites the result of the previous call.
    void fill(const slicing::SliceSet& slices) {
        groups_.clear();
        out_.clear();
        failures_ = 0;
        for (std::size_t slice = 0; slice + 1 < slices.faceBegin.size(); ++slice) {
            const std::uint32_t last = slices.faceBegin[slice + 1];
            for (std::uint32_t first = slices.faceBegin[slice], end = first; first < last; first = end) {
                while (end < last && slices.faceSource[end] == slices.faceSource[first]) ++end;
                fillFace(slices, slice, first, end);
            }
        }
    }

    double area() const {
        double sum = 0;
        forEachTriangle([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
            sum += glm::length(glm::cross(b - a, c - a)) / 2;
        });
        return sum;
    }
    std::size_t triangleCount() const {
        std::size_t count = 0;
        forEachTriangle([&](const glm::dvec3&, const glm::dvec3&, const glm::dvec3&) { ++count; });
        return count;
    }
    /// Returns how often the tessellator has reported an error.
    int failures() const { return failures_; }

  private:
    // A group of triangles of one kind. Its corners are in `out_` from the index `begin` to the start of the next
    // group. `kind` is GL_TRIANGLES, GL_TRIANGLE_FAN or GL_TRIANGLE_STRIP.
    struct Group {
        GLenum kind;
        std::size_t begin;
    };
    using Corner = std::array<GLdouble, 3>;

    template <typename Function>
    static _GLUfuncptr callback(Function* function) {
        return reinterpret_cast<_GLUfuncptr>(function);
    }
    static void begin(GLenum kind, void* to) {
        auto* filler = static_cast<GluFiller*>(to);
        filler->groups_.push_back({kind, filler->out_.size()});
    }
    static void vertex(void* data, void* to) {
        const Corner& corner = *static_cast<const Corner*>(data);
        static_cast<GluFiller*>(to)->out_.emplace_back(corner[0], corner[1], corner[2]);
    }
    static void combine(GLdouble* at, void** /*joined*/, GLfloat* /*weights*/, void** made, void* to) {
        std::deque<Corner>& corners = static_cast<GluFiller*>(to)->corners_;
        corners.push_back({at[0], at[1], at[2]});
        *made = &corners.back();
    }
    static void fail(GLenum /*code*/, void* to) { ++static_cast<GluFiller*>(to)->failures_; }

    void fillFace(const slicing::SliceSet& slices, std::size_t slice, std::uint32_t first, std::uint32_t end) {
        corners_.clear();
        gluTessBeginPolygon(tess_.get(), this);
        for (std::uint32_t loop = first; loop < end; ++loop) {
            gluTessBeginContour(tess_.get());
            for (std::uint32_t i = slices.cornerBegin[loop]; i < slices.cornerBegin[loop + 1]; ++i) {
                const glm::dvec3& p = slices.vertices[slices.vertexBegin[slice] + slices.corners[i]];
                corners_.push_back({p.x, p.y, p.z});
                gluTessVertex(tess_.get(), corners_.back().data(), &corners_.back());
            }
            gluTessEndContour(tess_.get());
        }
        gluTessEndPolygon(tess_.get());
    }

    template <typename Visit>
    void forEachTriangle(Visit&& visit) const {
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const std::size_t start = groups_[g].begin;
            const std::size_t end = g + 1 < groups_.size() ? groups_[g + 1].begin : out_.size();
            const std::size_t step = groups_[g].kind == GL_TRIANGLES ? 3 : 1;
            for (std::size_t i = start; i + 2 < end; i += step)
                visit(out_[groups_[g].kind == GL_TRIANGLE_FAN ? start : i], out_[i + 1], out_[i + 2]);
        }
    }

    const std::unique_ptr<GLUtesselator, decltype(&gluDeleteTess)> tess_;
    std::deque<Corner> corners_;  // of the current face; a deque, because the tessellator keeps pointers to them
    std::vector<Group> groups_;
    std::vector<glm::dvec3> out_;
    int failures_ = 0;
};

double areaOf(const slicing::FilledFaces& filled) {
    double sum = 0;
    for (std::size_t piece = 0; piece + 1 < filled.cornerBegin.size(); ++piece) {
        const glm::dvec3& apex = filled.corners[filled.cornerBegin[piece]];
        glm::dvec3 area(0);
        for (std::uint32_t i = filled.cornerBegin[piece] + 2; i < filled.cornerBegin[piece + 1]; ++i)
            area += glm::cross(filled.corners[i - 1] - apex, filled.corners[i] - apex);
        sum += glm::length(area) / 2;
    }
    return sum;
}

json faces(const std::string& polytope, int turns) {
    const session::State state = stateOf(polytope);
    const double circumradius = slicing::infoOf(state.object).circumradius;
    slicing::SliceSet slices;
    slicing::Slicer().sliceWithoutSurfaces(state.object, state.orientation, state.hyperplanes(), slices);
    slicing::FaceFiller ours;
    slicing::FilledFaces filled;
    GluFiller glu;
    std::vector<double> ourTimes, gluTimes;
    for (int turn = -1; turn < turns; ++turn) {  // turn −1 is the warm-up
        const double ourTime = millisecondsOf([&] { ours.fill(slices, circumradius, filled); });
        const double gluTime = millisecondsOf([&] { glu.fill(slices); });
        if (turn < 0) continue;
        ourTimes.push_back(ourTime);
        gluTimes.push_back(gluTime);
    }
    const std::size_t pieces = filled.cornerBegin.size() - 1;
    const double area = areaOf(filled);
    return {{"faces", filled.faces.size()},
            {"sides", slices.corners.size()},
            {"ms", {{"ours", ourTimes}, {"glu", gluTimes}}},
            {"triangles", {{"ours", filled.corners.size() - 2 * pieces}, {"glu", glu.triangleCount()}}},
            {"area_difference", std::abs(glu.area() - area) / area},
            {"glu_failures", glu.failures()}};
}

}  // namespace
}  // namespace oval4d::bench

int main(int argc, char** argv) {
    try {
        const std::string what = argc > 1 ? argv[1] : "";
        const int turns = argc > 3 ? std::atoi(argv[3]) : 11;
        if (what == "files") {
            std::puts(oval4d::bench::files(argc > 2 ? argv[2] : "120-cell", turns).dump().c_str());
        } else if (what == "faces") {
            std::puts(oval4d::bench::faces(argc > 2 ? argv[2] : "small stellated 120-cell", turns).dump().c_str());
        } else {
            throw std::runtime_error("the first argument is files or faces");
        }
    } catch (const std::exception& fault) {
        std::fprintf(stderr, "export: %s\n", fault.what());
        return 1;
    }
}

#include "export/export.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>

#include "export/budget.hpp"
#include "export/frame.hpp"
#include "export/label.hpp"
#include "export/layout.hpp"
#include "export/mesh_formats.hpp"
#include "export/solid.hpp"
#include "export/text.hpp"
#include "export/text_formats.hpp"
#include "geometry/slicer.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

namespace {

// The cubes of a frame's mesh, in radii of a bar: fine while the file stays below this size, then up to coarse ones.
constexpr double kFineCube = 0.5;
constexpr double kCoarseCube = 1;
constexpr double kComfortable = 600'000;  // triangles

class Exporter {
  public:
    Exporter(const Subject& subject, const Wish& wish, const Budget& budget)
        : polytope_(subject.polytope),
          subject_(subject),
          wish_(wish),
          budget_(budget),
          scale_(wish.size / 2 / subject.polytope.circumradius),
          grid_(wish.size, wish.of == Extent::oval ? reachOf(subject.planes.count, wish.size) : 2 * wish.size) {
        auto planes = subject.planes;
        if (wish.of == Extent::focus) planes = {subject.focus, 1, planes.spacing};
        geometry::Slicer().slice(polytope_, subject.orientation, planes, slices_);
    }

    std::string run() {
        switch (wish_.format) {
            case Format::off:
                return off(polytope_, slices_);
            case Format::csv:
                return csv(polytope_, slices_);
            case Format::svg:
                return svg(polytope_, slices_);
            default:
                return write(bodies());
        }
    }

  private:
    std::vector<Solid> bodies() {
        std::vector<Group> groups;
        const auto colour = wish_.body == Body::frame ? scene::style().bar : scene::style().ball;
        std::size_t triangles = 0;
        if (wish_.body == Body::frame) prepareFrame();
        for (int i = 0; i < slices_.planes.count; ++i) {
            budget_.checkTime();
            Mesh mesh = wish_.body == Body::frame ? frameOf(slices_, i, scale_, thickness_, cube_, grid_, budget_)
                                                  : solidOf(slices_, i, scale_, grid_, budget_);
            if (mesh.triangles.empty()) continue;
            triangles += mesh.triangles.size();
            budget_.checkTriangles(triangles);
            groups.push_back({i, {{nameOf(i), std::move(mesh), colour, glm::dvec3(0)}}});
        }
        if (groups.empty()) refuseEmpty();
        if (wish_.label != Label::none) label(groups);
        if (wish_.format == Format::stl || wish_.format == Format::three_mf) {
            standOnPlate(groups, wish_.size, grid_);
        } else if (wish_.of == Extent::oval) {
            standInOval(groups, polytope_, slices_.planes, subject_.focus, wish_.size, grid_);
        }
        std::vector<Solid> solids;
        for (Group& group : groups) std::ranges::move(group.solids, std::back_inserter(solids));
        return solids;
    }

    void label(std::vector<Group>& groups) const {
        std::size_t done = 0;
        for (Group& group : groups) {
            budget_.checkTime();
            const Caption text(polytope_.name, wOf(group.slice));
            if (wish_.label == Label::engraved) {
                done += text.engrave(group.solids.front().mesh, wish_.size, grid_) ? 1 : 0;
                continue;
            }
            const Box box = boxOf(group.solids.front().mesh);
            const glm::dvec3 front{(box.least.x + box.most.x) / 2, box.least.y - wish_.size / 12, box.least.z};
            group.solids.push_back({group.solids.front().name + " (label)", text.plate(wish_.size, grid_),
                                    scene::style().bar, grid_.snap(front)});
            ++done;
        }
        if (done == 0) {
            throw Refused{{Refusal::Cause::no_body,
                           wish_.body == Body::frame
                               ? "balls and bars have no face to engrave; ask for a separate label"
                               : "no face is flat and large enough for letters of 1 mm; ask for a separate label or a "
                                 "larger size"}};
        }
    }

    void prepareFrame() {
        thickness_ = thicknessFor(polytope_, scale_);
        const double coarse = coarseTriangles(slices_, scale_, thickness_);
        const double allowed = std::min(kComfortable, static_cast<double>(budget_.triangles()));
        const double cube = std::clamp(std::sqrt(coarse / allowed), kFineCube, kCoarseCube);
        budget_.checkTriangles(static_cast<std::size_t>(coarse / (cube * cube)));
        cube_ = cube * thickness_.bar;
    }

    std::string write(const std::vector<Solid>& solids) const {
        std::vector<scene::Colour> colours;
        scene::CellColours().paint(polytope_, subject_.colouring, subject_.orientation, colours);
        switch (wish_.format) {
            case Format::three_mf:
                return threeMf(solids, polytope_.name, budget_);
            case Format::obj:
                return obj(solids);
            case Format::ply:
                return ply(solids, colours);
            case Format::glb:
                return glb(solids, colours);
            default:
                return stl(solids);
        }
    }

    std::string nameOf(int i) const { return polytope_.name + ", " + wOf(i); }
    std::string wOf(int i) const { return labelOfW(slices_.planes.w(i), slices_.planes.spacing); }

    [[noreturn]] void refuseEmpty() const {
        double least = 1e300;
        double most = -1e300;
        for (const glm::dvec4& v : slices_.turned) {
            least = std::min(least, v.w);
            most = std::max(most, v.w);
        }
        std::string reach;
        append(reach, least);
        reach += " to ";
        append(reach, most);
        const bool many = slices_.planes.count > 1;
        std::string message = many ? "no slice has a body" : "the slice at ";
        if (!many) {
            message += wOf(0);
            message += slices_.vertices.empty() ? " is empty" : " has no thickness";
        }
        throw Refused{{Refusal::Cause::no_body, message + ": the polytope reaches from w = " + reach +
                                                    "; move the focus, or turn the polytope"}};
    }

    const geometry::Polytope& polytope_;
    const Subject& subject_;
    const Wish& wish_;
    const Budget& budget_;
    const double scale_;  // millimetres to the polytope's unit
    const Grid grid_;
    geometry::SliceSet slices_;
    Thickness thickness_;
    double cube_ = 0;
};

}  // namespace

std::variant<std::string, Refusal> fileOf(const Subject& subject, const Wish& wish, const Limits& limits,
                                          std::stop_token stop) {
    const Budget budget(limits, std::move(stop));
    try {
        std::string bytes = Exporter(subject, wish, budget).run();
        budget.checkBytes(bytes.size());
        return bytes;
    } catch (Refused& refused) {
        return std::move(refused.refusal);
    }
}

}  // namespace oval4d::exports

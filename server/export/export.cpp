#include "export/export.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>

#include "export/arrangement.hpp"
#include "export/drawing/coordinates_drawing.hpp"
#include "export/drawing/matrix_drawing.hpp"
#include "export/drawing/projection_drawing.hpp"
#include "export/drawing/slices_drawing.hpp"
#include "export/formats/formats.hpp"
#include "export/formats/text.hpp"
#include "export/label/label.hpp"
#include "export/mesh/field_body.hpp"
#include "export/mesh/field_surfaces.hpp"
#include "export/mesh/marching.hpp"
#include "export/mesh/skeleton.hpp"
#include "export/mesh/solid.hpp"
#include "export/omissions.hpp"
#include "fields/field.hpp"
#include "slicing/element.hpp"
#include "text/message_text.hpp"

namespace oval4d::exports {

namespace {

// The least and the greatest width of the cubes from which skeletons are meshed, as multiples of the bar radius. Cubes
// have the least width, unless they would then give more than kTargetTriangles triangles, or be narrower than
// kGoodFieldStep grid steps (see marching.hpp). In these cases, they are wider.
constexpr double kFineCube = 0.5;
constexpr double kCoarseCube = 1;
constexpr double kTargetTriangles = 600'000;

// Returns an upper bound of the absolute coordinates in the file, in millimeters, for RoundingGrid. If the file does
// not contain an oval, it contains one object or slice with a diameter of about `size`. Then the bound 2 · size leaves
// room for balls, bars, a separate label, and the place of the body on the plate of a printer.
double coordinateBoundOf(const ExportRequest& request, int slices) {
    return request.contents == ExportContentsKind::oval ? coordinateBound(slices, request.size) : 2 * request.size;
}

class Exporter {
  public:
    Exporter(const scene::Scene& scene, const slicing::Object& object, const geometry::Rotation& orientation,
             const ExportRequest& request, const ExportBudget& budget)
        : scene_(scene),
          slices_(*scene.slices),
          object_(object),
          orientation_(orientation),
          request_(request),
          budget_(budget),
          scale_(request.size / 2 / scene.circumradius),
          grid_(request.size, coordinateBoundOf(request, slices_.planes.count)),
          surfaceGrid_(
              request.exact && request.format->keepsDoubles
                  ? RoundingGrid::forDoublePrecision(request.size, coordinateBoundOf(request, slices_.planes.count))
                  : grid_) {
        if (request.contents == ExportContentsKind::projection) request_.body = BodyKind::skeleton;
        if (request.contents == ExportContentsKind::highlight) element_ = scene.look.highlight;
        hasSurfaces_ = slicing::fieldIn(object) != nullptr && request_.body == BodyKind::solid && !element_;
    }

    ExportedFile exportFile() {
        std::string bytes = writeBytes();
        budget_.checkFileSize(bytes.size());
        return {std::move(bytes), std::move(warnings_)};
    }

  private:
    std::string writeBytes() {
        const Format& format = *request_.format;
        refuseUnsupportedContents();
        if (format.writeDrawing != nullptr) return format.writeDrawing(drawAtRequestedSize());
        refuseUnsupportedObjects();
        if (format.writeScene != nullptr)
            return format.writeScene(
                {scene_, object_, orientation_, request_.contents, budget_, warnings_, request_.exact});
        const std::vector<PlacedMesh> solids = makeBodies();
        const bool hasDoubles = hasSurfaces_ && request_.exact && format.keepsDoubles;
        return format.writeBodies({solids, scene_.cellColors, scene_.title, budget_, hasDoubles});
    }

    Drawing draw() const {
        switch (request_.contents) {
            case ExportContentsKind::projection:
                return drawProjection(scene_);
            case ExportContentsKind::matrix:
                return drawMatrix(scene_, originInFile());
            case ExportContentsKind::oval:
            case ExportContentsKind::focus:
                return drawSlices(scene_, object_, budget_);
            default:
                return drawCoordinates(scene_, object_, orientation_);
        }
    }

    Drawing drawAtRequestedSize() const {
        Drawing drawn = draw();
        drawn.size = request_.size;
        return drawn;
    }

    std::vector<PlacedMesh> makeBodies() {
        std::vector<SliceBodies> groups;
        std::vector<int> empty, thin;  // slices that the file lacks, because they are empty or too thin for a body
        const scene::Color color = request_.body == BodyKind::skeleton ? scene::style().bar : colorOfSolids();
        std::size_t triangles = 0;
        if (request_.body == BodyKind::skeleton) chooseSkeletonResolution();
        if (hasSurfaces_) createSurfaceSource();
        for (int i = 0; i < slices_.planes.count; ++i) {
            budget_.checkTimeAndStop();
            std::vector<PlacedMesh> solids;
            if (hasSurfaces_) {
                solids = fieldBodiesOfSlice(i);
            } else {
                Mesh mesh = request_.body == BodyKind::skeleton
                                ? skeletonOf(slices_, i, scale_, radii_, cube_, grid_, budget_)
                                : solidOf(slices_, i, scale_, grid_, budget_);
                if (!mesh.triangles.empty()) solids.push_back({bodyNameOf(i), std::move(mesh), color, glm::dvec3(0)});
            }
            if (solids.empty()) {
                (isEmpty(i) ? empty : thin).push_back(i);
                continue;
            }
            for (const PlacedMesh& solid : solids) triangles += solid.mesh.triangles.size();
            budget_.checkTrianglesAndMemory(triangles);
            groups.push_back({i, std::move(solids)});
        }
        if (groups.empty() && element_) refuseFlatElement();
        if (groups.empty()) throwEmptyExport();
        if (!empty.empty()) warnings_.push_back(omittedSlicesWarning(slices_.planes, empty, "empty", originInFile().w));
        if (!thin.empty())
            warnings_.push_back(omittedSlicesWarning(slices_.planes, thin, "flat or too thin", originInFile().w));
        if (request_.label != LabelPlacement::none) addLabels(groups);
        if (request_.format->arrangement == Format::BodyArrangement::plate) {
            arrangeOnPlate(groups, request_.size, grid_);
        } else if (request_.contents == ExportContentsKind::oval) {
            arrangeInOval(groups, scene_, request_.size, grid_);
        }
        std::vector<PlacedMesh> solids;
        for (SliceBodies& group : groups) std::ranges::move(group.bodies, std::back_inserter(solids));
        return solids;
    }

    /// Returns the color of solid bodies. In formats with the colors of cells, only triangles that were cut from no
    /// cell have this color.
    scene::Color colorOfSolids() const {
        const bool isCell = element_ && element_->kind == slicing::ElementKind::cell;
        return isCell ? scene_.cellColors[element_->index] : scene::style().ball;
    }

    /// Returns whether slice i has nothing to export: no point of the object or, for bodies of a field, no surface. For
    /// bodies of a field, the last call of fieldBodiesOfSlice() must have been for slice i.
    bool isEmpty(int i) const {
        if (hasSurfaces_) return lastSurfaceIsEmpty_;
        return slices_.vertexCount(i) == 0;
    }

    /// Returns whether the file, because it is for a printer, has only the body of the outermost level of a field.
    bool hasOneLevel() const { return request_.format->arrangement == Format::BodyArrangement::plate; }

    void createSurfaceSource() {
        const fields::Field& field = *slicing::fieldIn(object_);
        if (hasOneLevel() && !scene_.surfaces.levels.empty()) {
            surfaces_.emplace(scene_, field, orientation_, request_.exact,
                              std::vector{scene_.surfaces.levels.back().index}, budget_);
        } else {
            surfaces_.emplace(scene_, field, orientation_, request_.exact, budget_);
        }
    }

    /// Returns the bodies of one slice of a field, from the outermost level to the innermost. If hasOneLevel(), returns
    /// only the body of the outermost level, which contains the others. Leaves out levels without a body.
    std::vector<PlacedMesh> fieldBodiesOfSlice(int i) {
        const auto& levels = scene_.surfaces.levels;
        const FieldSliceSurface slice = surfaces_->surfaceOfSlice(i);
        lastSurfaceIsEmpty_ = slice.surface.triangles.empty();
        std::vector<PlacedMesh> solids;
        for (std::size_t level = levels.size(); level-- > 0;) {
            std::string name = bodyNameOf(i);
            if (levels.size() > 1) appendDecimal(name += ", level ", scene_.look.field.levels[levels[level].index]);
            Mesh mesh = fieldBodyOf(scene_, slice, i, level, scale_, surfaceGrid_, budget_);
            if (!mesh.triangles.empty())
                solids.push_back({std::move(name), std::move(mesh), levels[level].color, glm::dvec3(0)});
            if (hasOneLevel()) break;
        }
        return solids;
    }

    void addLabels(std::vector<SliceBodies>& groups) {
        if (hasSurfaces_ && request_.label == LabelPlacement::engraved) {
            throw ExportRefused{{ExportRefusal::Cause::no_body,
                                 "the surface of a field has no face to engrave; choose a separate label"}};
        }
        std::size_t done = 0;
        for (SliceBodies& group : groups) {
            budget_.checkTimeAndStop();
            const LabelText text(scene_.title, bodyLabelOf(group.slice));
            if (request_.label == LabelPlacement::engraved) {
                done += text.engrave(group.bodies.front().mesh, request_.size, grid_, budget_) ? 1 : 0;
                continue;
            }
            const BoundingBox box = boundingBoxOf(group.bodies.front().mesh);
            const glm::dvec3 front{(box.min.x + box.max.x) / 2, box.min.y - request_.size / 12, box.min.z};
            group.bodies.push_back({group.bodies.front().name + " (label)", text.makeLabelPlate(request_.size, grid_),
                                    scene::style().bar, grid_.snap(front)});
            ++done;
        }
        if (done == 0) {
            throw ExportRefused{
                {ExportRefusal::Cause::no_body,
                 request_.body == BodyKind::skeleton
                     ? "balls and bars have no face to engrave; choose a separate label"
                     : "no face is flat and large enough for letters of 1 mm; choose a separate label or a "
                       "larger size"}};
        }
        if (done < groups.size()) {
            warnings_.push_back("only " + std::to_string(done) + " of " + std::to_string(groups.size()) +
                                " bodies have a label, because the others have no face that is flat and large enough");
        }
    }

    void chooseSkeletonResolution() {
        radii_ = skeletonRadii(scene_, scale_);
        const double coarse = estimateSkeletonTriangles(slices_, scale_, radii_);
        const double allowed = std::min(kTargetTriangles, static_cast<double>(budget_.triangleLimit()));
        const double cube = std::clamp(std::sqrt(coarse / allowed), kFineCube, kCoarseCube);
        budget_.checkTrianglesAndMemory(static_cast<std::size_t>(coarse / (cube * cube)));
        const double largest = kCoarseCube * radii_.bar;
        if (largest < kLeastFieldStep * grid_.step()) {
            throw ExportRefused{{ExportRefusal::Cause::no_body,
                                 std::string("the bars of this object are too thin for a file; export a larger body") +
                                     (hasCells() ? ", or a solid one (body=solid)" : "")}};
        }
        cube_ = std::max(cube * radii_.bar, std::min(largest, kGoodFieldStep * grid_.step()));
    }

    std::string bodyNameOf(int i) const { return scene_.title + ", " + bodyLabelOf(i); }
    std::string bodyLabelOf(int i) const {
        if (element_) return nameOfElement();
        return request_.contents == ExportContentsKind::projection ? "projection"
                                                                   : labelOfW(slices_.planes, i, originInFile().w);
    }
    std::string nameOfElement() const {
        return std::string(text::nameOf(slicing::kElementKinds, element_->kind)) + ' ' +
               std::to_string(element_->index);
    }
    slicing::ObjectKindProperties objectProperties() const { return slicing::propertiesOf(object_); }
    bool hasCells() const { return slicing::elementCount(object_, slicing::ElementKind::cell) > 0; }
    const glm::dvec4& originInFile() const { return slicing::infoOf(object_).originInFile; }

    void refuseUnsupportedContents() const {
        if (request_.format->canContain(request_.contents)) return;
        std::vector<std::string_view> own, formatsWithIt;
        for (const ExportContentsKind contents : request_.format->contents)
            own.push_back(text::nameOf(kExportContents, contents));
        for (const Format& format : formats()) {
            if (format.canContain(request_.contents)) formatsWithIt.emplace_back(format.name);
        }
        const std::string asked(text::nameOf(kExportContents, request_.contents));
        throw ExportRefused{{ExportRefusal::Cause::no_body, request_.format->name + " files contain " +
                                                                text::joinedWithOr(own) + ", not " + asked + "; " +
                                                                text::joinedWithOr(formatsWithIt) + " files do"}};
    }

    void refuseUnsupportedObjects() const {
        const Format& format = *request_.format;
        const bool isField = slicing::fieldIn(object_) != nullptr;
        if (isField && format.objects == Format::ObjectKinds::polytopes_and_points) {
            throw ExportRefused{
                {ExportRefusal::Cause::no_body, format.name + " files contain polytopes or points, and a field has "
                                                              "none; choose another format, such as stl or vtp"}};
        }
        if (!isField && format.objects == Format::ObjectKinds::fields) {
            throw ExportRefused{
                {ExportRefusal::Cause::no_body, format.name + " files contain the values of a field; choose another "
                                                              "format, such as stl or vtp"}};
        }
    }

    [[noreturn]] void refuseFlatElement() const {
        const bool isCell = element_->kind == slicing::ElementKind::cell;
        throw ExportRefused{{ExportRefusal::Cause::no_body, nameOfElement() + " has no volume" +
                                                                (isCell ? ", or too little for this size" : "") +
                                                                "; choose body=skeleton, its balls and bars"}};
    }
    /// Throws ExportRefused, with `message` and the reason, if the whole polytope is at most kFewSteps grid steps
    /// large. This happens if the polytope is small and far from the origin, because ExportRequest::size is the
    /// diameter of a sphere around the origin.
    void refuseIfPolytopeTiny(const std::string& message) const {
        constexpr double kFewSteps = 8;
        BoundingBox box;
        for (const glm::dvec4& v : slices_.rotatedVertices) box.include(scale_ * glm::dvec3(v));
        const glm::dvec3 size = box.size();
        const double largest = std::max({size.x, size.y, size.z});
        if (objectProperties().slices == slicing::SliceContent::points || slices_.vertices.empty() ||
            largest > kFewSteps * grid_.step())
            return;
        throw ExportRefused{{ExportRefusal::Cause::no_body,
                             message + ": the polytope is too small in comparison with its distance from the origin; "
                                       "load it with center=object"}};
    }

    /// Throws ExportRefused if slices of objects of this kind have no volume.
    void refuseSlicesWithoutVolume() const {
        switch (objectProperties().slices) {
            case slicing::SliceContent::points:
                throw ExportRefused{{ExportRefusal::Cause::no_body,
                                     "points have no volume; choose body=skeleton, whose balls are the points"}};
            case slicing::SliceContent::curves:
                throw ExportRefused{{ExportRefusal::Cause::no_body,
                                     "the object has no cells, so its slices are curves, which have no volume; choose "
                                     "body=skeleton, whose bars are the curves"}};
            case slicing::SliceContent::solids:
            case slicing::SliceContent::level_surfaces:
                break;
        }
    }

    [[noreturn]] void throwEmptyExport() const {
        double least = 1e300;
        double most = -1e300;
        for (const glm::dvec4& v : slices_.rotatedVertices) {
            least = std::min(least, v.w);
            most = std::max(most, v.w);
        }
        if (request_.body == BodyKind::solid) refuseSlicesWithoutVolume();
        const std::string reach =
            text::roundedDecimal(originInFile().w + least) + " to " + text::roundedDecimal(originInFile().w + most);
        const bool many = slices_.planes.count > 1;
        const bool isField = slicing::fieldIn(object_) != nullptr;
        const std::string noun(objectProperties().noun);
        std::string message = many ? "no slice has a volume" : "the slice at ";
        if (!many) {
            message += bodyLabelOf(0);
            message += slices_.vertices.empty() ? " is empty" : " has no volume";
        }
        refuseIfPolytopeTiny(message);
        const std::string advice = request_.choosesSlices() ? "choose other slices" : "move the focus";
        throw ExportRefused{{ExportRefusal::Cause::no_body,
                             message + ": the " + (isField ? "box of the field" : noun) +
                                 (objectProperties().isPlural ? " extend" : " extends") + " from w = " + reach + "; " +
                                 (isField ? "change the levels, " : "") + advice + " or turn the " + noun}};
    }

    const scene::Scene& scene_;
    const slicing::SliceSet& slices_;
    const slicing::Object& object_;
    const geometry::Rotation& orientation_;
    ExportRequest request_;
    const ExportBudget& budget_;
    const double scale_;  // millimeters per unit of the object
    const RoundingGrid grid_;
    const RoundingGrid surfaceGrid_;           // for the surfaces of a field: finer than grid_ in files with doubles
    std::optional<slicing::Element> element_;  // for ExportContentsKind::highlight: the element to export; else empty
    SkeletonRadii radii_;
    double cube_ = 0;
    bool hasSurfaces_ = false;  // whether the bodies are those that the surfaces of a field enclose
    std::optional<FieldSurfaceSource> surfaces_;
    bool lastSurfaceIsEmpty_ =
        false;  // whether the slice for which fieldBodiesOfSlice() was called last has no surface
    std::vector<std::string> warnings_;
};

}  // namespace

std::variant<ExportedFile, ExportRefusal> exportScene(const scene::Scene& scene, const slicing::Object& object,
                                                      const geometry::Rotation& orientation,
                                                      const ExportRequest& request, const ExportLimits& limits,
                                                      std::stop_token stop) {
    const ExportBudget budget(limits, std::move(stop));
    std::variant<ExportedFile, ExportRefusal> made;
    try {
        made = Exporter(scene, object, orientation, request, budget).exportFile();
    } catch (ExportRefused& refused) {
        made = std::move(refused.error);
    }
    if (const fields::Field* const field = slicing::fieldIn(object)) field->requireReadable();
    return made;
}

}  // namespace oval4d::exports

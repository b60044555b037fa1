#include "export/formats/writers.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "export/formats/text.hpp"
#include "export/mesh/exact_slicer.hpp"
#include "export/mesh/measure.hpp"
#include "fields/axis_units.hpp"
#include "fields/field.hpp"
#include "slicing/closed_surfaces/closed_surface.hpp"
#include "slicing/critical/critical_sections.hpp"
#include "slicing/element.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/surfaces/section_values.hpp"
#include "slicing/surfaces/surface_measurements.hpp"

namespace oval4d::exports {

namespace {

// Appends the row of slice i of an object that is not a field. `origin` is ObjectInfo::originInFile, and is added to w
// and to the centroid.
void appendSliceRow(std::string& out, const slicing::SliceSet& slices, const glm::dvec4& origin, int i) {
    const SliceMeasurements m = measureSlice(slices, i);
    out += std::to_string(slices.planes.first + i) + ',';
    appendDecimal(out, origin.w + slices.planes.w(i));
    for (const std::size_t count : {slices.vertexCount(i), slices.edgeCount(i), m.faces})
        out += ',' + std::to_string(count);
    for (const double number : {m.volume, m.area}) {
        out += ',';
        appendDecimal(out, number);
    }
    for (int axis = 0; axis < 3; ++axis) {
        out += ',';
        if (m.hasCentroid) appendDecimal(out, origin[axis] + m.centroid[axis]);
    }
    out += "\n";
}

void appendMeasurements(std::string& out, const slicing::SurfaceMeasurements& m) {
    for (const double number : {m.volume, m.area}) {
        out += ',';
        appendDecimal(out, number);
    }
    for (int axis = 0; axis < 3; ++axis) {
        out += ',';
        if (m.centroid) appendDecimal(out, (*m.centroid)[axis]);
    }
    out += ',' + std::to_string(m.components) + ',' + std::to_string(m.euler);
}

// Returns a text as a cell of a CSV table: in quotation marks, with quotation marks inside doubled (RFC 4180, section
// 2). Puts an apostrophe before a text that begins with =, +, - or @, because spreadsheets would read such a text as a
// formula.
std::string csvCell(const std::string& text) {
    std::string cell = "\"";
    if (text.find_first_of("=+-@") == 0) cell += '\'';
    for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
    return cell + '"';
}

/// The columns at the end of a table that state the units of other columns, as far as the units are known. All rows
/// have the same cells in these columns.
struct UnitColumns {
    std::string names, cells;  ///< the names and cells of all columns, each after a comma

    void add(std::string_view name, const std::string& unit) {
        if (unit.empty()) return;
        (names += ',').append(name);
        (cells += ',') += csvCell(unit);
    }
};

std::string unitOfW(const scene::Scene& scene) {
    const fields::PictureAxisUnit& unit = scene.axisUnits[3];
    return unit.isToScale ? unit.text : std::string();
}

/// The column for a coordinate in the field's box that all points of a slice have in common, such as x after a rotation
/// by 90° in xw. The column is called "box_x", "box_y", "box_z" or "box_w". A table has this column only if there is
/// such a coordinate, and if it does not always equal the slice's w.
class ConstantSliceCoordinateColumn {
  public:
    ConstantSliceCoordinateColumn(const fields::Field& field, const SceneToWrite& source)
        : common_(fields::constantSliceCoordinate(field, source.orientation)) {
        if (common_ && common_->isW()) common_.reset();
        if (!common_) return;
        name_ = std::string("box_") + "xyzw"[common_->axis];
        unit_ = field.units.at(static_cast<std::size_t>(common_->axis));
    }
    void addNameAndUnit(std::string& header, UnitColumns& units) const {
        if (!common_) return;
        header += ',' + name_;
        units.add(name_ + "_unit", unit_);
    }
    void addCell(std::string& row, double w) const {
        if (common_) appendDecimal(row += ',', common_->coordinateAt(w));
    }

  private:
    std::optional<fields::ConstantSliceCoordinate> common_;
    std::string name_, unit_;
};

std::string fieldMeasurementsCsv(const SceneToWrite& source, const fields::Field& field) {
    const geometry::Hyperplanes& planes = source.scene.slices->planes;
    const slicing::FieldSettings& settings = source.scene.look.field;
    const bool hasLevels = settings.levels.size() > 1;
    std::string out = hasLevels ? "n,w,level," : "n,w,";
    out += "volume,area,centroid_x,centroid_y,centroid_z,components,euler";
    if (field.second) out += ",mean_second_value";
    UnitColumns units;
    units.add("w_unit", unitOfW(source.scene));
    const ConstantSliceCoordinateColumn common(field, source);
    common.addNameAndUnit(out, units);
    units.add("length_unit", fields::lengthUnit(source.scene.axisUnits));
    units.add("level_unit", field.quantity.unit);
    if (field.second) units.add("mean_second_value_unit", field.second->quantity.unit);
    out += units.names + '\n';
    const glm::dmat4 toFunction = field.toFunction * source.orientation.inverse().matrix();
    slicing::FieldSection section;
    std::vector<float> values;
    ExactFieldSlicer slicer(field, source.orientation, {.inside = settings.inside}, source.budget);
    slicing::ClosedSurface surface;
    for (int i = 0; i < planes.count; ++i) {
        for (const double level : settings.levels) {
            slicer.slice(planes.w(i), level, 0, surface);
            out += std::to_string(planes.first + i) + ',';
            appendDecimal(out, planes.w(i));
            if (hasLevels) appendDecimal(out += ',', level);
            appendMeasurements(out, slicing::measureSurface(surface));
            if (field.second) {
                slicing::placeSection(field, toFunction, planes.w(i), section);
                slicing::evaluateInSection(*field.second->function, section, std::span(std::as_const(surface.points)),
                                           values);
                field.second->function->releasePages();
                out += ',';
                if (const auto mean = slicing::meanOnSurface(surface, values)) appendDecimal(out, *mean);
            }
            common.addCell(out, planes.w(i));
            out += units.cells + '\n';
        }
    }
    return out;
}

// Returns a table of the values of w of the vertices, with the number of vertices at each value.
std::string vertexHeightsCsv(const SceneToWrite& source) {
    std::string out = "w,vertices\n";
    std::vector<double> heights;
    for (const glm::dvec4& v : source.scene.slices->rotatedVertices) heights.push_back(v.w);
    const double same = slicing::kOnPlaneTolerance * source.scene.circumradius;
    for (const auto& [w, vertexCount] : slicing::groupHeights(std::move(heights), same)) {
        appendDecimal(out, slicing::infoOf(source.object).originInFile.w + w);
        out += ',' + std::to_string(vertexCount) + '\n';
    }
    return out;
}

// Returns a table of the values of w at which the section of a body, bounded by a level, changes its topology.
std::string fieldCriticalCsv(const SceneToWrite& source) {
    const slicing::FieldSettings& settings = source.scene.look.field;
    slicing::CriticalSearchLimits limits{.stop = source.budget.stopToken()};
    // The search takes up to 1.5 times `limits.time`, and must end within the time of the export.
    limits.time = std::min(limits.time, source.budget.timeLimit() / 2);
    const auto found = slicing::findCriticalSections(source.object, source.orientation, settings, limits);
    source.budget.checkTimeAndStop();
    if (!found) throw ExportRefused{{ExportRefusal::Cause::too_long, found.error().message}};
    std::string out =
        "w,change,level,components_before,components_after,cavities_before,cavities_after,euler_before,euler_after,"
        "tolerance";
    const fields::Field& field = *slicing::fieldIn(source.object);
    UnitColumns units;
    units.add("w_unit", unitOfW(source.scene));
    const ConstantSliceCoordinateColumn common(field, source);
    common.addNameAndUnit(out, units);
    units.add("level_unit", field.quantity.unit);
    out += units.names + '\n';
    for (const slicing::CriticalSection& section : found->all) {
        appendDecimal(out, slicing::infoOf(source.object).originInFile.w + section.w);
        out += ',';
        out += text::nameOf(slicing::kSectionChanges, section.change);
        appendDecimal(out += ',', settings.levels.at(section.levelIndex));
        const slicing::SectionTopology &before = section.before, &after = section.after;
        for (const std::size_t count : {before.components, after.components, before.cavities, after.cavities})
            out += ',' + std::to_string(count);
        for (const long euler : {before.euler, after.euler}) out += ',' + std::to_string(euler);
        appendDecimal(out += ',', found->tolerance);
        common.addCell(out, section.w);
        out += units.cells + '\n';
    }
    return out;
}

}  // namespace

std::string measurementsCsv(const SceneToWrite& source) {
    const fields::Field* field = slicing::fieldIn(source.object);
    if (source.contents == ExportContentsKind::critical)
        return field != nullptr ? fieldCriticalCsv(source) : vertexHeightsCsv(source);
    if (field != nullptr) return fieldMeasurementsCsv(source, *field);
    const slicing::SliceSet& slices = *source.scene.slices;
    std::string out = "n,w,vertices,edges,faces,volume,area,centroid_x,centroid_y,centroid_z\n";
    const glm::dvec4& origin = slicing::infoOf(source.object).originInFile;
    for (int i = 0; i < slices.planes.count; ++i) appendSliceRow(out, slices, origin, i);
    return out;
}

}  // namespace oval4d::exports

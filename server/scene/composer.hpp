#pragma once
// Composes the scene of a picture: the complete description of what is drawn, from an object, its slices and the user's
// choices.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "scene/density_plot.hpp"
#include "scene/scene.hpp"
#include "slicing/coordinate_value_histograms.hpp"
#include "slicing/object.hpp"
#include "slicing/planar_contours.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/projector.hpp"
#include "slicing/section_name.hpp"
#include "slicing/surface_detail.hpp"

namespace oval4d::scene {

/// The purpose for which a scene is composed.
enum class ScenePurpose : std::uint8_t {
    drawing,  ///< the scene is drawn, or written to a message or file
    /// The scene is only passed to pickElement(), pickLevel() and matrixPointAt(), which find what is at a pixel. They
    /// need no filled faces, density plots or histograms.
    pointing,
};

/// Composes scenes: the complete descriptions of pictures. Reuses its working memory, and caches data that stay the
/// same from one scene to the next. All calls for one composer must pass the same Scene object, because this object
/// holds part of the cached data. Only one thread at a time may use a composer.
class Composer {
  public:
    /// Limits the work of filling faces that cross each other. compose() may use `steps` steps of
    /// slicing::FaceFiller::fill(): first for the slices, then for the projection of the object. By default, there is
    /// no limit.
    void limitFaceFilling(std::size_t steps) { fillSteps_ = steps; }
    /// Limits the work of finding which elements lie behind other cells in the projection of the object (see
    /// slicing::Projector::ProjectionOptions::occlusionSteps).
    void limitOcclusion(std::size_t steps) { occlusionSteps_ = steps; }

    /// Composes the scene of `slices`, and writes it to `out`. `slices` must have been cut from `object` rotated by
    /// `orientation`. `focus` is the index n of the focus slice (see SlicePlacement::index). `quality` is the quality
    /// of the contours of a field in the matrix. If `purpose` is ScenePurpose::pointing, the parts that pointing does
    /// not need are not valid in `out`, and `slices` may lack the surfaces and the fog of a field. Overwrites `out` and
    /// reuses its memory. `out` keeps a pointer to `slices`; `slices` must outlive `out`.
    void compose(const slicing::Object& object, const geometry::Rotation& orientation, const slicing::SliceSet& slices,
                 int focus, const Look& look, Viewport viewport, Scene& out,
                 slicing::Quality quality = slicing::Quality::full, ScenePurpose purpose = ScenePurpose::drawing);

    /// Returns the latest names of the section in the focus slice (the middle one), found by compose() or passed to
    /// reuseSectionNames(). Returns an empty optional if there are none yet.
    const std::optional<slicing::NamedSection>& namedSection() const { return section_; }
    /// Gives compose() the names of a section, so that compose() need not find them if the focus slice is this section.
    void reuseSectionNames(const slicing::NamedSection& section) { section_ = section; }

    /// Chooses the lattices on which a field is sliced, such that their cubes have about the same size in pixels in all
    /// slices of the picture. Overwrites `out`. SurfaceDetail::steps becomes empty if the surfaces are hidden, and
    /// SurfaceDetail::fogSteps if there is no fog. Both become empty if `object` is not a field. The steps are 0 for
    /// slices that are not drawn or lie behind the eye. If SurfaceDetail::steps or SurfaceDetail::fogSteps is not
    /// empty, also lays out `scene`, which must be the Scene that compose() gets next.
    void layOutAndChooseDetail(const slicing::Object& object, const geometry::Hyperplanes& planes, int focus,
                               const Look& look, Viewport viewport, slicing::Quality quality, Scene& scene,
                               slicing::SurfaceDetail& out);

  private:
    // All data that determine the layout. While the object turns, only `focusName` can change; therefore most frames
    // reuse the layout.
    struct LayoutInput {
        geometry::Hyperplanes planes;
        int focus = 0;
        LayoutObjectInfo content;
        Look look;
        Viewport viewport;
        std::string focusName;
        bool operator==(const LayoutInput&) const = default;
    };

    // All data that determine the contours of a field in the matrix of planar sections.
    struct ContourInput {
        std::uint64_t object = 0;  // the serial number of the object
        geometry::Rotation orientation;
        glm::dvec4 point{0};
        std::vector<double> levels;
        double step = 0;
        slicing::Quality quality = slicing::Quality::full;
        bool operator==(const ContourInput&) const = default;
    };

    void setCellTypeFilter(const slicing::Object& object, const CellTypeFilter& filter);
    void projectObject(const slicing::Object& object, const geometry::Rotation& orientation, int focus,
                       std::size_t fillSteps, Scene& out);
    void cutSectionMatrix(const slicing::Object& object, const geometry::Rotation& orientation, int focus, Scene& out);
    void traceContours(const slicing::Object& object, const geometry::Rotation& orientation, slicing::Quality quality,
                       Scene& out);
    void nameSection(const slicing::Object& object, const geometry::Rotation& orientation, int focus, Scene& out);
    void setObjectLookAndViewport(const slicing::Object& object, const Look& look, Viewport viewport, Scene& out);
    void layOutIfChanged(const slicing::Object& object, const geometry::Hyperplanes& planes, int focus, Scene& out);
    void updateHighlight(const slicing::Object& object, bool objectChanged, Scene& out);
    void removeHighlightColor(Scene& out);
    void updateDensityPlot(const geometry::Rotation& orientation, Scene& out);
    void updateFieldHistograms(const slicing::Object& object, const geometry::Rotation& orientation, Scene& out);

    std::size_t fillSteps_ = slicing::FaceFiller::kNoLimit;
    std::size_t occlusionSteps_ = slicing::OcclusionFinder::kDefaultSteps;
    CellColorAssigner cellPainter_;
    slicing::FaceFiller filler_;
    std::uint64_t object_ = 0;       // the serial number of the object in the last call
    bool objectChanged_ = false;     // whether the object has changed since the last call of compose()
    double relativeBallRadius_ = 0;  // slicing::relativeBallRadius() of the object in the last call
    slicing::VisibilityBySource visibilities_;
    slicing::Projector projector_;
    slicing::PlanarSlicer planarSlicer_;
    slicing::PlanarContourTracer contourTracer_;
    // The data from which the contours in the scene were computed; empty if the scene has no contours.
    std::optional<ContourInput> contourInput_;
    CellTypeFilter filter_;
    slicing::SectionNamer sectionNamer_;
    std::optional<slicing::NamedSection> section_;
    LayoutInput layoutInput_;           // the data for the next layout; stored as a member so that its memory is reused
    LayoutInput laidOut_;               // the data from which the current layout of the scene was computed
    const Scene* laidOutIn_ = nullptr;  // the scene that was laid out from laidOut_; null before the first layout
    std::optional<slicing::Element> highlight_;
    slicing::PartsShowingElement highlightSources_;  // the slice vertices and slice edges that show highlight_
    // The index of the cell that has the highlight color in the scene, and the color that it has otherwise.
    std::optional<std::pair<std::size_t, Color>> replacedColor_;

    DensityPlot density_;
    slicing::CoordinateValueHistograms histogram_;
    // The serial number of the object whose density plot or histogram was computed last.
    std::uint64_t densityObject_ = 0;
    // The orientation of this object when its density plot or histogram was computed.
    geometry::Rotation densityTurn_;
    std::vector<double> histogramLevels_;  // the levels of the field when its histogram was computed last
};

}  // namespace oval4d::scene

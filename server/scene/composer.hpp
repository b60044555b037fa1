#pragma once
// Composes the scene of a picture from an object, its slices and the user's choices.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "geometry/rotation.hpp"
#include "scene/density_plot.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/projector.hpp"
#include "slicing/section_name.hpp"

namespace oval4d::scene {

/// Composes scenes. Keeps data that stay the same from one scene to the next, and working memory. A composer may be
/// used by one thread at a time. The caller must always pass the same Scene to compose(), because that Scene holds some
/// of the kept data.
class Composer {
  public:
    /// Limits the time for filling faces that cross each other: `steps` is passed to slicing::Filler::fill.
    void limitFill(std::size_t steps) { fillSteps_ = steps; }

    /// Composes the scene of `slices`, which must have been cut from `object` rotated by `orientation`. `focus` is the
    /// index n of the focus slice. Overwrites `out` and reuses its memory. `out` refers to `slices`, so `slices` must
    /// outlive `out`.
    void compose(const slicing::Object& object, const geometry::Rotation& orientation, const slicing::SliceSet& slices,
                 int focus, const Look& look, Viewport viewport, Scene& out);

  private:
    /// Everything on which the layout depends. It does not depend on the orientation, so it stays the same while the
    /// object turns.
    struct LayoutInput {
        geometry::Hyperplanes planes;
        int focus = 0;
        std::size_t vertices = 0;
        double ballRadius = 0;
        Look look;
        Viewport viewport;
        std::string focusName;
        bool operator==(const LayoutInput&) const = default;
    };

    void setFilter(const slicing::Object& object, const CellTypeFilter& filter);
    void projectObject(const slicing::Object& object, const geometry::Rotation& orientation, int focus, Scene& out);
    void cutMatrix(const slicing::Object& object, const geometry::Rotation& orientation, int focus, Scene& out);
    void nameSection(const slicing::Object& object, int focus, Scene& out);
    void layOutIfChanged(int focus, Scene& out);
    void highlight(const slicing::Object& object, bool objectChanged, Scene& out);
    void measureDensity(const geometry::Rotation& orientation, Scene& out);

    std::size_t fillSteps_ = slicing::Filler::kNoLimit;
    CellColors colors_;
    slicing::Filler filler_;
    std::uint64_t object_ = 0;  // the serial number of the object for which the next three members were computed
    double ballRadius_ = 0;     // as a fraction of the slice radius
    slicing::Visibilities visibilities_;
    slicing::Projector projector_;
    slicing::PlanarSlicer planarSlicer_;
    CellTypeFilter filter_;
    slicing::SectionNamer sectionNamer_;
    LayoutInput layoutInput_;           // of the next composition
    LayoutInput laidOut_;               // of the layout in the scene
    const Scene* laidOutIn_ = nullptr;  // the scene; null before the first composition
    std::optional<slicing::Element> highlight_;
    slicing::ElementSources highlightSources_;  // of highlight_

    DensityPlot density_;
    std::uint64_t densityObject_ = 0;  // the serial number of the object of which the density was measured
    geometry::Rotation densityTurn_;
};

}  // namespace oval4d::scene

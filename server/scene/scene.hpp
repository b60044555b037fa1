#pragma once
// What is to be seen: where the slices stand, from where they are looked at, in which colours, with which labels.
// Both streams draw from this, so that a page and a frame can be laid over each other.

#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/fill.hpp"
#include "geometry/polytope.hpp"
#include "geometry/rotation.hpp"
#include "geometry/slice_set.hpp"
#include "scene/density.hpp"

namespace oval4d::scene {

enum class View : std::uint8_t { oval, single };

/// What a face's colour, and the colour of a cell, tells.
enum class Colouring : std::uint8_t {
    cell,   ///< which cell it is
    kind,   ///< which kind of cell
    w,      ///< the w of the cell's centre, as the polytope is turned
    plain,  ///< nothing: one colour
};

/// Kinds of cells, numbers into Polytope::kinds: in order, each once, and none in both lists.
struct Kinds {
    std::vector<std::uint32_t> hidden, faded;
    bool operator==(const Kinds&) const = default;
};

/// Which parts are drawn.
struct Parts {
    bool faces = true, bars = true, balls = true, coordinates = true;
    bool operator==(const Parts&) const = default;
};

/// How the viewer has moved the camera from its place: orbit angles in radians about the point looked at, and
/// magnification (1 = as designed).
struct Orbit {
    double azimuth = 0, elevation = 0, zoom = 1;
    bool operator==(const Orbit&) const = default;
};

/// All that a user chooses about the picture.
struct Look {
    View view = View::oval;
    Parts parts;
    Orbit orbit;
    Colouring colouring = Colouring::cell;
    Kinds kinds = {};
    bool operator==(const Look&) const = default;
};

/// In pixels.
struct Viewport {
    int width = 1280, height = 720;
    bool operator==(const Viewport&) const = default;
};

/// Red, green, blue in sRGB: 0xRRGGBB.
using Colour = std::uint32_t;

/// A perspective camera: right-handed, looks from `eye` to `target`. `shift` moves the picture by this part of the
/// viewport (x right, y up; 1 = its whole width, height), so that the slices stand clear of the coordinates.
struct Camera {
    glm::dvec3 eye{0, 0, 1}, target{0}, up{0, 1, 0};
    double fieldOfView = 0.7;  ///< vertical, radians
    double near = 0.1, far = 100;
    double shiftX = 0, shiftY = 0;

    glm::dmat4 view() const;
    /// OpenGL clip space, the shift included.
    glm::dmat4 projection(double aspect) const;
    bool operator==(const Camera&) const = default;
};

/// One slice in the world.
struct Stand {
    int index = 0;           ///< n
    double w = 0;            ///< of the hyperplane, in the polytope's units
    glm::dvec3 position{0};  ///< where the slice's origin stands
    std::string label;       ///< "w = −0.25" at the focus, "−0.25" elsewhere
    glm::dvec3 labelAt{0};   ///< the label is centred horizontally under this point
    double labelSize = 1;    ///< of the label, as a part of Style::textHeight
    bool focus = false;
    bool drawn = true;  ///< false in the single view for all but the focus
    bool operator==(const Stand&) const = default;
};

/// The parallel coordinates: vertex i stands in row i / perRow, column i % perRow; its four lines x, y, z, w run
/// from the row's zero line up or down by value · amplitude / circumradius. All lengths are fractions of the
/// viewport's height, from its lower left corner. For many vertices there is a density strip instead: a single column,
/// its lines the axes, each from −circumradius to +circumradius.
struct CoordinatesLayout {
    int rows = 1, perRow = 1;
    double left = 0;        ///< the left edge of the first column
    double zero = 0;        ///< the first (top) row's zero line above the bottom
    double rowStep = 0;     ///< from one row's zero line down to the next one's
    double columnStep = 0;  ///< from one vertex to the next
    double lineStep = 0;    ///< from one of the four lines to the next
    double lineWidth = 0;
    double amplitude = 0;
    bool named = true;  ///< P0, P1, … are written under the columns, or x, y, z, w under the strip's axes
    bool density = false;
    bool operator==(const CoordinatesLayout&) const = default;
};

/// The parallel coordinates of so many vertices are drawn as lines; of more, as a density strip.
inline constexpr std::size_t kMostLines = 300;

/// The axes in the upper left corner: centre from the upper left corner and length of an axis, in fractions of the
/// viewport's height.
struct AxesLayout {
    double x = 0, y = 0, length = 0;
    bool operator==(const AxesLayout&) const = default;
};

/// The colour of a kind of cells, where colours tell the kind, of so many.
Colour kindColour(std::size_t kind, std::size_t count);

/// Paints the cells; keeps between calls what does not turn with the polytope.
class CellColours {
  public:
    /// One colour a cell, the same for the same arguments. By cell, neighbours differ, and cells along one Hopf fibre
    /// share a hue where there are many; by w, the farthest cells' centres have the strongest colours.
    void paint(const geometry::Polytope& polytope, Colouring colouring, const geometry::Rotation& orientation,
               std::vector<Colour>& out);

  private:
    std::uint64_t paintedFor_ = 0;  // the serial of the polytope
    Colouring colouring_ = Colouring::cell;
    std::vector<glm::dvec4> centres_;  // of the cells, of length 1 for the farthest
};

/// Colours and sizes that do not depend on the state.
struct Style {
    Colour background, text, focusText, ball, bar, zeroLine;
    Colour axisX, axisY, axisZ, axisW;
    double faceOpacity;  ///< 0 … 1
    glm::dvec3 light;    ///< unit vector toward the light, in camera axes
    double ambient, diffuse, specular,
        shininess;      ///< colour · (ambient + diffuse · max(n·l, 0)) + specular · max(n·h, 0)^shininess
    double textHeight;  ///< of labels, as a fraction of the viewport's height
};
const Style& style();

/// How much is seen of each cell and of what bounds it.
enum class Presence : std::uint8_t { hidden, faded, full };

/// The presence of all that a slice's elements are cut from, by their "of" numbers: a cell's is that of its kind, any
/// other element's the greatest of the cells that it belongs to. Empty lists where everything is seen.
struct Presences {
    std::vector<Presence> vertices, edges, faces;

    bool all() const { return faces.empty(); }
    Presence vertex(std::uint32_t of) const { return vertices.empty() ? Presence::full : vertices[of]; }
    Presence edge(std::uint32_t of) const { return edges.empty() ? Presence::full : edges[of]; }
    Presence face(std::uint32_t of) const { return faces.empty() ? Presence::full : faces[of]; }
};

/// By this a shape's opacity is multiplied.
constexpr double opacityOf(Presence presence) {
    return presence == Presence::full ? 1 : presence == Presence::faded ? 0.25 : 0;
}

struct Scene {
    Look look;
    Viewport viewport;
    Camera camera;
    double scale = 1;                      ///< world units per polytope unit
    double ballRadius = 0, barRadius = 0;  ///< in world units
    double circumradius = 1;
    std::vector<Stand> stands;  ///< as many as slices, in their order
    std::vector<Colour> cellColours;
    Presences presences;
    double faceOpacity = style().faceOpacity;  ///< 0 … 1; faces that may cross each other are opaque
    geometry::Fill fill;  ///< of the slices that the scene was composed for, if they may be other than convex
    geometry::Filler filler;
    CellColours colours;
    double thickness = 0;           ///< ball radius per slice radius, for this polytope
    std::uint64_t composedFor = 0;  ///< the serial of the polytope that presences and thickness belong to
    CoordinatesLayout coordinates;
    Density density;                   ///< measured where it is shown
    std::uint64_t densityFor = 0;      ///< the serial of its polytope, and …
    geometry::Rotation densityTurn{};  ///< … how that was turned
    AxesLayout axes;

    bool showsDensity() const { return look.parts.coordinates && coordinates.density; }
};

/// Composes the picture of slices that were cut from `polytope`, turned by `orientation`; `focus` is the index n of the
/// focus slice. `out` is overwritten and its memory reused.
void compose(const geometry::Polytope& polytope, const geometry::Hyperplanes& planes, int focus, const Look& look,
             Viewport viewport, Scene& out, const geometry::Rotation& orientation = {});

/// Fills the faces of slices, for a scene that was composed for them, where the polytope is not convex; in so many
/// steps at most, as Filler counts them.
void fill(const geometry::Polytope& polytope, const geometry::SliceSet& slices, Scene& scene,
          std::size_t steps = geometry::Filler::kNoLimit);

/// The cell that gives the slice's face cut from `of` its colour: the cell itself; of a 2-face in the hyperplane the
/// first of its two cells that is not hidden.
std::uint32_t tintOf(const geometry::Polytope& polytope, const Presences& presences, std::uint32_t of);

}  // namespace oval4d::scene

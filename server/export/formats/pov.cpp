#include "export/formats/writers.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "export/formats/text.hpp"
#include "export/mesh/field_surfaces.hpp"
#include "fields/field.hpp"
#include "scene/projection_enlargement.hpp"

namespace oval4d::exports {

namespace {

constexpr double kShortestPovBar = 1e-6;  // shorter bars are not drawn, because POV-Ray refuses cylinders without
                                          // length; in world units
constexpr std::uint32_t kNoPovPoint = std::numeric_limits<std::uint32_t>::max();
constexpr std::string_view kMatte = "Matte", kShiny = "Shiny";  // the finishes that a file declares

template <typename Number>
std::string povNumber(Number number) {
    std::string out;
    appendDecimal(out, number);
    return out;
}

/// Returns "<x, y, z>". The commas are necessary, because "<1 -2 3>" has two components in POV-Ray.
template <typename Vector>
std::string povVector(const Vector& v) {
    return "<" + povNumber(v.x) + ", " + povNumber(v.y) + ", " + povNumber(v.z) + ">";
}

/// Returns the sRGB channels of a color, from 0 to 1, separated by commas.
std::string povChannels(scene::Color color) {
    std::string out;
    for (const unsigned shift : {16U, 8U, 0U}) {
        if (!out.empty()) out += ", ";
        out += povNumber(static_cast<float>(color >> shift & 0xffU) / 255.0F);
    }
    return out;
}

/// Returns a text as a string literal of POV-Ray. Minus signs become hyphens, because the fonts of POV-Ray lack them.
std::string povString(std::string_view text) {
    constexpr std::string_view kMinus = "\u2212";
    std::string out = "\"";
    while (!text.empty()) {
        const bool isMinus = text.starts_with(kMinus);
        if (text.front() == '"' || text.front() == '\\') out += '\\';
        out += isMinus ? '-' : text.front();
        text.remove_prefix(isMinus ? kMinus.size() : 1);
    }
    return out + '"';
}

/// The textures in a file. Each texture is declared once, so that a user can change a color in one place.
class PovTextures {
  public:
    /// Returns the number of the texture with this color, opacity (0 … 1) and finish. Declares the texture if it is
    /// new.
    std::uint32_t textureNumberOf(scene::Color color, double opacity, std::string_view finish) {
        const auto next = static_cast<std::uint32_t>(numbers_.size());
        const auto [found, isNew] = numbers_.try_emplace(std::tuple(color, opacity, finish), next);
        if (isNew) {
            declarations_ += "#declare " + textureName(next) + " = texture { pigment { rgbt <" + povChannels(color) +
                             ", " + povNumber(static_cast<float>(1 - opacity)) + "> } finish { ";
            declarations_.append(finish).append(" } }\n");
        }
        return found->second;
    }
    static std::string textureName(std::uint32_t number) { return "Texture" + std::to_string(number); }
    const std::string& declarations() const { return declarations_; }

  private:
    std::map<std::tuple<scene::Color, double, std::string_view>, std::uint32_t> numbers_;
    std::string declarations_;
};

/// A triangle mesh. If `normals` is empty, triangles are flat.
struct PovMesh {
    std::vector<glm::vec3> points, normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 3>> textures;  ///< for each triangle: the texture numbers of its corners
    /// Whether light from behind makes triangles as bright as light from the front, like faces in pictures.
    bool isLitFromBehind = false;

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t texture) {
        triangles.push_back({a, b, c});
        textures.push_back({texture, texture, texture});
    }
};

void appendPovVectors(std::string& out, std::string_view name, const std::vector<glm::vec3>& vectors) {
    out.append(name).append(" { ").append(std::to_string(vectors.size()));
    for (const glm::vec3& v : vectors) out += ",\n" + povVector(v);
    out += " }\n";
}

void appendPovMesh(std::string& out, const PovMesh& mesh) {
    if (mesh.triangles.empty()) return;  // POV-Ray refuses empty lists
    out += "mesh2 {\n";
    appendPovVectors(out, "vertex_vectors", mesh.points);
    if (!mesh.normals.empty()) appendPovVectors(out, "normal_vectors", mesh.normals);
    std::map<std::uint32_t, std::size_t> places;  // for each texture number: its index in the texture list of the mesh
    for (const auto& corners : mesh.textures) {
        for (const std::uint32_t texture : corners) places.try_emplace(texture, 0);
    }
    out += "texture_list { " + std::to_string(places.size());
    std::size_t place = 0;
    for (auto& entry : places) {
        entry.second = place++;
        out += ", texture { " + PovTextures::textureName(entry.first) + " }";
    }
    out += " }\nface_indices { " + std::to_string(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        out += ",\n<" + std::to_string(a) + ", " + std::to_string(b) + ", " + std::to_string(c) + ">";
        for (const std::uint32_t texture : mesh.textures[t]) out += ", " + std::to_string(places.at(texture));
    }
    out += mesh.isLitFromBehind ? " }\ndouble_illuminate\n}\n" : " }\n}\n";
}

/// The place and size of a slice or of a part of the projection, and the radii and colors of its balls and bars.
struct PovPlacementAndStyle {
    glm::dvec3 position;
    double scale;                  ///< in world units per unit of the object
    double ballRadius, barRadius;  ///< in world units; balls or bars with radius 0 are not drawn
    scene::Color ballColor, barColor;

    glm::vec3 operator()(const glm::dvec3& p) const { return glm::vec3(position + scale * p); }
};

class PovWriter {
  public:
    explicit PovWriter(const SceneToWrite& source)
        : source_(source),
          scene_(source.scene),
          set_(*scene_.slices),
          style_(scene_.style()),
          toView_(scene_.camera.view()),
          axes_(glm::transpose(glm::dmat3(toView_))) {
        if (const fields::Field* const field = slicing::fieldIn(source.object))
            surfaces_.emplace(scene_, *field, source.orientation, source.exact, source.budget);
    }

    std::string write() {
        for (std::size_t i = 0; i < scene_.placements.size(); ++i) {
            if (scene_.placements[i].drawn) addSlice(i);
            checkBudget();
        }
        if (scene_.projectionPlacement.shown) addProjection();
        if (slicing::fieldIn(source_.object) != nullptr && !scene_.look.field.fog.empty())
            source_.warnings.emplace_back("the fog is left out");
        addLabels();
        return header() + textures_.declarations() + objects_;
    }

  private:
    void checkBudget() const {
        source_.budget.checkTimeAndStop();
        source_.budget.checkFileSize(textures_.declarations().size() + objects_.size());
    }

    std::string header() const {
        const bool isTransparent = style_.backgroundOpacity == 0;
        std::string out = "// " + removeNonXmlCharacters(scene_.title) + ", from oval4d: povray +W" +
                          std::to_string(scene_.viewport.width) + " +H" + std::to_string(scene_.viewport.height) +
                          (isTransparent ? " +UA" : "") + " +A FILE.pov\n#version 3.7;\n";
        out +=
            "// Light and translucent colors are mixed as in the picture: as sRGB values.\n"
            "global_settings { assumed_gamma srgb charset utf8 max_trace_level 256 }\n"
            "background { rgbt <" +
            povChannels(style_.background) + (isTransparent ? ", 1" : ", 0") + "> }\n\n";
        appendCamera(out);
        out += "// Without `shadowless`, the bodies cast shadows.\nlight_source { " +
               povVector(scene_.camera.target + scene_.camera.far * (axes_ * style_.light)) +
               " rgb 1 parallel point_at " + povVector(scene_.camera.target) + " shadowless }\n";
        const std::string lighting =
            " = finish { ambient " + povNumber(style_.ambient) + " diffuse " + povNumber(style_.diffuse);
        out.append("#declare ").append(kMatte).append(lighting).append(" }\n");
        out.append("#declare ").append(kShiny).append(lighting).append(" specular ");
        return out + povNumber(style_.specular) + " roughness " + povNumber(1 / style_.shininess) + " }\n\n";
    }

    /// Appends the camera. POV-Ray looks from `location` through the points direction + x · right + y · up, where x and
    /// y are from −1/2 to 1/2. POV-Ray also accepts right-handed vectors, although its own coordinates are left-handed.
    /// If the rendered image has another aspect ratio than the picture, `right` or `up` is lengthened, so that the
    /// image shows the whole picture.
    void appendCamera(std::string& out) const {
        const scene::Camera& camera = scene_.camera;
        const double aspect = static_cast<double>(scene_.viewport.width) / scene_.viewport.height;
        const glm::dvec3 direction =
            -camera.focalLength() * axes_[2] - camera.shiftX * aspect * axes_[0] - camera.shiftY * axes_[1];
        out +=
            "// All coordinates are right-handed: Right, Up and Back, which points to the viewer.\n"
            "// The view axis is beside the middle of the picture, so POV-Ray warns that\n"
            "// the vectors of the camera are not perpendicular.\n";
        out += "#declare Right = " + povVector(axes_[0]) + ";\n#declare Up = " + povVector(axes_[1]) +
               ";\n#declare Back = " + povVector(axes_[2]) + ";\n#declare Aspect = " + povNumber(aspect) +
               ";\ncamera {\n  perspective\n  location " + povVector(camera.eye) + "\n  direction " +
               povVector(direction) +
               "\n  right Right * max(Aspect, image_width / image_height)"
               "\n  up Up * max(1, Aspect * image_height / image_width)\n}\n";
    }

    void addSlice(std::size_t slice) {
        const scene::SlicePlacement& placement = scene_.placements[slice];
        objects_ += "\n// Slice " + std::to_string(placement.index) + "\n";
        const PovPlacementAndStyle part{placement.position,       scene_.scale,
                                        scene_.drawnBallRadius(), scene_.look.parts.bars ? scene_.barRadius : 0,
                                        scene_.drawnBallColor(),  style_.bar};
        if (scene_.look.parts.faces && !scene_.needsDepthBuffer) {
            addFaces(set_, slice, part, scene_.faceOpacity,
                     [this](std::uint32_t f) { return scene_.coloringCellOfFace(f); });
        }
        if (!scene_.fill.empty()) addConvexPieces(scene_.fill, scene_.fillCells, slice, part, scene_.faceOpacity);
        if (!scene_.surfaces.empty()) addSurfaces(slice, part);
        addBalls(set_, slice, part);
        addBars(set_, slice, part);
    }

    void addProjection() {
        const scene::ObjectProjection& projection = scene_.projection;
        const double larger = scene::enlargementBehindSlices(scene_);
        const glm::dvec3 eye = scene_.camera.eye;
        const glm::dvec3 position = eye + larger * (scene_.projectionPlacement.position - eye);
        objects_ += "\n// Projection\n";
        if (larger > 1) objects_ += "// It is farther away and larger, so that it is seen behind the slices.\n";
        for (std::size_t i = 0; i < projection.parts.size(); ++i) {
            const scene::ProjectionPartLook& look = projection.parts[i];
            const PovPlacementAndStyle part{position,
                                            larger * projection.scale,
                                            larger * look.ballRadius,
                                            larger * look.barRadius,
                                            look.ballColor,
                                            look.barColor};
            if (projection.drawsPieces(i)) {
                addConvexPieces(projection.fill, projection.fillCells, i, part, look.faceOpacity);
            } else {
                addFaces(projection.elements, i, part, look.faceOpacity,
                         [&](std::uint32_t f) { return projection.faceCells[f]; });
            }
            addBalls(projection.elements, i, part);
            addBars(projection.elements, i, part);
            checkBudget();
        }
        if (projection.focusSurface) {
            addSurfaces(projection.focusSurface->slice,
                        {position, larger * projection.focusSurface->scale, 0, 0, 0, 0});
        }
    }

    /// Adds the convex faces of a slice of `set`. `opacity` is the opacity of fully visible faces. `cellOf` returns the
    /// cell that gives a face its color.
    template <typename CellOf>
    void addFaces(const slicing::SliceSet& set, std::size_t slice, const PovPlacementAndStyle& part, double opacity,
                  CellOf cellOf) {
        PovMesh mesh;
        mesh.isLitFromBehind = true;
        for (std::uint32_t v = set.vertexBegin[slice]; v < set.vertexBegin[slice + 1]; ++v)
            mesh.points.push_back(part(set.vertices[v]));
        for (std::uint32_t f = set.faceBegin[slice]; f < set.faceBegin[slice + 1]; ++f) {
            const double own = opacity * slicing::opacityOf(scene_.visibilities.face(set.faceSource[f]));
            if (own == 0) continue;
            const std::uint32_t texture = textures_.textureNumberOf(scene_.cellColors[cellOf(f)], own, kMatte);
            const std::uint32_t first = set.cornerBegin[f];
            for (std::uint32_t c = first + 2; c < set.cornerBegin[f + 1]; ++c)
                mesh.add(set.corners[first], set.corners[c - 1], set.corners[c], texture);
        }
        appendPovMesh(objects_, mesh);
    }

    /// Adds the convex pieces into which the faces of a slice of `fill` are divided. `cells` contains the cell that
    /// gives each face its color. `opacity` is the opacity of fully visible faces.
    void addConvexPieces(const slicing::FilledFaces& fill, const std::vector<std::uint32_t>& cells, std::size_t slice,
                         const PovPlacementAndStyle& part, double opacity) {
        PovMesh mesh;
        mesh.isLitFromBehind = true;
        for (std::uint32_t f = fill.faceBegin[slice]; f < fill.faceBegin[slice + 1]; ++f) {
            const double own = opacity * slicing::opacityOf(scene_.visibilities.face(fill.faces[f].source));
            if (own == 0) continue;
            const std::uint32_t texture = textures_.textureNumberOf(scene_.cellColors[cells[f]], own, kMatte);
            for (std::uint32_t k = fill.pieceBegin[f]; k < fill.pieceBegin[f + 1]; ++k) {
                const auto first = static_cast<std::uint32_t>(mesh.points.size());
                for (std::uint32_t c = fill.cornerBegin[k]; c < fill.cornerBegin[k + 1]; ++c)
                    mesh.points.push_back(part(fill.corners[c]));
                for (std::uint32_t c = first + 2; c < mesh.points.size(); ++c) mesh.add(first, c - 1, c, texture);
            }
        }
        appendPovMesh(objects_, mesh);
    }

    void addSurfaces(std::size_t slice, const PovPlacementAndStyle& part) {
        const FieldSliceSurface exported = surfaces_->surfaceOfSlice(static_cast<int>(slice));
        const slicing::SliceSurface& surface = exported.surface;
        triangles_ += surface.triangles.size();
        source_.budget.checkTrianglesAndMemory(triangles_);
        for (const scene::SurfaceLook::LevelLook& level : scene_.surfaces.levels) {
            addSurface(surface, slice, part, level, false);
            if (level.caps) addSurface(surface, slice, part, level, true);
        }
    }

    /// Adds the smooth level set of a level or, if `ofCaps`, its flat caps. The level set and the caps are separate
    /// meshes, because the points on their common rim have different normals and colors in each mesh.
    void addSurface(const slicing::SliceSurface& surface, std::size_t slice, const PovPlacementAndStyle& part,
                    const scene::SurfaceLook::LevelLook& level, bool ofCaps) {
        PovMesh mesh;
        // For each point of the surface: its index in the mesh.
        std::vector<std::uint32_t> numbers(surface.points.size(), kNoPovPoint);
        std::vector<std::uint32_t> textureOf;  // for each point of the mesh: the number of its texture
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            if (surface.levelIndex(t) != level.index || surface.isCap(t) != ofCaps) continue;
            auto& corners = mesh.triangles.emplace_back();
            auto& textures = mesh.textures.emplace_back();
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t point = surface.triangles[t][i];
                if (numbers[point] == kNoPovPoint) {
                    numbers[point] = static_cast<std::uint32_t>(mesh.points.size());
                    mesh.points.push_back(part(glm::dvec3(surface.points[point])));
                    if (!ofCaps) mesh.normals.push_back(surface.normals[point]);
                    textureOf.push_back(textures_.textureNumberOf(colorOf(surface, slice, level, ofCaps, point),
                                                                  level.opacity, kShiny));
                }
                corners[i] = numbers[point];
                textures[i] = textureOf[numbers[point]];
            }
        }
        appendPovMesh(objects_, mesh);
    }

    scene::Color colorOf(const slicing::SliceSurface& surface, std::size_t slice,
                         const scene::SurfaceLook::LevelLook& level, bool ofCaps, std::uint32_t point) const {
        const scene::SurfaceLook& look = scene_.surfaces;
        if (ofCaps && look.colorsCapPoints()) return look.capPointColor(surface, point);
        if (!ofCaps && look.colorsPoints()) return look.pointColor(surface, point);
        return look.color(level, slice);
    }

    void addBalls(const slicing::SliceSet& set, std::size_t slice, const PovPlacementAndStyle& part) {
        for (std::uint32_t v = set.vertexBegin[slice]; part.ballRadius > 0 && v < set.vertexBegin[slice + 1]; ++v) {
            const std::uint32_t source = set.vertexSource[v];
            const double own = set.ballOpacity.empty() ? 1 : set.ballOpacity[v];
            const double opacity = own * slicing::opacityOf(scene_.visibilities.vertex(source));
            if (opacity == 0) continue;
            const auto radius = static_cast<float>(part.ballRadius * (set.ballScale.empty() ? 1 : set.ballScale[v]));
            objects_ += "sphere { " + povVector(part(set.vertices[v])) + ", " + povNumber(radius);
            appendTextureAndEndShape(scene_.highlight.hasVertex(source) ? style_.highlight : part.ballColor, opacity);
        }
    }

    void addBars(const slicing::SliceSet& set, std::size_t slice, const PovPlacementAndStyle& part) {
        const std::uint32_t first = set.vertexBegin[slice];
        for (std::uint32_t e = set.edgeBegin[slice]; part.barRadius > 0 && e < set.edgeBegin[slice + 1]; ++e) {
            const std::uint32_t source = set.edgeSource[e];
            const double opacity = slicing::opacityOf(scene_.visibilities.edge(source));
            const glm::vec3 a = part(set.vertices[first + set.edges[e][0]]),
                            b = part(set.vertices[first + set.edges[e][1]]);
            if (opacity == 0 || glm::distance(a, b) < kShortestPovBar) continue;
            objects_ += "cylinder { " + povVector(a) + ", " + povVector(b) + ", " +
                        povNumber(static_cast<float>(part.barRadius));
            appendTextureAndEndShape(scene_.highlight.hasEdge(source) ? style_.highlight : part.barColor, opacity);
        }
    }

    /// Appends the texture and the closing braces of a ball or bar. A line of sight crosses the surface of the shape
    /// twice. Each crossing transmits the fraction √(1 − opacity) of the light, so that the whole shape has the opacity
    /// `opacity`.
    void appendTextureAndEndShape(scene::Color color, double opacity) {
        const std::uint32_t texture = textures_.textureNumberOf(color, 1 - std::sqrt(1 - opacity), kShiny);
        objects_ += " texture { " + PovTextures::textureName(texture) + " } }\n";
    }

    /// Adds the labels, as texts that are parallel to the plane of the picture.
    void addLabels() {
        bool isFirst = true;
        for (const scene::SlicePlacement& placement : scene_.placements) {
            const double depth = -(toView_ * glm::dvec4(placement.labelAt, 1)).z;
            if (!placement.drawn || placement.label.empty() || depth <= 0) continue;
            if (isFirst) objects_ += kLabelMacro;
            isFirst = false;
            const double size = style_.textHeight * placement.labelSize * depth / scene_.camera.focalLength();
            objects_ += "Label(" + povString(placement.label) + ", " + povVector(placement.labelAt) + ", " +
                        povNumber(size) + ", <" + povChannels(placement.focus ? style_.focusText : style_.text) +
                        ">)\n";
        }
    }

    // Font 2 of POV-Ray is a sans-serif font. At size 1, its digits are 0.73 high.
    static constexpr std::string_view kLabelMacro = R"(
// Top: the center of the label's top edge.
#macro Label(Text, Top, Size, Color)
  #local Letters = text { internal 2 Text 0.01, 0 }
  object {
    Letters
    translate <-(min_extent(Letters).x + max_extent(Letters).x) / 2, -0.73, 0>
    scale Size
    matrix <Right.x, Right.y, Right.z, Up.x, Up.y, Up.z, Back.x, Back.y, Back.z, 0, 0, 0>
    translate Top
    pigment { rgb Color }
    finish { ambient 1 diffuse 0 }
    no_shadow
  }
#end
)";

    const SceneToWrite& source_;
    const scene::Scene& scene_;
    const slicing::SliceSet& set_;
    const scene::PictureStyle& style_;
    const glm::dmat4 toView_;
    const glm::dmat3 axes_;  // the directions right, up and back of the camera
    PovTextures textures_;
    std::string objects_;
    std::optional<FieldSurfaceSource> surfaces_;  // source of the surfaces of a field; empty for other objects
    std::size_t triangles_ = 0;                   // number of triangles of all surfaces so far
};

}  // namespace

std::string pov(const SceneToWrite& source) { return PovWriter(source).write(); }

}  // namespace oval4d::exports

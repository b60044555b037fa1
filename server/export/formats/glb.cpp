#include "export/formats/writers.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <glm/geometric.hpp>

#include "export/formats/little_endian.hpp"

namespace oval4d::exports {

namespace {

constexpr double kMetersPerMillimeter = 1e-3;

// Converts a channel of an sRGB color to linear light, because vertex colors in glTF are linear.
float srgbToLinear(unsigned channel) {
    const double c = channel / 255.0;
    return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

/// The values of a vertex attribute: positions, normals or colors. A value has three 32-bit floats.
class VertexAttribute {
  public:
    void add(const glm::vec3& value) {
        for (int i = 0; i < 3; ++i) putLittleEndian(bytes_, value[i]);
        least_ = glm::min(least_, value);
        most_ = glm::max(most_, value);
        ++count_;
    }
    /// Appends the values to the only buffer of `model`, and an accessor (the description of the values in glTF) to
    /// `model`. Returns the index of the accessor. If `bounded`, the accessor states the minimum and the maximum of the
    /// values, as glTF requires for positions.
    int appendTo(tinygltf::Model& model, bool bounded) const {
        std::vector<unsigned char>& data = model.buffers.front().data;
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = bytes_.size();
        view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
        data.insert(data.end(), bytes_.begin(), bytes_.end());
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model.bufferViews.size());
        accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
        accessor.type = TINYGLTF_TYPE_VEC3;
        accessor.count = count_;
        if (bounded) {
            for (int i = 0; i < 3; ++i) {
                accessor.minValues.push_back(least_[i]);
                accessor.maxValues.push_back(most_[i]);
            }
        }
        model.bufferViews.push_back(std::move(view));
        model.accessors.push_back(std::move(accessor));
        return static_cast<int>(model.accessors.size()) - 1;
    }

  private:
    std::string bytes_;
    std::size_t count_ = 0;
    glm::vec3 least_{3e38F}, most_{-3e38F};
};

glm::vec3 srgbToLinearColor(scene::Color color) {
    return {srgbToLinear(color >> 16U & 0xffU), srgbToLinear(color >> 8U & 0xffU), srgbToLinear(color & 0xffU)};
}

/// Adds a body to `model`. Triangles do not share vertices, because the normal and the color at a corner may differ
/// from triangle to triangle.
void addMesh(const PlacedMesh& solid, const MeshesToWrite& meshes, tinygltf::Model& model) {
    VertexAttribute positions;
    VertexAttribute normals;
    VertexAttribute colors;
    const bool colored = !solid.mesh.pointColors.empty();
    const auto smooth = colored ? smoothNormals(solid.mesh) : std::vector<std::array<glm::dvec3, 3>>();
    for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
        const glm::dvec3 across = doubleAreaNormalOf(solid.mesh, solid.mesh.triangles[t]);
        const double length = glm::length(across);
        if (!(length > 0)) continue;  // a triangle without area is invisible and has no normal
        const glm::vec3 color = srgbToLinearColor(meshes.colorOf(solid, t));
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t corner = solid.mesh.triangles[t][i];
            positions.add(glm::vec3(solid.mesh.points[corner] * kMetersPerMillimeter));
            normals.add(glm::normalize(glm::vec3(colored ? smooth[t][i] : across / length)));
            colors.add(colored ? srgbToLinearColor(solid.mesh.pointColors[corner]) : color);
        }
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.attributes["POSITION"] = positions.appendTo(model, true);
    primitive.attributes["NORMAL"] = normals.appendTo(model, false);
    primitive.attributes["COLOR_0"] = colors.appendTo(model, false);
    tinygltf::Mesh mesh;
    mesh.name = solid.name;
    mesh.primitives.push_back(std::move(primitive));
    tinygltf::Node node;
    node.name = solid.name;
    node.mesh = static_cast<int>(model.meshes.size());
    if (solid.at != glm::dvec3(0)) {
        for (int i = 0; i < 3; ++i) node.translation.push_back(solid.at[i] * kMetersPerMillimeter);
    }
    model.scenes.front().nodes.push_back(static_cast<int>(model.nodes.size()));
    model.meshes.push_back(std::move(mesh));
    model.nodes.push_back(std::move(node));
}

}  // namespace

std::string glb(const MeshesToWrite& meshes) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "oval4d";
    model.buffers.emplace_back();
    model.scenes.emplace_back();
    model.defaultScene = 0;
    tinygltf::Material material;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.6;
    model.materials.push_back(std::move(material));
    for (const PlacedMesh& solid : meshes.solids) {
        meshes.budget.checkTimeAndStop();
        addMesh(solid, meshes, model);
    }
    std::ostringstream out;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true))
        throw std::runtime_error("tinygltf cannot write the file");
    return std::move(out).str();
}

}  // namespace oval4d::exports

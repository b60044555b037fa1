#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "export/bytes.hpp"
#include "export/mesh_formats.hpp"

namespace oval4d::exports {

namespace {

constexpr double kMetre = 1e-3;  // millimetres

// glTF multiplies colours of vertices as linear light.
float linear(unsigned channel) {
    const double c = channel / 255.0;
    return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

/// One kind of numbers in the file, three float32 to a vertex.
class Stream {
  public:
    void add(const glm::vec3& value) {
        for (int i = 0; i < 3; ++i) put(bytes_, value[i]);
        least_ = glm::min(least_, value);
        most_ = glm::max(most_, value);
        ++count_;
    }
    /// Into the model's only buffer; the number of its accessor.
    int store(tinygltf::Model& model, bool bounded) const {
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

/// Each triangle has corners of its own: its normal and its colour are flat.
void addSolid(const Solid& solid, Colours cells, tinygltf::Model& model) {
    Stream positions;
    Stream normals;
    Stream colours;
    for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
        const glm::dvec3 across = normalOf(solid.mesh, solid.mesh.triangles[t]);
        const double length = glm::length(across);
        if (!(length > 0)) continue;  // nothing to be seen, and no normal
        const scene::Colour colour = colourOf(solid, t, cells);
        for (const std::uint32_t corner : solid.mesh.triangles[t]) {
            positions.add(glm::vec3(solid.mesh.points[corner] * kMetre));
            normals.add(glm::normalize(glm::vec3(across / length)));
            colours.add({linear(colour >> 16U & 0xffU), linear(colour >> 8U & 0xffU), linear(colour & 0xffU)});
        }
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.attributes["POSITION"] = positions.store(model, true);
    primitive.attributes["NORMAL"] = normals.store(model, false);
    primitive.attributes["COLOR_0"] = colours.store(model, false);
    tinygltf::Mesh mesh;
    mesh.name = solid.name;
    mesh.primitives.push_back(std::move(primitive));
    tinygltf::Node node;
    node.name = solid.name;
    node.mesh = static_cast<int>(model.meshes.size());
    if (solid.at != glm::dvec3(0)) {
        for (int i = 0; i < 3; ++i) node.translation.push_back(solid.at[i] * kMetre);
    }
    model.scenes.front().nodes.push_back(static_cast<int>(model.nodes.size()));
    model.meshes.push_back(std::move(mesh));
    model.nodes.push_back(std::move(node));
}

}  // namespace

std::string glb(std::span<const Solid> solids, Colours cells) {
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
    for (const Solid& solid : solids) addSolid(solid, cells, model);
    std::ostringstream out;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true))
        throw std::runtime_error("tinygltf cannot write the file");
    return std::move(out).str();
}

}  // namespace oval4d::exports

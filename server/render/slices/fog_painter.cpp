#include "render/slices/fog_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string_view>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "render/slices/slice_ref.hpp"

namespace oval4d::render {

namespace {

constexpr std::string_view kVertexSource = R"(
layout(location = 0) in vec3 clip;
layout(location = 1) in vec3 placeIn;
out vec3 place;
out float depthSeen;
void main() {
    place = placeIn;
    depthSeen = clip.z;
    gl_Position = vec4(clip.xy, 0.0, clip.z);
}
)";

// The fragment shader that casts rays through the fog. The page in the browser has the same algorithm
// (web_client/src/picture/fog_painter.ts).
constexpr std::string_view kFragmentSource = R"(
// Lengths in the slice are in circumradii: in the units of the object, their squares could be too large or too small.
in vec3 place;
in float depthSeen;  // the distance of place from the eye along the view axis
uniform sampler3D lattice;   // red: the value of a lattice point, 0 if there is none; green: 1 if there is a value
uniform sampler3D blocks;    // per block of 4 × 4 × 4 lattice cells: 0 if the block contains no fog
uniform sampler2D table;     // per value: the color of fog, and its absorption per circumradius
uniform sampler2D frameDepths, surfaceDepths;
uniform vec2 toDepth;        // (a, b): the depth of a point at the distance d is a + b / d, from -1 to 1
uniform bool isBehind;       // true: draws the fog behind balls and bars; false: the fog in front of them
uniform vec3 eye;            // the eye in slice coordinates; walls and low are also in slice coordinates
uniform vec4 walls[8];
uniform int wallCount;
uniform vec3 low;            // the lattice point with the least x, y and z
uniform vec3 size;           // the numbers of lattice points along x, y and z
uniform float latticeStep;
out vec4 pixel;
// Returns the distance along the view axis of the nearest shape at this pixel of the texture; 1e30 if there is none.
float distanceIn(sampler2D depths) {
    float depth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
    return depth < 1.0 ? toDepth.y / (2.0 * depth - 1.0 - toDepth.x) : 1e30;
}
void main() {
    // The ray is eye + t * way. Its part in the fog is from t = begin to t = end.
    vec3 way = place - eye;
    way += vec3(equal(way, vec3(0.0))) * 1e-20;
    vec3 first = (low - eye) / way, last = (low + latticeStep * (size - 1.0) - eye) / way;
    vec3 near = min(first, last), far = max(first, last);
    float begin = max(max(near.x, near.y), max(near.z, 0.0)), end = min(far.x, min(far.y, far.z));
    for (int i = 0; i < wallCount; ++i) {
        float along = dot(walls[i].xyz, way), room = walls[i].w - dot(walls[i].xyz, eye);
        if (along > 0.0) end = min(end, room / along);
        else if (along < 0.0) begin = max(begin, room / along);
        else if (room < 0.0) discard;
    }
    float surface = distanceIn(surfaceDepths), frame = min(surface, distanceIn(frameDepths));
    if (isBehind) begin = max(begin, frame / depthSeen);
    end = min(end, (isBehind ? surface : frame) / depthSeen);
    if (!(begin < end)) discard;
    float reach = (end - begin) * length(way);
    float count = clamp(ceil(reach / latticeStep), 1.0, 512.0);
    float thickness = reach / count;
    vec3 move = (end - begin) / count * way / (latticeStep * size);
    vec3 at = ((eye + begin * way - low) / latticeStep + 0.5) / size + 0.5 * move;
    vec3 light = vec3(0.0);
    float clear = 1.0;
    for (float i = 0.0; i < count && clear > 0.002; ++i, at += move) {
        vec3 block = clamp((at * size - 0.5) / 4.0, vec3(0.0), (size - 1.001) / 4.0);
        if (texelFetch(blocks, ivec3(block), 0).r == 0.0) {
            // This block contains no fog. Leaps to the last sample in the block; the next sample is in another block.
            vec3 perStep = move * size / 4.0;
            vec3 steps = (floor(block) + vec3(greaterThan(perStep, vec3(0.0))) - block) / perStep;
            float leap = max(ceil(min(steps.x, min(steps.y, steps.z))) - 1.0, 0.0);
            i += leap;
            at += leap * move;
            continue;
        }
        vec2 texel = textureLod(lattice, at, 0.0).rg;
        if (texel.g == 0.0) continue;
        vec4 look = texelFetch(table, ivec2(int(texel.r / texel.g * 255.0 + 0.5), 0), 0);
        float through = exp(-look.a * thickness * texel.g);
        light += clear * (1.0 - through) * look.rgb;
        clear *= through;
    }
    pixel = vec4(light, 1.0 - clear);
}
)";

constexpr GLint kLatticeUnit = 0, kTableUnit = 1, kFrameUnit = 2, kSurfaceUnit = 3, kBlocksUnit = 4;  // texture units

void makeTexture(GLenum target, GLint filter, GLuint& out) {
    glGenTextures(1, &out);
    glBindTexture(target, out);
    for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(target, name, filter);
    for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(target, name, GL_CLAMP_TO_EDGE);
}

/// The triangles of a box, as indices of corners, counterclockwise seen from outside. The corner (x, y, z), for x, y, z
/// in {0, 1}, has the index x + 2y + 4z.
constexpr std::array<std::uint32_t, 36> kBoxTriangles{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                                      2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};

}  // namespace

FogPainter::FogPainter()
    : program_(kVertexSource, kFragmentSource, sizeof(BoxCorner),
               std::to_array<VertexAttribute>(
                   {{3, GL_FLOAT, offsetof(BoxCorner, clip)}, {3, GL_FLOAT, offsetof(BoxCorner, place)}})) {
    const auto at = [&](const char* name) { return program_.uniformLocation(name); };
    uniforms_ = {at("toDepth"),   at("isBehind"), at("eye"),  at("walls"),
                 at("wallCount"), at("low"),      at("size"), at("latticeStep")};
    makeTexture(GL_TEXTURE_2D, GL_NEAREST, table_);
    makeTexture(GL_TEXTURE_2D, GL_NEAREST, frameDepths_);
    makeTexture(GL_TEXTURE_2D, GL_NEAREST, surfaceDepths_);
    program_.use();
    glUniform1i(at("lattice"), kLatticeUnit);
    glUniform1i(at("blocks"), kBlocksUnit);
    glUniform1i(at("table"), kTableUnit);
    glUniform1i(at("frameDepths"), kFrameUnit);
    glUniform1i(at("surfaceDepths"), kSurfaceUnit);
}

FogPainter::~FogPainter() {
    deleteLattices();
    for (const GLuint texture : {table_, frameDepths_, surfaceDepths_}) glDeleteTextures(1, &texture);
}

void FogPainter::begin(const scene::Scene& scene, DepthRange range) {
    projection_ = ViewProjection::fromCamera(scene.camera, scene.viewport);
    toView_ = scene.camera.view();
    std::array<glm::vec4, scene::kFogEntries> looks{};
    std::ranges::transform(scene.fog, looks.begin(), [](std::uint32_t entry) {
        const double opacity = (entry >> 24) / 255.0;
        return glm::vec4(glm::vec3(entry >> 16 & 255, entry >> 8 & 255, entry & 255) / 255.0F,
                         -std::log(std::max(1 - opacity, kMinTransmittance)));
    });
    glActiveTexture(GL_TEXTURE0 + kTableUnit);
    glBindTexture(GL_TEXTURE_2D, table_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(looks.size()), 1, 0, GL_RGBA, GL_FLOAT,
                 looks.data());
    glActiveTexture(GL_TEXTURE0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    deleteLattices();
    lattices_.assign(scene.slices->fogs.size(), 0);
    blocks_.assign(scene.slices->fogs.size(), 0);
    for (std::size_t i = 0; i < lattices_.size(); ++i) {
        if (!scene.placements[i].drawn || scene.slices->fogs[i].empty()) continue;
        makeTexture(GL_TEXTURE_3D, GL_LINEAR, lattices_[i]);
        uploadLattice(scene.slices->fogs[i]);
        makeTexture(GL_TEXTURE_3D, GL_NEAREST, blocks_[i]);
        uploadBlockMask(scene.slices->fogs[i], scene.fog);
    }
    const glm::vec2 toDepth = range.toDepth();
    program_.use();
    glUniform2f(uniforms_.toDepth, toDepth.x, toDepth.y);
}

void FogPainter::deleteLattices() {
    for (const std::vector<GLuint>& textures : {std::cref(lattices_), std::cref(blocks_)})
        glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
}

void FogPainter::copyOccluderDepths(scene::Viewport viewport, FogOccluders occluders) {
    const bool isFrame = occluders == FogOccluders::frame;
    glActiveTexture(GL_TEXTURE0 + (isFrame ? kFrameUnit : kSurfaceUnit));
    glBindTexture(GL_TEXTURE_2D, isFrame ? frameDepths_ : surfaceDepths_);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT16, 0, 0, viewport.width, viewport.height, 0);
    glActiveTexture(GL_TEXTURE0);
}

// Writes the values of a fog lattice to the 3-D texture that is bound.
void FogPainter::uploadLattice(const slicing::SliceFog& fog) {
    texels_.clear();
    texels_.reserve(2 * fog.values.size());
    for (const std::uint8_t value : fog.values) {
        texels_.push_back(value);
        texels_.push_back(value > 0 ? 255 : 0);
    }
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RG8, fog.size.x, fog.size.y, fog.size.z, 0, GL_RG, GL_UNSIGNED_BYTE,
                 texels_.data());
}

// Writes one byte for each block of a fog lattice to the 3-D texture that is bound: 255 if the block contains fog, else
// 0.
void FogPainter::uploadBlockMask(const slicing::SliceFog& fog, const scene::FogTransferTable& table) {
    const glm::ivec3 size = scene::findFogBlocks(fog, table, blockTexels_);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R8, size.x, size.y, size.z, 0, GL_RED, GL_UNSIGNED_BYTE, blockTexels_.data());
}

void FogPainter::draw(const scene::Scene& scene, std::uint32_t slice, FogPart part) {
    if (lattices_[slice] == 0) return;
    const slicing::SliceFog& fog = scene.slices->fogs[slice];
    const SliceRef view{*scene.slices, scene, toView_, slice};
    const SliceTransform transform(view);
    const double unit = scene.circumradius;
    const glm::dvec3 reach = fog.step * glm::dvec3(fog.size - 1);
    std::array<BoxCorner, 8> corners{};
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 place = fog.min + reach * glm::dvec3(i & 1, i >> 1 & 1, i >> 2);
        corners[static_cast<std::size_t>(i)] = {projection_.clipXyw(transform(place)), glm::vec3(place / unit)};
    }
    std::array<glm::vec4, slicing::FieldSection::kMaxWalls> walls{};
    std::ranges::transform(fog.walls, walls.begin(), [unit](const slicing::FieldSection::HalfSpace& wall) {
        return glm::vec4(wall.normal, wall.offset / unit);
    });
    const glm::vec3 eye((scene.camera.eye - scene.placements[slice].position) / (scene.scale * unit));
    const glm::vec3 low(fog.min / unit);
    glActiveTexture(GL_TEXTURE0 + kBlocksUnit);
    glBindTexture(GL_TEXTURE_3D, blocks_[slice]);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, lattices_[slice]);
    program_.use();
    glUniform1i(uniforms_.isBehind, part == FogPart::behind ? 1 : 0);
    glUniform3f(uniforms_.eye, eye.x, eye.y, eye.z);
    glUniform4fv(uniforms_.walls, static_cast<GLsizei>(walls.size()), &walls[0].x);
    glUniform1i(uniforms_.wallCount, static_cast<GLint>(fog.walls.size()));
    glUniform3f(uniforms_.low, low.x, low.y, low.z);
    glUniform3f(uniforms_.size, static_cast<float>(fog.size.x), static_cast<float>(fog.size.y),
                static_cast<float>(fog.size.z));
    glUniform1f(uniforms_.step, static_cast<float>(fog.step / unit));
    // Draws the back faces of the box, because they are visible even if the eye is inside the box.
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glDisable(GL_DEPTH_TEST);
    program_.draw(corners.data(), corners.size(), kBoxTriangles);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
}

}  // namespace oval4d::render

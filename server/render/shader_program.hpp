#pragma once
// A shader program with buffers for the triangles that it draws.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "render/gl.hpp"

namespace oval4d::render {

/// A vertex attribute (see glVertexAttribPointer(3G)). Components of the type GL_UNSIGNED_BYTE are color channels: 0 …
/// 255 in the buffer becomes 0 … 1 in the shader.
struct VertexAttribute {
    int components;      ///< the number of components: 1 … 4
    GLenum type;         ///< the type of each component: GL_FLOAT or GL_UNSIGNED_BYTE
    std::size_t offset;  ///< the offset of the attribute in the vertex structure, in bytes
};

/// A linked shader program with its own vertex buffer and index buffer, which grow as needed. Requires a current GL
/// context throughout its lifetime.
class ShaderProgram {
  public:
    /// Compiles and links the program. The sources must not contain a #version line, because the constructor adds this
    /// line. `vertexSize` is the size of a vertex in bytes. Attribute i has location i in the vertex shader. Throws
    /// std::runtime_error if a shader does not compile (with the message of the compiler) or the program does not link.
    ShaderProgram(std::string_view vertexSource, std::string_view fragmentSource, std::size_t vertexSize,
                  std::span<const VertexAttribute> attributes);
    ~ShaderProgram();
    ShaderProgram(const ShaderProgram&) = delete;
    ShaderProgram& operator=(const ShaderProgram&) = delete;

    /// Returns the location of the uniform variable `name`, or −1 if there is no such variable.
    GLint uniformLocation(const char* name) const { return glGetUniformLocation(program_, name); }
    void use() const { glUseProgram(program_); }

    /// Draws triangles in the order of `indices`. Every three successive entries of `indices` are the corners of one
    /// triangle, as indices of vertices. `vertices` points to `vertexCount` vertices of the size that was passed to the
    /// constructor. The arguments are copied.
    void draw(const void* vertices, std::size_t vertexCount, std::span<const std::uint32_t> indices);

    /// Copies vertices and indices of triangles for later calls of drawIndexRange(). The arguments are those of draw().
    void uploadTriangles(const void* vertices, std::size_t vertexCount, std::span<const std::uint32_t> indices);
    /// Draws the triangles whose corners are the entries `begin` … `end` − 1 of the indices that uploadTriangles() has
    /// copied last. Both numbers must be multiples of 3.
    void drawIndexRange(std::size_t begin, std::size_t end);

  private:
    void uploadBuffer(GLenum target, std::size_t& capacity, const void* data, std::size_t size);

    GLuint program_ = 0, array_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0;
    std::size_t vertexSize_ = 0, vertexCapacity_ = 0, indexCapacity_ = 0;
};

}  // namespace oval4d::render

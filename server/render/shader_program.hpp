#pragma once
// A shader program and the buffers of the triangles that it draws.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "render/gl.hpp"

namespace oval4d::render {

/// A vertex attribute, as for glVertexAttribPointer. Bytes are color channels: 0 … 255 becomes 0 … 1 in the shader.
struct Attribute {
    int components;
    GLenum type;         ///< GL_FLOAT or GL_UNSIGNED_BYTE
    std::size_t offset;  ///< offset in the vertex structure, in bytes
};

/// A linked program with its own vertex buffer and index buffer, which grow as needed. Requires a current GL context
/// throughout its lifetime.
class ShaderProgram {
  public:
    /// Compiles and links the program. The sources have no #version line. `vertexSize` is in bytes. Attribute i has
    /// location i in the vertex shader. Throws std::runtime_error, with the compiler's message, if a shader does not
    /// compile, or if the program does not link.
    ShaderProgram(std::string_view vertexSource, std::string_view fragmentSource, std::size_t vertexSize,
                  std::span<const Attribute> attributes);
    ~ShaderProgram();
    ShaderProgram(const ShaderProgram&) = delete;
    ShaderProgram& operator=(const ShaderProgram&) = delete;

    /// Returns the location of a uniform variable.
    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }
    void use() const { glUseProgram(program_); }

    /// Draws indexed triangles in the given order. `vertices` has `vertexCount` vertices of the size given to the
    /// constructor. Copies all data, so it need not remain valid.
    void draw(const void* vertices, std::size_t vertexCount, std::span<const std::uint32_t> indices);

  private:
    void upload(GLenum target, std::size_t& capacity, const void* data, std::size_t size);

    GLuint program_ = 0, array_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0;
    std::size_t vertexSize_ = 0, vertexCapacity_ = 0, indexCapacity_ = 0;
};

}  // namespace oval4d::render

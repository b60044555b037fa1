#pragma once
// A shader program and the triangles that it draws.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "render/gl.hpp"

namespace oval4d::render {

/// One member of a vertex, as glVertexAttribPointer takes it. Bytes are colour channels (0 … 255 ↦ 0 … 1).
struct Attribute {
    int components;
    GLenum type;  ///< GL_FLOAT or GL_UNSIGNED_BYTE
    std::size_t offset;
};

/// A linked program with one vertex and one index buffer of its own, which grow to the largest drawing. Needs a
/// current context for all of its life.
class Program {
  public:
    /// Attribute i is location i of the vertex shader. The sources have no #version line.
    /// Throws std::runtime_error with the compiler's words.
    Program(std::string_view vertexSource, std::string_view fragmentSource, std::size_t vertexSize,
            std::span<const Attribute> attributes);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }
    void use() const { glUseProgram(program_); }

    /// Draws indexed triangles in their order.
    void draw(const void* vertices, std::size_t vertexCount, std::span<const std::uint32_t> indices);

  private:
    void upload(GLenum target, std::size_t& capacity, const void* data, std::size_t size);

    GLuint program_ = 0, array_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0;
    std::size_t vertexSize_ = 0, vertexCapacity_ = 0, indexCapacity_ = 0;
};

}  // namespace oval4d::render

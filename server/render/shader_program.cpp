#include "render/shader_program.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

namespace oval4d::render {

namespace {

GLuint compileShader(GLenum kind, std::string_view source) {
    const std::string text = "#version 330 core\n" + std::string(source);
    const char* data = text.c_str();
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &data, nullptr);
    glCompileShader(shader);
    GLint done = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done == GL_FALSE) {
        char log[2048] = {};
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        glDeleteShader(shader);
        throw std::runtime_error(std::string("a shader does not compile: ") + log);
    }
    return shader;
}

}  // namespace

ShaderProgram::ShaderProgram(std::string_view vertexSource, std::string_view fragmentSource, std::size_t vertexSize,
                             std::span<const VertexAttribute> attributes)
    : vertexSize_(vertexSize) {
    const GLuint vertex = compileShader(GL_VERTEX_SHADER, vertexSource);
    const GLuint fragment = compileShader(GL_FRAGMENT_SHADER, fragmentSource);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex);
    glAttachShader(program_, fragment);
    glLinkProgram(program_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint done = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &done);
    if (done == GL_FALSE) throw std::runtime_error("a shader program does not link");

    glGenVertexArrays(1, &array_);
    glGenBuffers(1, &vertexBuffer_);
    glGenBuffers(1, &indexBuffer_);
    glBindVertexArray(array_);
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_);
    for (GLuint i = 0; i < attributes.size(); ++i) {
        const VertexAttribute& a = attributes[i];
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, a.components, a.type, a.type == GL_UNSIGNED_BYTE ? GL_TRUE : GL_FALSE,
                              static_cast<GLsizei>(vertexSize), reinterpret_cast<const void*>(a.offset));
    }
}

ShaderProgram::~ShaderProgram() {
    glDeleteBuffers(1, &vertexBuffer_);
    glDeleteBuffers(1, &indexBuffer_);
    glDeleteVertexArrays(1, &array_);
    glDeleteProgram(program_);
}

void ShaderProgram::uploadBuffer(GLenum target, std::size_t& capacity, const void* data, std::size_t size) {
    if (size > capacity) {
        capacity = std::max<std::size_t>(std::bit_ceil(size), 65536);
        glBufferData(target, static_cast<GLsizeiptr>(capacity), nullptr, GL_STREAM_DRAW);
    }
    glBufferSubData(target, 0, static_cast<GLsizeiptr>(size), data);
}

void ShaderProgram::draw(const void* vertices, std::size_t vertexCount, std::span<const std::uint32_t> indices) {
    uploadTriangles(vertices, vertexCount, indices);
    drawIndexRange(0, indices.size());
}

void ShaderProgram::uploadTriangles(const void* vertices, std::size_t vertexCount,
                                    std::span<const std::uint32_t> indices) {
    if (indices.empty()) return;
    glBindVertexArray(array_);
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
    uploadBuffer(GL_ARRAY_BUFFER, vertexCapacity_, vertices, vertexCount * vertexSize_);
    uploadBuffer(GL_ELEMENT_ARRAY_BUFFER, indexCapacity_, indices.data(), indices.size_bytes());
}

void ShaderProgram::drawIndexRange(std::size_t begin, std::size_t end) {
    if (begin == end) return;
    glUseProgram(program_);
    glBindVertexArray(array_);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - begin), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(begin * sizeof(std::uint32_t)));
}

}  // namespace oval4d::render

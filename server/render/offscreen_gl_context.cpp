#include "render/offscreen_gl_context.hpp"

#include <stdexcept>
#include <string>

#include "render/gl.hpp"

namespace oval4d::render {

struct OffscreenGlContext::NativeContext {
    OSMesaContext context = nullptr;
    std::uint8_t pixel[4]{};  // the default framebuffer of the context; nothing is drawn to it
    GLuint framebuffer = 0, color = 0, depth = 0;

    // The framebuffer and its buffers are deleted with the context.
    ~NativeContext() {
        if (context != nullptr) OSMesaDestroyContext(context);
    }
};

// The context draws pictures to a framebuffer object. OSMesa (of Mesa 22) would leak most of the memory of its default
// framebuffer each time the size changes.
OffscreenGlContext::OffscreenGlContext() : native_(std::make_unique<NativeContext>()) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    loadGl();
    native_->context = OSMesaCreateContextAttribs(attributes, nullptr);
    if (native_->context == nullptr) throw std::runtime_error("OSMesa cannot create an OpenGL 3.3 core context");
    makeCurrent();
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &maxSize_);
    glGenTextures(1, &native_->color);
    glGenRenderbuffers(1, &native_->depth);
    glGenFramebuffers(1, &native_->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, native_->framebuffer);
    resize(1, 1);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, native_->color, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, native_->depth);
}

OffscreenGlContext::~OffscreenGlContext() = default;

void OffscreenGlContext::makeCurrent() {
    if (OSMesaMakeCurrent(native_->context, native_->pixel, GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE)
        throw std::runtime_error("OSMesa cannot make its context current");
}

void OffscreenGlContext::resize(int width, int height) {
    width_ = width;
    height_ = height;
    glBindTexture(GL_TEXTURE_2D, native_->color);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindRenderbuffer(GL_RENDERBUFFER, native_->depth);
    // 16 bits per depth suffice to draw a few hundred slices one behind another in the right order.
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, width, height);
}

void OffscreenGlContext::begin(int width, int height, std::uint8_t* pixels) {
    if (width > maxSize_ || height > maxSize_)
        throw std::runtime_error("a picture of " + std::to_string(width) + " × " + std::to_string(height) +
                                 " pixels is too large: the driver allows at most " + std::to_string(maxSize_) +
                                 " in each direction");
    makeCurrent();
    if (width != width_ || height != height_) resize(width, height);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        width_ = 0;  // no picture has this width, so the next begin() allocates the buffers again
        throw std::runtime_error("OSMesa cannot draw a picture of " + std::to_string(width) + " × " +
                                 std::to_string(height) + " pixels");
    }
    pixels_ = pixels;
    glViewport(0, 0, width, height);
}

void OffscreenGlContext::replacePicture(const std::uint8_t* pixels) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, native_->color);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

// Creates and deletes a fence: creating a fence flushes the commands without waiting.
void OffscreenGlContext::flush() { glDeleteSync(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)); }

void OffscreenGlContext::readPixels() { glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels_); }

}  // namespace oval4d::render

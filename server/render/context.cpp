#include "render/context.hpp"

#include <stdexcept>
#include <string>

#include "render/gl.hpp"
// After gl.hpp, which enables the prototypes of the core profile.
#include <GL/osmesa.h>

namespace oval4d::render {

// Sufficient for a few hundred slices behind one another.
constexpr int kDepthBits = 16;

struct Context::Native {
    OSMesaContext context = nullptr;

    ~Native() {
        if (context != nullptr) OSMesaDestroyContext(context);
    }
};

Context::Context() : native_(std::make_unique<Native>()) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              kDepthBits,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    native_->context = OSMesaCreateContextAttribs(attributes, nullptr);
    if (native_->context == nullptr) throw std::runtime_error("OSMesa cannot create an OpenGL 3.3 core context");
    std::uint8_t pixel[4];
    begin(1, 1, pixel);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &maxSize_);
    finish();
}

Context::~Context() = default;

void Context::begin(int width, int height, std::uint8_t* pixels) {
    if (maxSize_ > 0 && (width > maxSize_ || height > maxSize_))
        throw std::runtime_error("a picture of " + std::to_string(width) + " × " + std::to_string(height) +
                                 " pixels is too large: the driver allows at most " + std::to_string(maxSize_) +
                                 " in each direction");
    if (OSMesaMakeCurrent(native_->context, pixels, GL_UNSIGNED_BYTE, width, height) == GL_FALSE)
        throw std::runtime_error("OSMesa cannot draw a picture of " + std::to_string(width) + " × " +
                                 std::to_string(height) + " pixels");
    OSMesaPixelStore(OSMESA_Y_UP, 1);
    glViewport(0, 0, width, height);
}

// Creating a fence flushes the commands. glFlush would also copy the whole picture.
void Context::start() { glDeleteSync(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)); }

void Context::finish() { glFinish(); }

}  // namespace oval4d::render

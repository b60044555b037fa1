#pragma once
// An OpenGL context that draws into memory instead of a window.

#include <cstdint>
#include <memory>

namespace oval4d::render {

/// An OpenGL 3.3 core context that draws into memory. Only the thread that created the context may use it. Only this
/// class calls functions of OSMesa (the library that draws OpenGL into memory); the rest of the renderer calls only
/// OpenGL.
class OffscreenGlContext {
  public:
    /// Creates the context and makes it current. Throws std::runtime_error if this is not possible.
    OffscreenGlContext();
    ~OffscreenGlContext();
    OffscreenGlContext(const OffscreenGlContext&) = delete;
    OffscreenGlContext& operator=(const OffscreenGlContext&) = delete;

    /// Makes the context current, and starts a picture of width × height pixels. readPixels() writes the picture to
    /// `pixels`, which must remain valid until then: RGBA with 8 bits per channel, the bottom row first. Throws
    /// std::runtime_error if the driver does not support pictures of this size.
    void begin(int width, int height, std::uint8_t* pixels);

    /// Replaces the current picture by `pixels`, which have the same size and layout as the pixels that were passed to
    /// begin().
    void replacePicture(const std::uint8_t* pixels);

    /// Lets the threads of the driver begin to rasterize everything that has been drawn so far. Does not wait until
    /// they have finished.
    void flush();

    /// Waits until the picture is drawn. Then copies the picture to the pixels that were passed to begin().
    void readPixels();

    /// Returns the maximum width and height of a picture in pixels.
    int maxPictureSide() const { return maxSize_; }

  private:
    void makeCurrent();
    void resize(int width, int height);

    struct NativeContext;
    std::unique_ptr<NativeContext> native_;
    int maxSize_ = 0;
    int width_ = 0, height_ = 0;
    std::uint8_t* pixels_ = nullptr;  // the memory to which readPixels() writes the current picture
};

}  // namespace oval4d::render

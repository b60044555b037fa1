#pragma once
// An off-screen OpenGL context.

#include <cstdint>
#include <memory>

namespace oval4d::render {

/// An OpenGL 3.3 core context that draws into memory. It may be used only by the thread that created it. No other class
/// uses OSMesa; the rest of the renderer is plain OpenGL.
class Context {
  public:
    /// Throws std::runtime_error if no context can be created.
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes the context current and starts a picture of width × height pixels. finish() writes the picture to
    /// `pixels`, which must remain valid until then: RGBA, 8 bits per channel, rows from the bottom up. Throws
    /// std::runtime_error if the driver does not support pictures of this size.
    void begin(int width, int height, std::uint8_t* pixels);

    /// Makes the driver's threads begin to rasterize what was drawn so far, and returns without waiting for them.
    void flush();

    /// Waits until the picture is drawn, and copies it.
    void finish();

    /// Returns the maximum width and height of a picture in pixels.
    int maxSize() const { return maxSize_; }

  private:
    void makeCurrent();
    void resize(int width, int height);

    struct Native;
    std::unique_ptr<Native> native_;
    int maxSize_ = 0;
    int width_ = 0, height_ = 0;
    std::uint8_t* pixels_ = nullptr;  // of the current picture
};

}  // namespace oval4d::render

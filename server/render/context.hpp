#pragma once
// An off-screen OpenGL context.

#include <cstdint>
#include <memory>

namespace oval4d::render {

/// An OpenGL 3.3 core context that draws into memory. Bound to the thread that creates it. The only class that uses
/// OSMesa; the rest of the renderer is plain OpenGL.
class Context {
  public:
    /// Throws std::runtime_error if no context can be created.
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes the context current for a picture of width × height pixels, which finish() writes to `pixels`: RGBA, 8
    /// bits per channel, rows from the bottom up. `pixels` must remain valid until then. Throws std::runtime_error if
    /// the driver does not support pictures of this size.
    void begin(int width, int height, std::uint8_t* pixels);

    /// Makes the driver's threads start rasterizing what was drawn so far, without waiting for them.
    void start();

    /// Waits until the picture is drawn. Call it once per picture, because each call copies the whole picture.
    void finish();

    /// The maximum width and height of a picture.
    int maxSize() const { return maxSize_; }

  private:
    struct Native;
    std::unique_ptr<Native> native_;
    int maxSize_ = 0;
};

}  // namespace oval4d::render

#pragma once
// An off-screen OpenGL context.

#include <cstdint>
#include <memory>

namespace oval4d::render {

/// An OpenGL 3.3 core context that draws into memory. Bound to one thread: the one that makes it. All that knows
/// OSMesa is in this class; the rest of the renderer is plain OpenGL.
class Context {
  public:
    /// Throws std::runtime_error if no context can be had.
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes the context current, drawing a picture of width × height pixels. `pixels` is where finish() leaves it:
    /// RGBA, 8 bits a channel, rows from the bottom up; it must live until then. Throws std::runtime_error if a
    /// picture of this size is too large for the driver.
    void begin(int width, int height, std::uint8_t* pixels);

    /// Lets the driver's threads fill the pixels of what was drawn so far, and does not wait for them.
    void start();

    /// Waits until the picture is drawn. Once a frame: every call copies the whole of it.
    void finish();

    /// The largest width and height of a picture.
    int maxSize() const { return maxSize_; }

  private:
    struct Native;
    std::unique_ptr<Native> native_;
    int maxSize_ = 0;
};

}  // namespace oval4d::render

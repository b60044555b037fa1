#include "libpng_encoder.hpp"

#include <png.h>

#include <chrono>
#include <stdexcept>
#include <vector>

namespace oval4d::bench {

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encode(const png_image& image, const Bytes& pixels) {
    Bytes file;
    file.reserve(pixels.size() / 2);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const auto append = [](png_structp to, png_bytep data, png_size_t size) {
        auto* out = static_cast<Bytes*>(png_get_io_ptr(to));
        out->insert(out->end(), data, data + size);
    };
    png_set_write_fn(png, &file, append, [](png_structp) {});
    png_set_IHDR(png, info, image.width, image.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, 1);
    png_write_info(png, info);
    for (std::size_t y = 0; y < image.height; ++y) png_write_row(png, pixels.data() + 3 * y * image.width);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

}  // namespace

LibpngFile encodeByLibpng(std::span<const std::uint8_t> png) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) throw std::runtime_error(image.message);
    image.format = PNG_FORMAT_RGB;
    Bytes pixels(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) throw std::runtime_error(image.message);
    const auto start = std::chrono::steady_clock::now();
    const std::size_t bytes = encode(image, pixels).size();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), bytes};
}

}  // namespace oval4d::bench

#include "raster/shared_pixels.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace oval4d::raster {

namespace {

// resize() shrinks the memory file if its size is more than this many times the requested size.
constexpr std::size_t kWaste = 4;

void throwSystemErrorUnless(bool done) {
    if (!done) throw std::system_error(errno, std::generic_category(), "cannot allocate memory for a picture");
}

struct stat statusOf(int file) {
    struct stat status{};
    throwSystemErrorUnless(fstat(file, &status) == 0);
    return status;
}

}  // namespace

SharedPixels::SharedPixels() : SharedPixels(memfd_create("oval4d-picture", MFD_CLOEXEC)) {}

SharedPixels::SharedPixels(int file) : file_(file) {
    throwSystemErrorUnless(file >= 0);
    inode_ = statusOf(file).st_ino;
}

SharedPixels::~SharedPixels() {
    map(0);
    close(file_);
}

std::span<std::uint8_t> SharedPixels::resize(std::size_t size) {
    if (size > mapped_.size() || size * kWaste < mapped_.size()) {
        map(0);
        throwSystemErrorUnless(ftruncate(file_, static_cast<off_t>(size)) == 0);
        map(size);
    }
    return mapped_.first(size);
}

std::span<std::uint8_t> SharedPixels::remapIfResized(std::size_t size) {
    const auto now = static_cast<std::size_t>(statusOf(file_).st_size);
    if (now != mapped_.size()) {
        map(0);
        map(now);
    }
    if (size > now)
        throw std::system_error(EINVAL, std::generic_category(), "the shared memory is smaller than the picture");
    return mapped_.first(size);
}

void SharedPixels::map(std::size_t size) {
    if (!mapped_.empty()) munmap(mapped_.data(), mapped_.size());
    mapped_ = {};
    if (size == 0) return;
    void* const at = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    throwSystemErrorUnless(at != MAP_FAILED);
    mapped_ = {static_cast<std::uint8_t*>(at), size};
}

}  // namespace oval4d::raster

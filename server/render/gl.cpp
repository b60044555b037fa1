#include "render/gl.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace oval4d::render {

#define OVAL4D_GL(function) decltype(&::function) function = nullptr;  // NOLINT(bugprone-macro-parentheses): a name
#include "render/gl_functions.inc"
#undef OVAL4D_GL

namespace {

/// Returns `found`, the result of dlopen() or dlsym(). Throws std::runtime_error if `found` is null.
void* requireLoaded(void* found) {
    if (found == nullptr) throw std::runtime_error(std::string("OSMesa cannot be loaded: ") + dlerror());
    return found;
}

bool loadOsMesaFunctions() {
    void* const library = requireLoaded(dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL));
#define OVAL4D_GL(function) function = reinterpret_cast<decltype(function)>(requireLoaded(dlsym(library, #function)));
#include "render/gl_functions.inc"
#undef OVAL4D_GL
    return true;
}

}  // namespace

void loadGl() { [[maybe_unused]] static const bool isLoaded = loadOsMesaFunctions(); }

}  // namespace oval4d::render

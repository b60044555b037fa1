#pragma once
// Pointers to the functions that the renderer calls: those of OpenGL, and those of OSMesa, which draws OpenGL into
// memory. The first OffscreenGlContext loads the OSMesa library and sets the pointers. The program is not linked with
// this library, because most processes draw nothing. Loading the library takes several times as long as starting the
// rest of the program, because the library also loads LLVM, which compiles shaders.

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

namespace oval4d::render {

// Declares one pointer. Within this namespace, it hides the function with the same name that the OpenGL headers
// declare.
#define OVAL4D_GL(function) extern decltype(&::function) function;  // NOLINT(bugprone-macro-parentheses): a name
#include "render/gl_functions.inc"
#undef OVAL4D_GL

/// Loads OSMesa and sets the pointers to its functions. Does nothing if OSMesa is already loaded. Throws
/// std::runtime_error if OSMesa or one of the functions cannot be loaded.
void loadGl();

}  // namespace oval4d::render

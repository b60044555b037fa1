#pragma once
// The functions of OpenGL and OSMesa that the renderer calls, as pointers. The first OffscreenGlContext loads the
// OSMesa library and sets the pointers. The program is not linked with this library, because most processes draw
// nothing, and loading the library takes several times as long as starting the rest of the program: the library also
// loads LLVM, which compiles shaders.

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

namespace oval4d::render {

// Within this namespace, each pointer hides the function with the same name that the headers above declare.
#define OVAL4D_GL(function) extern decltype(&::function) function;  // NOLINT(bugprone-macro-parentheses): a name
#include "render/gl_functions.inc"
#undef OVAL4D_GL

/// Loads OSMesa and sets the pointers; does nothing if OSMesa is already loaded. Throws std::runtime_error if OSMesa or
/// one of the functions cannot be loaded.
void loadGl();

}  // namespace oval4d::render

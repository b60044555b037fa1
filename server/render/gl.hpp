#pragma once
// The functions of OpenGL and OSMesa that the renderer calls, as pointers. The first Context loads their library and
// sets the pointers. The program is not linked with the library, because to load it, with LLVM, its compiler of
// shaders, takes several times as long as to start the rest of the program, and most processes draw nothing.

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

namespace oval4d::render {

// Within this namespace, the pointers hide the functions of the headers.
#define OVAL4D_GL(function) extern decltype(&::function) function;  // NOLINT(bugprone-macro-parentheses): a name
#include "render/gl_functions.inc"
#undef OVAL4D_GL

/// Loads OSMesa, unless it is loaded, and sets the pointers. Throws std::runtime_error if it cannot be loaded.
void loadGl();

}  // namespace oval4d::render

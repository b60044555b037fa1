#pragma once
// OpenGL with function prototypes of the core profile.

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#pragma once
// OpenGL with the prototypes of its core profile.

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

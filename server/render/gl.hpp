#pragma once
// Includes the OpenGL headers, with the function prototypes of the core profile.

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

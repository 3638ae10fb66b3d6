// The one place where tinyobjloader's code is compiled.
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

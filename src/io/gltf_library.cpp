// The one place where tinygltf's code is compiled.
#define TINYGLTF_IMPLEMENTATION
#include <fstream> // tinygltf's writers need it but include it only where it may open files

#include <tiny_gltf.h>

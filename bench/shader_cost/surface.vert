#version 450
layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in vec4 mesh_tangent;
layout(location = 3) in vec2 mesh_st;
layout(location = 4) in vec2 mesh_st_2;

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec2 st;
layout(location = 4) out vec2 st_2;

layout(push_constant) uniform Camera { mat4 clip_from_world; };

// The mesh is in world space: outputs that depend on attributes keep the fragment shader's inputs alive.
void main() {
  position = mesh_position;
  normal = mesh_normal;
  tangent = mesh_tangent;
  st = mesh_st;
  st_2 = mesh_st_2;
  gl_Position = clip_from_world * vec4(mesh_position, 1.0);
}

#version 450
layout(location = 0) in vec3 position_in; // relative to the eye
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec2 st0_in;
layout(location = 3) in vec2 st1_in;
layout(location = 4) in vec2 st2_in;

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 st0;
layout(location = 3) out vec2 st1;
layout(location = 4) out vec2 st2;

layout(push_constant) uniform Camera { mat4 clip_from_relative; };

void main() {
  position = position_in;
  normal = normal_in;
  st0 = st0_in;
  st1 = st1_in;
  st2 = st2_in;
  gl_Position = clip_from_relative * vec4(position_in, 1);
}

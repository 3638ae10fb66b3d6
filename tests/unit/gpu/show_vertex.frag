#version 450

// Shows what a vertex stage made, as it is.

layout(location = 0) in vec3 undisplaced;
layout(location = 1) in vec3 displaced_normal;
layout(location = 2) in vec4 clip_position;
layout(location = 0) out vec4 shown_position;
layout(location = 1) out vec4 shown_undisplaced;
layout(location = 2) out vec4 shown_normal;

void main() {
  shown_position = clip_position;
  shown_undisplaced = vec4(undisplaced, 0.0);
  shown_normal = vec4(displaced_normal, 0.0);
}

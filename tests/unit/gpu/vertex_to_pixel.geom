#version 450

// Puts vertex i of examples/displace_bump.vert on pixel i of a row, with what the vertex stage made of it:
// with SHOW_POSITION its position too, for show_vertex.frag.

layout(points) in;
layout(location = 0) in vec3 undisplaced[];
layout(location = 1) in vec3 displaced_normal[];

layout(points, max_vertices = 1) out;
layout(location = 0) out vec3 undisplaced_there;
layout(location = 1) out vec3 displaced_normal_there;
#ifdef SHOW_POSITION
layout(location = 2) out vec4 clip_position;
#endif

const float pixels = 4096.0; // of the row

void main() {
  gl_Position = vec4((2.0 * float(gl_PrimitiveIDIn) + 1.0) / pixels - 1.0, 0.0, 0.0, 1.0);
  gl_PrimitiveID = gl_PrimitiveIDIn;
  undisplaced_there = undisplaced[0];
  // Normals that were interpolated are shorter than one: those of every second vertex are halved.
  displaced_normal_there = ((gl_PrimitiveIDIn & 1) == 0 ? 1.0 : 0.5) * displaced_normal[0];
#ifdef SHOW_POSITION
  clip_position = gl_in[0].gl_Position;
#endif
  EmitVertex();
}

// Reoriented normal mapping (Barré-Brisebois and Hill 2012): the detail's normal turned by the shortest
// rotation from +z to the base's. Both unit, as maps hold them; so is the result.
vec3 reoriented(vec3 base, vec3 detail) {
  vec3 t = base + vec3(0.0, 0.0, 1.0);
  vec3 u = detail * vec3(-1.0, -1.0, 1.0);
  return t * (dot(t, u) / t.z) - u;
}

// The same times t.z, for whoever normalises next: without the division.
vec3 reoriented_any_length(vec3 base, vec3 detail) {
  vec3 t = base + vec3(0.0, 0.0, 1.0);
  vec3 u = detail * vec3(-1.0, -1.0, 1.0);
  return t * dot(t, u) - u * t.z;
}

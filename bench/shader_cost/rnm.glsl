// Reoriented normal mapping (Barré-Brisebois and Hill 2012): the detail's normal turned by the shortest
// rotation from +z to the base's; both unit, as maps hold them. Written as it is published.
vec3 reoriented(vec3 base, vec3 detail) {
  vec3 t = base + vec3(0.0, 0.0, 1.0);
  vec3 u = detail * vec3(-1.0, -1.0, 1.0);
  return t * dot(t, u) / t.z - u;
}

// The same, grouped so that it costs least: no compiler may do that by itself.
vec3 reoriented_regrouped(vec3 base, vec3 detail) {
  vec3 t = base + vec3(0.0, 0.0, 1.0);
  vec3 u = detail * vec3(-1.0, -1.0, 1.0);
  return t * (dot(t, u) / t.z) - u;
}

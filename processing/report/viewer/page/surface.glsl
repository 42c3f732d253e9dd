// The mesh in textures: what a pixel's ray meets, and what stands between a point and the light.
// Triangles in the order of the hierarchy's leaves, six texels each: corners with u, then vertex normals with v.
uniform highp sampler2D triangleMap, nodeMap, triangleNumberMap;
uniform int nodeCount;
uniform float surfaceOffset;  // m; as RayScene::surface_offset_m
uniform vec3 eye, rightward, upward, forward;
uniform vec2 pictureSize, jitter;  // jitter: px, of where in the pixel the ray goes
uniform float focal;  // px

const int kRow = 2046;
vec4 triangleTexel(int triangle, int k) {
  int at = triangle * 6 + k;
  return texelFetch(triangleMap, ivec2(at % kRow, at / kRow), 0);
}
vec4 nodeTexel(int at) { return texelFetch(nodeMap, ivec2(at % kRow, at / kRow), 0); }

struct Point { vec3 position, geometricNormal, vertexNormal; vec2 texcoord; int triangle; };

bool pointAt(vec2 pixel, out Point p) {
  vec3 code = floor(texelFetch(triangleNumberMap, ivec2(pixel), 0).rgb * 255.0 + 0.5);
  p.triangle = int(code.r) + 256 * int(code.g) + 65536 * int(code.b) - 1;
  if (p.triangle < 0) return false;
  vec2 off = (pixel + jitter - 0.5 * pictureSize) / focal;
  vec3 ray = normalize(forward + off.x * rightward + off.y * upward);
  vec4 a = triangleTexel(p.triangle, 0), b = triangleTexel(p.triangle, 1), c = triangleTexel(p.triangle, 2);
  vec4 na = triangleTexel(p.triangle, 3), nb = triangleTexel(p.triangle, 4), nc = triangleTexel(p.triangle, 5);
  vec3 ab = b.xyz - a.xyz, ac = c.xyz - a.xyz, from = eye - a.xyz, across = cross(ray, ac);
  float volume = dot(ab, across);
  // The rasteriser rounds corners to a fraction of a pixel: at its edge a triangle may be drawn that the ray just misses.
  float v = clamp(dot(from, across) / volume, 0.0, 1.0), w = clamp(dot(ray, cross(from, ab)) / volume, 0.0, 1.0 - v), u = 1.0 - v - w;
  p.position = u * a.xyz + v * b.xyz + w * c.xyz;
  p.geometricNormal = normalize(cross(ab, ac));
  p.vertexNormal = normalize(u * na.xyz + v * nb.xyz + w * nc.xyz);
  p.texcoord = u * vec2(a.w, na.w) + v * vec2(b.w, nb.w) + w * vec2(c.w, nc.w);
  return true;
}

bool meets(int triangle, vec3 from, vec3 ray, float reach) {
  vec3 a = triangleTexel(triangle, 0).xyz, ab = triangleTexel(triangle, 1).xyz - a, ac = triangleTexel(triangle, 2).xyz - a;
  vec3 across = cross(ray, ac), start = from - a, second = cross(start, ab);
  float volume = dot(ab, across);
  if (volume == 0.0) return false;
  float v = dot(start, across) / volume, w = dot(ray, second) / volume, t = dot(ac, second) / volume;
  return v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t > 0.0 && t < reach;
}

// Nodes in depth-first order: low corner and the node to go on with where this one is missed or done; high corner and, of a leaf,
// 8 times its first triangle plus their number (inner nodes: -1).
bool occluded(vec3 from, vec3 ray, float reach) {
  vec3 inverse = 1.0 / mix(ray, vec3(1e-20), equal(ray, vec3(0.0)));
  int node = 0;
  while (node < nodeCount) {
    vec4 low = nodeTexel(2 * node), high = nodeTexel(2 * node + 1);
    vec3 s = (low.xyz - from) * inverse, e = (high.xyz - from) * inverse, near = min(s, e), far = max(s, e);
    float enter = max(max(near.x, near.y), max(near.z, 0.0)), leave = min(min(far.x, far.y), min(far.z, reach));
    if (enter > leave * 1.000001) { node = int(low.w); continue; }
    int leaf = int(high.w);
    if (leaf < 0) { ++node; continue; }
    for (int i = 0; i < leaf % 8; ++i) {
      if (meets(leaf / 8 + i, from, ray, reach)) return true;
    }
    node = int(low.w);
  }
  return false;
}

bool seesLight(Point p, vec3 light) {
  vec3 start = p.position + surfaceOffset * p.geometricNormal, towards = light - start;
  float reach = length(towards);
  return !occluded(start, towards / reach, reach);
}

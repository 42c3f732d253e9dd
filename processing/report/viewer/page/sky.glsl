// One random sample of what the sky and the surface send to the eye through a pixel, and the sum with those before. Its mean is what
// processing/render/path_tracer.h computes without bounces: a texel is drawn by its bilinear weight; a direction is drawn from the sky and
// another from a mixture of lobes about the mirror direction and the normal, weighed against each other by the balance heuristic (Veach,
// Guibas 1995); light counts from above the triangle and above the shading normal.
uniform highp sampler2D skyMap;    // radiance; density in the world by the sky's own brightness, 1/sr
uniform highp sampler2D aliasMap;  // a pixel of the sky in proportion to its light (Vose 1991): share that stays, number to go to else
uniform highp sampler2D sumMap;
uniform ivec2 skySize;
uniform float skyTurn;  // rad, about the world's z
uniform int pass;

const float kPi = 3.14159265;
const float kExponents[4] = float[4](1.0, 32.0, 512.0, 8192.0);  // of cos^N; the first about the normal

uint randomState;
// PCG (Jarzynski, Olano 2020), hashed by pixel and pass.
float random() {
  randomState = randomState * 747796405u + 2891336453u;
  uint word = ((randomState >> ((randomState >> 28u) + 4u)) ^ randomState) * 277803737u;
  return float((word >> 22u ^ word) >> 8) / 16777216.0;
}
uint hashed(uint value) {
  value = (value ^ 61u) ^ (value >> 16u);
  value *= 9u;
  value ^= value >> 4u;
  value *= 0x27d4eb2du;
  return value ^ (value >> 15u);
}

vec3 turned(vec3 d, float angle) {
  return vec3(cos(angle) * d.x - sin(angle) * d.y, sin(angle) * d.x + cos(angle) * d.y, d.z);
}

vec4 skyAt(vec3 direction) {
  vec3 d = turned(direction, -skyTurn);
  vec2 at = vec2(0.5 - atan(d.y, d.x) / (2.0 * kPi), atan(length(d.xy), d.z) / kPi);
  return texelFetch(skyMap, clamp(ivec2(at * vec2(skySize)), ivec2(0), skySize - 1), 0);
}

vec3 skyDirection() {
  int count = skySize.x * skySize.y, entry = min(int(random() * float(count)), count - 1);
  vec2 alias = texelFetch(aliasMap, ivec2(entry % skySize.x, entry / skySize.x), 0).xy;
  if (random() >= alias.x) entry = int(alias.y);
  float row = float(entry / skySize.x), rows = float(skySize.y), longitude = kPi * (1.0 - 2.0 * (float(entry % skySize.x) + random()) / float(skySize.x));
  float z = mix(cos(kPi * row / rows), cos(kPi * (row + 1.0) / rows), random()), level = sqrt(max(0.0, 1.0 - z * z));
  return turned(vec3(level * cos(longitude), level * sin(longitude), z), skyTurn);
}

vec3 mirrored(vec3 normal, vec3 wo) { return 2.0 * dot(normal, wo) * normal - wo; }

float lobeDensity(vec3 normal, vec3 mirror, vec3 wi) {
  float sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    vec3 off = wi - (k == 0 ? normal : mirror);
    float gap = 0.5 * dot(off, off);
    if (gap < 1.0) sum += (kExponents[k] + 1.0) / (2.0 * kPi) * exp(kExponents[k] * logOneMinus(gap));
  }
  return 0.25 * sum;
}

vec3 lobeDirection(vec3 normal, vec3 mirror) {
  int k = min(int(4.0 * random()), 3);
  vec3 axis = k == 0 ? normal : mirror, side = normalize(cross(axis, abs(axis.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  // 1 - cos from its logarithm: near the axis the cosine itself has no digits.
  float gap = 1.0 - exp(log(1.0 - random()) / (kExponents[k] + 1.0)), angle = 2.0 * kPi * random(), level = sqrt(max(0.0, gap * (2.0 - gap)));
  return normalize((1.0 - gap) * axis + level * (cos(angle) * side + sin(angle) * cross(axis, side)));
}

vec3 lightFrom(Point p, vec3 normal, ivec2 at, vec3 wi, vec3 wo) {
  Geometry g = geometryOf(normal, wi, wo);
  if (g.cosI <= 0.0 || g.cosO <= 0.0 || dot(p.geometricNormal, wi) <= 0.0) return vec3(0.0);
  vec4 sky = skyAt(wi);
  float density = sky.a + lobeDensity(normal, mirrored(normal, wo), wi);
  vec3 light = g.cosI * reflectance(at, g) * sky.rgb / density;
  const float kFar = 1e6;  // times the offset: ten diagonals
  if (light == vec3(0.0) || (shadows && occluded(p.position + surfaceOffset * p.geometricNormal, wi, kFar * surfaceOffset))) return vec3(0.0);
  return light;
}

vec3 skySample(Point p, Texels t) {
  vec3 wo = normalize(eye - p.position);
  if (dot(p.geometricNormal, wo) <= 0.0) return vec3(0.0);
  float choice = random();
  int chosen = -1;
  for (int k = 0; k < 4 && chosen < 0; ++k) {
    choice -= t.weight[k];
    if (choice < 0.0) chosen = k;
  }
  if (chosen < 0) chosen = nearest(t);
  if (t.weight[chosen] == 0.0) return vec3(0.0);
  vec3 normal = normalAt(t, chosen, p);
  vec3 sum = lightFrom(p, normal, t.at[chosen], skyDirection(), wo);
  return sum + lightFrom(p, normal, t.at[chosen], lobeDirection(normal, mirrored(normal, wo)), wo);
}

// Sum of the radiance, and how many passes met the object.
vec4 skySum(Point p, bool hit) {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 sum = pass > 0 ? texelFetch(sumMap, at, 0) : vec4(0.0);
  if (!hit) return sum;
  randomState = hashed(uint(at.x) + 16384u * uint(at.y)) ^ hashed(uint(pass) * 2654435769u);
  randomState = hashed(randomState);
  return sum + vec4(skySample(p, texelsAround(p.texcoord)), 1.0);
}

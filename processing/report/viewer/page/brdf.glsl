// The lobes of processing/brdf (lafortune.cpp, ggx.cpp, ward.cpp) in single precision, and the table of BRDFs that they are read from:
// a row a BRDF; texel 0 diffuse and number of entries, then two for every entry, which is what of a lobe has one shape:
// strengths of the channels and family + 4, 8, 16 for the channels that are on; (shape, mirror, retro, grazing).
// Software renderers compute all sides of a branch, so a family that no BRDF is of (HAS_...) is left out of the program.
uniform highp sampler2D basisMap;

struct Geometry { float cosI, cosO, mirrorGap, retroGap, across2; };

Geometry geometryOf(vec3 normal, vec3 wi, vec3 wo) {
  Geometry g;
  g.cosI = dot(normal, wi);
  g.cosO = dot(normal, wo);
  vec3 across = (wi - g.cosI * normal) + (wo - g.cosO * normal);
  g.across2 = dot(across, across);
  float difference = g.cosI - g.cosO;
  g.mirrorGap = 0.5 * (g.across2 + difference * difference);
  vec3 apart = wi - wo;
  g.retroGap = 0.5 * dot(apart, apart);
  return g;
}

// ln(1 - x): near x = 0 by its series, or the digits that a sharp lobe needs are gone.
float logOneMinus(float x) {
  if (x > 0.04) return log(1.0 - x);
  return -x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0 + x * (1.0 / 5.0 + x / 6.0)))));
}

// x: gain, y: offset.
vec2 lafortune(vec4 shape, Geometry g) {
  float belowOne = shape.y * g.mirrorGap + shape.z * g.retroGap + shape.w * g.cosI * g.cosO;
  return belowOne >= 1.0 ? vec2(0.0) : vec2(exp(shape.x * logOneMinus(belowOne)), 0.0);
}

vec2 ggx(float alpha, Geometry g) {
  float along = g.cosI + g.cosO, alpha2 = alpha * alpha;
  float spread = (g.across2 + along * along) / (g.across2 + alpha2 * along * along);
  float rootI = sqrt(alpha2 + (1.0 - alpha2) * g.cosI * g.cosI), rootO = sqrt(alpha2 + (1.0 - alpha2) * g.cosO * g.cosO);
  float value = alpha2 * spread * spread / 3.14159265 * 0.5 / (g.cosO * rootI + g.cosI * rootO);
  float cosHalf = min(1.0, 0.5 * sqrt(g.across2 + along * along));
  float fall = 0.5 * g.retroGap / (1.0 + cosHalf), fall2 = fall * fall, schlick = fall2 * fall2 * fall;
  return vec2(value * (1.0 - schlick), value * schlick);
}

vec2 ward(float alpha, Geometry g) {
  float along = g.cosI + g.cosO, along2 = along * along, alpha2 = alpha * alpha;
  return vec2(exp(-g.across2 / (alpha2 * along2)) / (3.14159265 * alpha2) * (g.across2 + along2) / along2 / along2, 0.0);
}

vec2 lobe(int family, vec4 shape, Geometry g) {
#if HAS_LAFORTUNE
  if (family == 0) return lafortune(shape, g);
#endif
#if HAS_GGX
  if (family == 1) return ggx(shape.x, g);
#endif
#if HAS_WARD
  if (family == 2) return ward(shape.x, g);
#endif
  return vec2(0.0);
}

// f, 1/sr; 0 if either direction is below the surface.
vec3 evaluateBrdf(int row, Geometry g) {
  if (g.cosI <= 0.0 || g.cosO <= 0.0) return vec3(0.0);
  vec4 head = texelFetch(basisMap, ivec2(0, row), 0);
  vec3 f = head.rgb;
  int entries = int(head.a);
  for (int i = 0; i < entries; ++i) {
    vec4 strength = texelFetch(basisMap, ivec2(1 + 2 * i, row), 0), shape = texelFetch(basisMap, ivec2(2 + 2 * i, row), 0);
    int code = int(strength.w);
    vec2 terms = lobe(code & 3, shape, g);
    f += strength.rgb * terms.x + vec3((ivec3(code) >> ivec3(2, 3, 4)) & 1) * terms.y;
  }
  return f;
}

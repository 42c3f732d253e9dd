// One pixel, as ViewRenderer (processing/model/render_view.cpp) computes it: f cos at each of the four texels around the point with
// that texel's own normal, blended bilinearly over those that have a material.
uniform highp sampler2D normalMap;   // xyz: unit, in world, zero: the vertex normal; w: 0, or -1 in a hole of the atlas
uniform highp sampler2D materialMap; // of the stage's layer: two bytes, one more than the material's number
uniform highp sampler2D figureMap;   // sigma, samples, residual, sigma of the normal; below 0: none
uniform highp sampler2DArray weightMap;
uniform vec2 atlasSize;
uniform int firstRow, rowsPerMaterial, rowCount;  // of basisMap: of the stage's first material; further ones; how many are mixed
uniform bool weighted, texelNormals, shadows;
uniform vec3 light, intensity;  // m, W/sr
uniform float exposure, figureScale;
uniform int clusterRow, colourColumn;

const int kRadiance = 0, kNormals = 1, kClusters = 2, kSigma = 3, kSamples = 4, kResidual = 5, kNormalSigma = 6, kTexel = 7, kLinear = 8, kFigures = 9, kSky = 10;
const int show = SHOW;

struct Texels { ivec2 at[4]; float weight[4]; vec4 normal[4]; };

// Weights sum to 1, or are all 0 in a hole of the atlas.
Texels texelsAround(vec2 texcoord) {
  Texels t;
  vec2 at = vec2(texcoord.x, 1.0 - texcoord.y) * atlasSize - 0.5, first = floor(at), part = at - first;
  float total = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k & 1, k >> 1);
    t.at[k] = clamp(ivec2(first) + step, ivec2(0), ivec2(atlasSize) - 1);
    t.normal[k] = texelFetch(normalMap, t.at[k], 0);
    float weight = (step.x == 1 ? part.x : 1.0 - part.x) * (step.y == 1 ? part.y : 1.0 - part.y);
    t.weight[k] = t.normal[k].w < 0.0 ? 0.0 : weight;
    total += t.weight[k];
  }
  for (int k = 0; k < 4; ++k) t.weight[k] = total > 0.0 ? t.weight[k] / total : 0.0;
  return t;
}

vec3 normalAt(Texels t, int k, Point p) {
  vec3 normal = t.normal[k].xyz;
  return texelNormals && dot(normal, normal) > 0.0 ? normalize(normal) : p.vertexNormal;
}

// -1: none.
int materialAt(ivec2 at) {
  vec2 code = floor(texelFetch(materialMap, at, 0).rg * 255.0 + 0.5);
  return int(code.r) + 256 * int(code.g) - 1;
}

vec3 reflectance(ivec2 at, Geometry g) {
  int material = materialAt(at);
  if (material < 0) return vec3(0.0);
  int row = firstRow + rowsPerMaterial * material;
  vec3 sum = vec3(0.0);
  for (int first = 0; first < rowCount; first += 4) {
    vec4 weights = weighted ? texelFetch(weightMap, ivec3(at, first / 4), 0) : vec4(1.0, 0.0, 0.0, 0.0);
    for (int k = 0; k < min(4, rowCount - first); ++k) {
      if (weights[k] > 0.0) sum += weights[k] * evaluateBrdf(row + first + k, g);
    }
  }
  return sum;
}

vec3 radiance(Point p, Texels t) {
  vec3 towards = light - p.position;
  float distance2 = dot(towards, towards);
  vec3 wi = towards * inversesqrt(distance2), wo = normalize(eye - p.position), sum = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    if (t.weight[k] == 0.0) continue;
    Geometry g = geometryOf(normalAt(t, k, p), wi, wo);
    if (g.cosI <= 0.0 || g.cosO <= 0.0) continue;
    sum += t.weight[k] * g.cosI * reflectance(t.at[k], g);
  }
  if (shadows && sum != vec3(0.0) && !seesLight(p, light)) return vec3(0.0);
  return sum * intensity / distance2;
}

int nearest(Texels t) {
  int best = 0;
  for (int k = 1; k < 4; ++k) {
    if (t.weight[k] > t.weight[best]) best = k;
  }
  return best;
}

// Dark blue over green to yellow; viewer.js draws its legend from the same numbers.
vec3 heat(float x) {
  x = clamp(x, 0.0, 1.0);
  return x < 0.5 ? mix(vec3(0.23, 0.12, 0.38), vec3(0.13, 0.57, 0.55), 2.0 * x) : mix(vec3(0.13, 0.57, 0.55), vec3(0.99, 0.91, 0.14), 2.0 * x - 1.0);
}

// Blended over the texels that have the figure, but the number of samples, which is the nearest texel's; -1 where none has it.
vec4 figuresAt(Texels t) {
  vec4 sum = vec4(0.0), total = vec4(0.0), nearestOne = vec4(-1.0);
  for (int k = 0; k < 4; ++k) {
    if (t.weight[k] == 0.0) continue;
    vec4 own = texelFetch(figureMap, t.at[k], 0), weight = t.weight[k] * step(0.0, own);
    sum += weight * own;
    total += weight;
    if (k == nearest(t)) nearestOne = own;
  }
  vec4 blended = mix(vec4(-1.0), sum / max(total, 1e-6), greaterThan(total, vec4(0.0)));
  return vec4(blended.x, nearestOne.y, blended.zw);
}

vec4 pixel(Point p, Texels t) {
  if (show == kLinear) return vec4(radiance(p, t), 1.0);
  if (show == kRadiance) return vec4(srgb(exposure * radiance(p, t)), 1.0);
  int best = nearest(t);
  bool hole = t.weight[best] == 0.0;
  int material = hole ? -1 : materialAt(t.at[best]);
  if (show == kTexel) return vec4(hole ? vec2(-1.0) : vec2(t.at[best]), float(material), float(p.triangle));
  if (show == kNormals) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) sum += t.weight[k] * normalAt(t, k, p);
    return vec4(0.5 + 0.5 * normalize(hole ? p.vertexNormal : sum), 1.0);
  }
  if (show == kFigures) return figuresAt(t);
  if (hole || (show == kClusters && material < 0)) return vec4(0.25, 0.0, 0.0, 1.0);
  if (show == kClusters) return vec4(texelFetch(basisMap, ivec2(colourColumn, clusterRow + material), 0).rgb, 1.0);
  float figure = figuresAt(t)[clamp(show - kSigma, 0, 3)];
  return vec4(figure < 0.0 ? vec3(0.35) : heat(figure / figureScale), 1.0);
}

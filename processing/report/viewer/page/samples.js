// What the photographs say about a texel (viewer_samples.h): of every one that the fit used a sample, or why there is none.
const kUsed = 0;

// Pixel of a point about the mesh's centre; processing/calibration/lens/camera_model.cpp.
function pixelIn(view, point) {
  const [px, py, pz] = view.rotation.map((row, k) => row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + view.translation[k]);
  const [k1, k2, p1, p2] = view.distortion, x = px / pz, y = py / pz, r2 = x * x + y * y, radial = 1 + r2 * (k1 + r2 * k2);
  return [view.focal[0] * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + view.principal[0],
          view.focal[1] * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + view.principal[1]];
}

const minus = (a, b) => a.map((value, k) => value - b[k]);
// rad
function angleBetween(a, b) {
  const dot = a.reduce((sum, value, k) => sum + value * b[k], 0);
  return Math.acos(Math.max(-1, Math.min(1, dot / (Math.hypot(...a) * Math.hypot(...b)))));
}
// About the mesh's centre: -R^T t.
const eyeOf = ({ rotation, translation }) => [0, 1, 2].map((k) => -rotation.reduce((sum, row, r) => sum + row[k] * translation[r], 0));

class Lumitexels {
  constructor(data) {
    this.data = data;
    this.count = data.lumitexel_low.length;
    this.texels = Uint32Array.from(data.lumitexel_low, (low, i) => low + 65536 * data.lumitexel_high[i]);
    this.samples = data.reason.length;
    this.first = [];  // sample of every view
    let sample = 0;
    for (let v = 0; v < page.samples.views.length; ++v) {
      this.first.push(sample);
      for (let i = v * this.count; i < (v + 1) * this.count; ++i) sample += data.verdict[i] === kUsed ? 1 : 0;
    }
  }

  nearest(x, y) {
    let best = 0, least = Infinity;
    for (let i = 0; i < this.count; ++i) {
      const dx = this.texels[i] % page.atlas.width - x, dy = Math.floor(this.texels[i] / page.atlas.width) - y, far = dx * dx + dy * dy;
      if (far < least) { least = far; best = i; }
    }
    return { i: best, distance: Math.sqrt(least) };
  }

  position(i) {
    const { low, size } = page.box;
    return low.map((start, k) => start + size[k] * this.data.lumitexel_position[k * this.count + i] / 65535);
  }

  sampleOf(v, i) {
    let s = this.first[v];
    for (let k = v * this.count; k < v * this.count + i; ++k) s += this.data.verdict[k] === kUsed ? 1 : 0;
    const column = (name, channel = 0) => fromHalf(this.data[name][channel * this.samples + s]);
    const channels = Array.from({ length: page.channels }, (_, c) => c), sample = {};
    for (const name of ["measured", "predicted"]) sample[name] = channels.map((c) => column(name, c));
    if (page.samples.weighed) Object.assign(sample, { share: this.data.share[s] / 255, scales_off: column("scales_off") });
    const reason = this.data.reason[s];
    return { ...sample, reason: reason === 0 ? "" : page.samples.reasons[reason - 1] };
  }

  // Of the lumitexel nearest in the atlas; angles to the given normal, rad, null without one.
  at(x, y, normalAt) {
    const { i, distance } = this.nearest(x, y), texel = [this.texels[i] % page.atlas.width, Math.floor(this.texels[i] / page.atlas.width)];
    const position = this.position(i), normal = normalAt(texel), angle = (towards) => (normal ? angleBetween(normal, towards) : null);
    const looks = page.samples.views.map((view, v) => {
      const verdict = this.data.verdict[v * this.count + i], { point, vector } = view.light;
      const look = { view: view.name, verdict: page.samples.verdicts[verdict], pixel: pixelIn(view, position),
                     light: angle(point ? minus(vector, position) : vector), eye: angle(minus(eyeOf(view), position)) };
      return verdict === kUsed ? { ...look, ...this.sampleOf(v, i) } : look;
    });
    return { texel, distance, looks };
  }
}

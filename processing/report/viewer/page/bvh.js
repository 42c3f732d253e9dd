// A hierarchy of boxes over the triangles, split by the surface area heuristic in bins, laid out in depth-first order with skip links
// so that a shader walks it without a stack (surface.glsl).
const kLeafTriangles = 4, kBins = 12;

function halfArea(low, high) {
  const x = Math.max(0, high[0] - low[0]), y = Math.max(0, high[1] - low[1]), z = Math.max(0, high[2] - low[2]);
  return x * y + y * z + z * x;
}

class Box {
  constructor() { this.low = [Infinity, Infinity, Infinity]; this.high = [-Infinity, -Infinity, -Infinity]; this.count = 0; }
  add(low, high, at) {
    for (let k = 0; k < 3; ++k) {
      this.low[k] = Math.min(this.low[k], low[at + k]);
      this.high[k] = Math.max(this.high[k], high[at + k]);
    }
    ++this.count;
  }
  merge(other) {
    const count = this.count + other.count;
    if (other.count > 0) this.add(other.low, other.high, 0);
    this.count = count;
  }
  cost() { return this.count === 0 ? 0 : halfArea(this.low, this.high) * this.count; }
}

// positions: xyz by vertex; corners: three vertices a triangle. Gives order (of the triangles, leaf by leaf) and nodes (8 floats each), which hold
// the numbers of 2^21 triangles (kMostViewerTriangles in viewer_page.h).
function buildHierarchy(positions, corners) {
  const count = corners.length / 3;
  const low = new Float32Array(3 * count), high = new Float32Array(3 * count), order = new Uint32Array(count);
  for (let t = 0; t < count; ++t) {
    order[t] = t;
    for (let k = 0; k < 3; ++k) {
      const a = positions[3 * corners[3 * t] + k], b = positions[3 * corners[3 * t + 1] + k], c = positions[3 * corners[3 * t + 2] + k];
      low[3 * t + k] = Math.min(a, b, c);
      high[3 * t + k] = Math.max(a, b, c);
    }
  }
  const middle = (t, k) => 0.5 * (low[3 * t + k] + high[3 * t + k]);
  const nodes = [];

  // Splits order[first, end) in place; the number in the left part, never 0 nor all.
  function split(first, end) {
    const from = [Infinity, Infinity, Infinity], to = [-Infinity, -Infinity, -Infinity];
    for (let i = first; i < end; ++i) {
      for (let k = 0; k < 3; ++k) {
        const m = middle(order[i], k);
        from[k] = Math.min(from[k], m);
        to[k] = Math.max(to[k], m);
      }
    }
    let best = { cost: Infinity, axis: -1, bin: 0 };
    const binOf = (t, k) => Math.min(kBins - 1, Math.floor(kBins * (middle(t, k) - from[k]) / (to[k] - from[k])));
    for (let k = 0; k < 3; ++k) {
      if (!(to[k] > from[k])) continue;
      const bins = Array.from({ length: kBins }, () => new Box());
      for (let i = first; i < end; ++i) bins[binOf(order[i], k)].add(low, high, 3 * order[i]);
      const right = new Array(kBins).fill(0), after = new Box();
      for (let b = kBins - 1; b > 0; --b) { after.merge(bins[b]); right[b] = after.cost(); }
      const before = new Box();
      for (let b = 1; b < kBins; ++b) {
        before.merge(bins[b - 1]);
        const cost = before.cost() + right[b];
        if (before.count > 0 && before.count < end - first && cost < best.cost) best = { cost, axis: k, bin: b };
      }
    }
    if (best.axis < 0) return (end - first) >> 1;  // all in one place: any halves
    let left = first;
    for (let i = first; i < end; ++i) {
      if (binOf(order[i], best.axis) < best.bin) { const t = order[i]; order[i] = order[left]; order[left++] = t; }
    }
    return left - first;
  }

  function build(first, end) {
    const box = new Box(), at = nodes.length;
    for (let i = first; i < end; ++i) box.add(low, high, 3 * order[i]);
    nodes.push(...box.low, 0, ...box.high, -1);
    if (end - first <= kLeafTriangles) {
      nodes[at + 7] = 8 * first + (end - first);
    } else {
      const left = split(first, end);
      build(first, first + left);
      build(first + left, end);
    }
    nodes[at + 3] = nodes.length / 8;
  }
  if (count > 0) build(0, count);
  return { order, nodes: new Float32Array(nodes) };
}

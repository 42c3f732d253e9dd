// The sky as textures for sky.glsl.
class Sky {
  constructor(values) {
    const { width, height } = page.sky, count = width * height, radiance = new Float32Array(4 * count), light = new Float64Array(count);
    let total = 0;
    for (let i = 0; i < count; ++i) {
      const row = Math.floor(i / width), top = Math.cos(Math.PI * row / height), bottom = Math.cos(Math.PI * (row + 1) / height);
      for (let c = 0; c < 3; ++c) radiance[4 * i + c] = values[3 * i + c];
      radiance[4 * i + 3] = (values[3 * i] + values[3 * i + 1] + values[3 * i + 2]) / 3;
      light[i] = radiance[4 * i + 3] * (top - bottom) * 2 * Math.PI / width;
      total += light[i];
    }
    for (let i = 0; i < count; ++i) radiance[4 * i + 3] /= total;
    this.skyMap = nearestTexture(radiance, width, height, THREE.FloatType);
    this.aliasMap = nearestTexture(Sky.aliases(light, total), width, height, THREE.FloatType);
  }

  // Vose 1991: with equal chances an entry, which then stays with the share given, or sends to another.
  static aliases(light, total) {
    const count = light.length, table = new Float32Array(4 * count), share = light.map((value) => value * count / total), few = [], many = [];
    share.forEach((value, i) => (value < 1 ? few : many).push(i));
    while (few.length > 0 && many.length > 0) {
      const from = few.pop(), to = many[many.length - 1];
      table.set([share[from], to], 4 * from);
      share[to] -= 1 - share[from];
      if (share[to] < 1) few.push(many.pop());
    }
    for (const i of [...few, ...many]) table.set([1, i], 4 * i);
    return table;
  }
}

// The model as textures for the shaders.
const kRow = 2046;  // texels a row of the textures that hold lists; a multiple of 6 and of 2
const kNoMaterial = 65535, kHalfMinusOne = 0xbc00;

function nearestTexture(data, width, height, type) {
  const texture = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, type);
  texture.minFilter = texture.magFilter = THREE.NearestFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}

// Four floats a texel, row after row.
function listTexture(values) {
  const rows = Math.max(1, Math.ceil(values.length / (4 * kRow))), data = new Float32Array(rows * kRow * 4);
  data.set(values);
  return nearestTexture(data, kRow, rows, THREE.FloatType);
}

// Triangles in leaf order: what surface.glsl reads, and the corners that are rasterised.
function meshTextures(data) {
  const corners = new Uint32Array(data.triangles_low.length);
  for (let i = 0; i < corners.length; ++i) corners[i] = data.triangles_low[i] + 65536 * data.triangles_high[i];
  const { order, nodes } = buildHierarchy(data.positions, corners);
  const texels = new Float32Array(24 * order.length), raster = new Float32Array(9 * order.length);
  order.forEach((triangle, t) => {
    for (let k = 0; k < 3; ++k) {
      const vertex = corners[3 * triangle + k], at = 24 * t + 4 * k;
      for (let axis = 0; axis < 3; ++axis) {
        texels[at + axis] = raster[9 * t + 3 * k + axis] = data.positions[3 * vertex + axis];
        texels[at + 12 + axis] = data.normals[3 * vertex + axis];
      }
      texels[at + 3] = data.texcoords[2 * vertex];
      texels[at + 15] = data.texcoords[2 * vertex + 1];
    }
  });
  return { triangleMap: listTexture(texels), nodeMap: listTexture(nodes), nodeCount: nodes.length / 8, raster };
}

function aimOf(phi) {  // processing/brdf/lafortune_base.cpp
  const inside = Math.PI / 4 - Math.abs(phi), t = Math.tan(Math.abs(inside));
  const near = inside >= 0 ? 1 / (1 + t) : 1, other = inside >= 0 ? t / (1 + t) : 0, grazing = inside >= 0 ? 0 : 2 * t / (1 + t);
  return { mirror: phi >= 0 ? near : other, retro: phi >= 0 ? other : near, grazing };
}

const kFamilies = ["lafortune", "ggx", "ward"];
const lobeOf = (lobe, c, channels) => lobe[Math.min(c, channels - 1)];

// What of a BRDF's lobes has one shape: { own, channels }, own one of the channels' lobes.
function entriesOf(brdf) {
  const entries = [], channels = brdf.diffuse.length;
  for (const lobe of brdf.lobes) {
    const first = entries.length;
    for (let c = 0; c < 3; ++c) {
      const own = lobeOf(lobe, c, channels);
      const same = entries.slice(first).find((entry) => entry.own.log_shape === own.log_shape && entry.own.aim === own.aim);
      if (same) same.channels.push(c); else entries.push({ lobe, own, channels: [c] });
    }
  }
  return entries;
}

function writeBrdf(brdf, table, at) {
  const channels = brdf.diffuse.length, entries = entriesOf(brdf);
  for (let c = 0; c < 3; ++c) table[at + c] = lobeOf(brdf.diffuse, c, channels);
  table[at + 3] = entries.length;
  entries.forEach(({ lobe, own, channels: shared }, e) => {
    const aim = aimOf(own.aim), start = at + 4 + 8 * e;
    table.set([0, 0, 0, kFamilies.indexOf(brdf.family), Math.exp(own.log_shape), aim.mirror, aim.retro, aim.grazing], start);
    for (const c of shared) {
      const strength = lobeOf(lobe, c, channels).log_strength;
      if (strength === null) continue;
      table[start + c] = Math.exp(strength);
      table[start + 3] += 4 << c;
    }
  });
}

// One row a BRDF: the single one, then of every layer the clusters', the bases before principal functions, the final bases.
class BasisRows {
  constructor() {
    const all = [page.single, ...page.layers.flat().flatMap((m) => [m.brdf, ...m.projection_basis, ...m.basis])];
    this.columns = 2 + 2 * Math.max(...all.map((brdf) => entriesOf(brdf).length));
    this.families = kFamilies.filter((family) => all.some((brdf) => brdf.family === family && brdf.lobes.length > 0));
    this.table = [];
    this.single = this.add([[page.single]], 1);
  }

  // The lists one below the other, all as long as the longest; rows that no BRDF fills are 0. Gives what a stage needs to find them.
  add(lists, rowsPerMaterial = Math.max(0, ...lists.map((list) => list.length))) {
    const firstRow = this.table.length;
    for (const list of lists) {
      for (let k = 0; k < rowsPerMaterial; ++k) {
        const row = new Float32Array(4 * this.columns);
        if (k < list.length) writeBrdf(list[k], row, 0);
        this.table.push(row);
      }
    }
    return { firstRow, rowsPerMaterial, rowCount: rowsPerMaterial };
  }

  addLayer(materials) {
    const cluster = this.add(materials.map((m) => [m.brdf]), 1);
    materials.forEach((material, m) => this.table[cluster.firstRow + m].set(material.colour, 4 * (this.columns - 1)));
    return { cluster, projection: this.add(materials.map((m) => m.projection_basis)), basis: this.add(materials.map((m) => m.basis)) };
  }

  texture() {
    const values = new Float32Array(4 * this.columns * this.table.length);
    this.table.forEach((row, r) => values.set(row, 4 * this.columns * r));
    return nearestTexture(values, this.columns, this.table.length, THREE.FloatType);
  }
}

// By stage the values of the shader's uniforms; weights and materials: names of the atlas's textures.
function basisTexture() {
  const rows = new BasisRows(), layers = page.layers.map((materials) => rows.addLayer(materials)), stages = {};
  for (const { name, layer, functions, texel_normals } of page.stages) {
    const weights = { projection: "projection_weights_", basis: "weights_" }[functions];
    const found = functions === "single" ? { ...rows.single, rowsPerMaterial: 0 } : layers[layer][functions];
    stages[name] = { ...found, clusterRow: layers[layer].cluster.firstRow, weights: weights ? weights + layer : null, materials: "material_" + layer, texelNormals: texel_normals };
  }
  return { basisMap: rows.texture(), stages, colourColumn: rows.columns - 1, families: rows.families };
}

// Half floats as they come, one plane a basis BRDF, four planes a layer.
function weightTexture(planes, texels) {
  const { width, height } = page.atlas, size = width * height, count = planes.length / texels.length, layers = Math.max(1, Math.ceil(count / 4));
  const data = new Uint16Array(4 * size * layers);
  for (let k = 0; k < count; ++k) {
    const start = 4 * size * (k >> 2) + (k & 3);
    for (let i = 0; i < texels.length; ++i) data[start + 4 * texels[i]] = planes[k * texels.length + i];
  }
  const texture = new THREE.DataTexture2DArray(data, width, height, layers);
  texture.format = THREE.RGBAFormat;
  texture.type = THREE.HalfFloatType;
  texture.minFilter = texture.magFilter = THREE.NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

// One more than the material in the two lower bytes; 0: none.
function materialTexture(materials, texels) {
  const bytes = new Uint8Array(4 * page.atlas.width * page.atlas.height);
  texels.forEach((texel, i) => {
    const code = materials[i] === kNoMaterial ? 0 : materials[i] + 1;
    bytes.set([code & 255, code >> 8], 4 * texel);
  });
  return nearestTexture(bytes, page.atlas.width, page.atlas.height, THREE.UnsignedByteType);
}

function atlasTextures(data) {
  const { width, height } = page.atlas, size = width * height, texels = [], indexOf = new Int32Array(size).fill(-1);
  const normals = new Float32Array(4 * size), figures = new Uint16Array(4 * size);
  for (let i = 0; i < size; ++i) {
    normals[4 * i + 3] = data.textured[i] - 1;
    if (data.textured[i] === 0) continue;
    indexOf[i] = texels.length;
    texels.push(i);
  }
  texels.forEach((texel, i) => {
    fromOctahedral(data.texel_normals[i], data.texel_normals[texels.length + i], normals, 4 * texel);
    figures[4 * texel] = data.sigma[i];
    figures[4 * texel + 1] = data.samples[i];
    figures[4 * texel + 2] = data.residual ? data.residual[i] : kHalfMinusOne;
    figures[4 * texel + 3] = data.normal_sigma ? data.normal_sigma[i] : kHalfMinusOne;
  });
  const textures = { normalMap: nearestTexture(normals, width, height, THREE.FloatType), figureMap: nearestTexture(figures, width, height, THREE.HalfFloatType) };
  page.layers.forEach((materials, layer) => {
    textures["material_" + layer] = materialTexture(data["material_" + layer], texels);
    for (const name of ["weights_" + layer, "projection_weights_" + layer]) textures[name] = weightTexture(data[name], texels);
  });
  return { textures, indexOf, texels };
}

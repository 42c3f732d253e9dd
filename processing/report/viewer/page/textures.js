// The model as textures for the shaders.
const kRow = 2046;  // texels a row of the textures that hold lists; a multiple of 6 and of 2

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

function writeBrdf(brdf, table, at) {
  const family = ["lafortune", "ggx", "ward"].indexOf(brdf.family), last = brdf.diffuse.length - 1;
  for (let c = 0; c < 3; ++c) table[at + c] = brdf.diffuse[Math.min(c, last)];
  table[at + 3] = brdf.lobes.length;
  brdf.lobes.forEach((lobe, l) => {
    for (let c = 0; c < 3; ++c) {
      const own = lobe[Math.min(c, last)], before = c > 0 ? lobe[Math.min(c - 1, last)] : null, aim = aimOf(own.aim);
      const off = own.log_strength === null, same = before !== null && before.log_shape === own.log_shape && before.aim === own.aim;
      table.set([off ? 0 : Math.exp(own.log_strength), Math.exp(own.log_shape), aim.mirror, aim.retro,
                 aim.grazing, family, same ? 1 : 0, off ? 1 : 0], at + 4 + 8 * (3 * l + c));
    }
  });
}

// One row a BRDF: the single one, the clusters', the bases before principal functions, the final bases.
function basisTexture() {
  const before = Math.max(0, ...page.materials.map((m) => m.projection_basis.length)), final = Math.max(...page.materials.map((m) => m.basis.length));
  const count = page.materials.length, all = [page.single, ...page.materials.flatMap((m) => [m.brdf, ...m.projection_basis, ...m.basis])];
  const columns = 2 + 6 * Math.max(...all.map((b) => b.lobes.length)), rows = 1 + count * (1 + before + final);
  const table = new Float32Array(4 * columns * rows), row = (r) => 4 * columns * r;
  writeBrdf(page.single, table, 0);
  page.materials.forEach((material, m) => {
    writeBrdf(material.brdf, table, row(1 + m));
    table.set(material.colour, row(1 + m) + 4 * (columns - 1));
    material.projection_basis.forEach((brdf, k) => writeBrdf(brdf, table, row(1 + count + m * before + k)));
    material.basis.forEach((brdf, k) => writeBrdf(brdf, table, row(1 + count + count * before + m * final + k)));
  });
  const stages = {
    single: { firstRow: 0, rowsPerMaterial: 0, rowCount: 1, weights: null },
    cluster: { firstRow: 1, rowsPerMaterial: 1, rowCount: 1, weights: null },
    pfa: { firstRow: 1 + count + count * before, rowsPerMaterial: final, rowCount: final, weights: "weights" },
  };
  if (before > 0) stages.projection = { firstRow: 1 + count, rowsPerMaterial: before, rowCount: before, weights: "projection_weights" };
  return { basisMap: nearestTexture(table, columns, rows, THREE.FloatType), stages, colourColumn: columns - 1 };
}

// Half floats as they come, one plane a basis BRDF, four planes a layer.
function weightTexture(planes, texels) {
  const { width, height } = page.atlas, size = width * height, count = planes.length / texels.length, layers = Math.ceil(count / 4);
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

function atlasTextures(data) {
  const { width, height } = page.atlas, size = width * height, texels = [], indexOf = new Int32Array(size).fill(-1);
  const normals = new Float32Array(4 * size), figures = new Uint16Array(4 * size);
  for (let i = 0; i < size; ++i) {
    normals[4 * i + 3] = data.material[i] === 65535 ? -1 : data.material[i];
    if (data.material[i] === 65535) continue;
    indexOf[i] = texels.length;
    texels.push(i);
  }
  texels.forEach((texel, i) => {
    fromOctahedral(data.texel_normals[i], data.texel_normals[texels.length + i], normals, 4 * texel);
    figures[4 * texel] = data.sigma[i];
    figures[4 * texel + 1] = data.samples[i];
    figures[4 * texel + 2] = data.residual ? data.residual[i] : 0;
  });
  const textures = {
    normalMap: nearestTexture(normals, width, height, THREE.FloatType),
    figureMap: nearestTexture(figures, width, height, THREE.HalfFloatType),
    weights: weightTexture(data.weights, texels),
  };
  if (data.projection_weights) textures.projection_weights = weightTexture(data.projection_weights, texels);
  return { textures, indexOf, texels };
}

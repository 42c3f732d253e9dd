// What the model holds at one texel, as tables.
const tableRow = (name, ...values) => "<tr><td>" + name + "</td>" + values.map((v) => "<td>" + v + "</td>").join("") + "</tr>";

function brdfRows(brdf) {
  let rows = tableRow("diffuse, 1/sr", ...brdf.diffuse.map((v) => rounded(v, 3)));
  const strength = { lafortune: "peak, 1/sr", ggx: "F0", ward: "rho" }[brdf.family], shape = { lafortune: "exponent", ggx: "alpha", ward: "alpha" }[brdf.family];
  brdf.lobes.forEach((lobe, l) => {
    const mark = brdf.lobes.length > 1 ? " " + (l + 1) : "";
    rows += tableRow(strength + mark, ...lobe.map((c) => (c.log_strength === null ? "off" : rounded(Math.exp(c.log_strength), 3))));
    rows += tableRow(shape + mark, ...lobe.map((c) => rounded(Math.exp(c.log_shape), 3)));
    if (brdf.family === "lafortune") rows += tableRow("aim, degrees" + mark, ...lobe.map((c) => rounded(c.aim * 180 / Math.PI, 3)));
  });
  return rows;
}

function weightRows(data, name, i, count) {
  if (!data[name]) return "";
  const texels = data.sigma.length, values = [];
  for (let k = 0; k < count; ++k) values.push(fromHalf(data[name][k * texels + i]));
  return values.map((value, k) => (value > 0 ? tableRow((name === "weights" ? "weight " : "before PFA ") + k, rounded(value, 4)) : "")).join("");
}

function texelTable(renderer, x, y) {
  const data = renderer.data, texel = y * page.atlas.width + x, i = renderer.atlas.indexOf[texel], m = data.material[texel], material = page.materials[m];
  const normal = [0, 0, 0];
  fromOctahedral(data.texel_normals[i], data.texel_normals[data.sigma.length + i], normal, 0);
  let rows = tableRow("texel", x + ", " + y) + tableRow("material", `<span class="swatch" style="background:${css(material.colour)}"></span>${m}`);
  rows += tableRow("normal", normal.map((v) => rounded(v, 4)).join(", "));
  rows += tableRow("sigma, relative", rounded(fromHalf(data.sigma[i]), 3));
  const samples = fromHalf(data.samples[i]);
  rows += tableRow("samples", samples === 0 ? "0 (filled in)" : samples);
  if (data.residual) rows += tableRow("residual, 1/sr", rounded(fromHalf(data.residual[i]), 3));
  rows += weightRows(data, "projection_weights", i, material.projection_basis.length) + weightRows(data, "weights", i, material.basis.length);
  return `<table>${rows}</table><p class="hint">BRDF of material ${m} (${material.brdf.family})</p><table>${brdfRows(material.brdf)}</table>`;
}

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

function weightRows(planes, text, i, count, texels) {
  const values = [];
  for (let k = 0; k < count; ++k) values.push(fromHalf(planes[k * texels + i]));
  return values.map((value, k) => (value > 0 ? tableRow(text + " " + k, rounded(value, 4)) : "")).join("");
}

// Of the layer that a stage draws with.
function materialRows(data, i, { layer }) {
  const m = data["material_" + layer][i], texels = data.sigma.length;
  if (m === kNoMaterial) return { rows: tableRow("material", "none at this stage"), brdf: "" };
  const material = page.layers[layer][m];
  let rows = tableRow("material", `<span class="swatch" style="background:${css(material.colour)}"></span>${m}`);
  rows += weightRows(data["projection_weights_" + layer], "before PFA", i, material.projection_basis.length, texels);
  rows += weightRows(data["weights_" + layer], "weight", i, material.basis.length, texels);
  return { rows, brdf: `<p class="hint">BRDF of material ${m} (${material.brdf.family})</p><table>${brdfRows(material.brdf)}</table>` };
}

function texelTable(renderer, x, y, stage) {
  const data = renderer.data, i = renderer.atlas.indexOf[y * page.atlas.width + x], normal = renderer.normalOf([x, y]);
  let rows = tableRow("texel", x + ", " + y);
  rows += tableRow("normal", normal === null ? "of the mesh" : normal.map((v) => rounded(v, 4)).join(", "));
  rows += tableRow("sigma, relative", rounded(fromHalf(data.sigma[i]), 3));
  const samples = fromHalf(data.samples[i]), material = materialRows(data, i, stage);
  rows += tableRow("samples", samples === 0 ? "0 (filled in)" : samples);
  if (data.normal_sigma) rows += tableRow("normal's sigma, deg", rounded(fromHalf(data.normal_sigma[i]) * 180 / Math.PI, 3));
  if (data.indirect && page.indirect_bounces !== 0) rows += tableRow("light between surfaces", rounded(100 * fromHalf(data.indirect[i]), 2) + " %");
  if (data.residual && samples > 0) rows += tableRow("residual, 1/sr rms", rounded(fromHalf(data.residual[i]), 3));
  return `<table>${rows}${material.rows}</table>${material.brdf}`;
}

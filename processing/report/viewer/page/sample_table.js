// A lumitexel's samples as a table, and what has none.
const escaped = (text) => text.replace(/[&<>"]/g, (letter) => "&#" + letter.charCodeAt(0) + ";");
const degrees = (rad) => (rad === null ? "" : Math.round(rad * 180 / Math.PI));
const values = (list) => list.map((v) => `<td>${rounded(v, 3)}</td>`).join("");

function rmsOf({ measured, predicted }) {
  return Math.sqrt(measured.reduce((sum, value, c) => sum + (value - predicted[c]) ** 2, 0) / measured.length);
}

function place({ view, pixel, light, eye }) {
  return `<td>${escaped(view)}</td><td>${pixel.map((p) => p.toFixed(1)).join(", ")}</td><td>${degrees(light)}</td><td>${degrees(eye)}</td>`;
}

function usedRow(look) {
  const weighed = page.samples.weighed ? `<td>${rounded(look.scales_off, 2)}</td><td>${Math.round(100 * look.share)} %</td>` : "";
  const outlier = look.reason !== "" || look.scales_off > page.samples.outlier_scales;
  return `<tr${outlier ? ' class="outlier"' : ""}>${place(look)}${values(look.measured)}${values(look.predicted)}<td>${rounded(rmsOf(look), 3)}</td>${weighed}<td>${look.reason}</td></tr>`;
}

function rejectedRows(looks) {
  const columns = 2 * page.channels + 2 + (page.samples.weighed ? 2 : 0);
  return looks.map((look) => `<tr class="rejected">${place(look)}<td colspan="${columns}">${look.verdict}</td></tr>`).join("");
}

// Those that say no more than where the camera stood: one line for all of them.
function unseenLine(looks, verdict) {
  const names = looks.filter((look) => look.verdict === verdict).map((look) => escaped(look.view));
  return names.length === 0 ? "" : `<p class="hint">${verdict} (${names.length}): ${names.join(", ")}</p>`;
}

function sampleHead() {
  const names = page.channels === 3 ? ["R", "G", "B"] : Array.from({ length: page.channels }, (_, c) => c), colour = names.map((n) => `<th>${n}</th>`).join("");
  const weighed = page.samples.weighed ? "<th>scales</th><th>weight</th>" : "";
  return `<tr><th></th><th>pixel</th><th>light</th><th>view</th><th colspan="${page.channels}">measured, 1/sr</th><th colspan="${page.channels}">predicted</th><th>residual</th>${weighed}<th></th></tr>` +
    `<tr><th>photograph</th><th>x, y</th><th>deg</th><th>deg</th>${colour}${colour}<th>rms</th>${weighed ? "<th></th><th></th>" : ""}<th>outlier</th></tr>`;
}

function sampleTable({ texel, distance, looks }) {
  const [outside, hidden, used] = [page.samples.verdicts[1], page.samples.verdicts[2], page.samples.verdicts[kUsed]];
  const taken = looks.filter((look) => look.verdict === used), rejected = looks.filter((look) => ![outside, hidden, used].includes(look.verdict));
  const away = distance < 0.5 ? "" : ` (the nearest that the page holds, ${rounded(distance, 2)} atlas texels from the click)`;
  const thinned = page.samples.every > 1 ? `To keep this page small it holds one of ${page.samples.every} lumitexels. ` : "";
  const indirect = page.indirect_bounces === 0 ? "" : "Measured and predicted hold the light that comes by way of the object's other surfaces, as the model sends it; the fit saw samples without it. ";
  const weights = page.samples.weighed
    ? "Scales: residual over the error model's. Weight: share in the least squares for the texel's weights. "
    : "This model was fitted by an earlier version, which did not keep the errors that it estimated, so weights are not known here: fit again to see them. ";
  return `<h2>Lumitexel at ${texel.join(", ")}${away}: ${taken.length} samples of ${looks.length} photographs</h2>` +
    `<table>${sampleHead()}${taken.map(usedRow).join("")}${rejectedRows(rejected)}</table>${unseenLine(looks, hidden)}${unseenLine(looks, outside)}` +
    `<p class="hint">Reflectance is f cos. Predicted by all that the model holds, angles to its normals. ${indirect}${weights}${thinned}</p>`;
}

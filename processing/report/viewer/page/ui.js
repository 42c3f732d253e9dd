// What the mouse and the panel do.
const kFovY = 0.5;  // rad; as framing_view
const element = (id) => document.getElementById(id);
const rounded = (value, digits = 4) => Number(value.toPrecision(digits)).toString();
const css = (rgb) => "rgb(" + rgb.map((x) => Math.round(255 * x)).join(",") + ")";

const kSkyPasses = 1024;  // then the noise is below what the screen shows
const kSkyTime_ms = 20;   // a picture

// What is drawn in colours of a scale, and its unit.
const kFigureUnits = { sigma: "relative, one sigma", samples: "samples a texel", residual: "1/sr, rms of the samples", normal_sigma: "degrees, one sigma" };

// A direction by its angles about z: turn and height, rad.
const direction = ({ turn, height }) =>
  new THREE.Vector3(Math.cos(height) * Math.cos(turn), Math.cos(height) * Math.sin(turn), Math.sin(height));

class Viewer {
  constructor(renderer, canvas) {
    Object.assign(this, { renderer, canvas, target: new THREE.Vector3(), moving: false, slow: 1, asked: false });
    this.distance = 1.05 * 0.5 * page.diagonal_m / Math.sin(0.5 * kFovY);
    this.view = { turn: -1.19, height: 0.43 };
    this.lightTurn = { turn: -0.35, height: 0.45 };  // beside the view where the light goes with it
    this.fillPanel();
    this.listen();
    this.resize();
  }

  fillPanel() {
    const shows = { radiance: "radiance", normals: "normals", clusters: "clusters", samples: "number of samples", residual: "residual", sigma: "uncertainty", normal_sigma: "normal's uncertainty" };
    const names = { single: "one BRDF for all", cluster: "clusters", projection: "mixed BRDFs", pfa: "principal functions", normal: "fitted normals" };
    const held = page.stages.filter((stage) => stage.held);
    for (const [value, text] of Object.entries(shows)) {
      if (!kFigureUnits[value] || page.chunks[value]) element("show").add(new Option(text, value));
    }
    for (const { name } of held) element("stage").add(new Option(names[name], name, false, name === held[held.length - 1].name));
    if (this.renderer.data.texel_normals.every((code) => code === 65535)) element("normals").disabled = true;
    const { data } = this.renderer;
    this.scales = {};
    for (const name of Object.keys(kFigureUnits).filter((figure) => page.chunks[figure])) {
      // Texels that were filled in would fill the scale with what nothing is known about.
      const sorted = Float32Array.from(data[name].filter((_, i) => data.samples[i] > 0), fromHalf).sort();
      this.scales[name] = sorted[Math.floor(0.98 * (sorted.length - 1))] || 1;
    }
  }

  listen() {
    for (const id of ["show", "stage", "normals", "light", "shadows", "follow", "exposure", "distance"]) {
      element(id).addEventListener("input", () => { if (id === "follow") this.keepLight(); this.changed = this.changed || id !== "exposure"; this.ask(); });
    }
    addEventListener("resize", () => this.resize());
    this.canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.distance *= Math.exp(0.001 * event.deltaY);
      this.move();
    }, { passive: false });
    this.canvas.addEventListener("pointerdown", (event) => this.press(event));
  }

  press(event) {
    const light = event.button === 2 || event.shiftKey, start = [event.clientX, event.clientY];
    let last = start, dragged = false;
    this.canvas.setPointerCapture(event.pointerId);
    const drag = (at) => {
      dragged = dragged || Math.hypot(at.clientX - start[0], at.clientY - start[1]) > 3;
      if (!dragged) return;
      const angles = light ? this.lightTurn : this.view, sign = light ? 1 : -1;
      angles.turn += sign * 0.008 * (at.clientX - last[0]);
      angles.height = Math.max(-1.55, Math.min(1.55, angles.height - sign * 0.008 * (at.clientY - last[1])));
      last = [at.clientX, at.clientY];
      this.move();
    };
    const release = (at) => {
      this.canvas.removeEventListener("pointermove", drag);
      this.canvas.removeEventListener("pointerup", release);
      if (!dragged && !light) this.pick(at.offsetX, at.offsetY);
    };
    this.canvas.addEventListener("pointermove", drag);
    this.canvas.addEventListener("pointerup", release);
  }

  stage() { return page.stages.find((stage) => stage.name === element("stage").value); }

  // Switching between a light that goes with the camera and one that stays leaves it where it is.
  keepLight() {
    const sign = element("follow").checked ? -1 : 1;
    this.lightTurn.turn += sign * this.view.turn;
    this.lightTurn.height += sign * this.view.height;
  }

  lightAngles() {
    if (!element("follow").checked) return this.lightTurn;
    return { turn: this.view.turn + this.lightTurn.turn, height: this.view.height + this.lightTurn.height };
  }

  // While something moves, fewer pixels where all of them took too long; all of them 0.2 s after.
  move() {
    this.moving = this.changed = true;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => { this.moving = false; this.resize(); }, 200);
    this.ask();
  }

  resize() {
    const scale = (this.moving ? 1 / this.slow : 1) * Math.min(devicePixelRatio, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale)), height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (width !== this.renderer.width || height !== this.renderer.height) this.renderer.setSize(width, height);
    this.ask();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => { this.asked = false; this.draw(); });
  }

  settle() {
    const u = this.renderer.uniforms, show = element("show").value, lightDistance = Number(element("distance").value) * page.diagonal_m;
    this.renderer.setCamera({ eye: direction(this.view).multiplyScalar(this.distance), target: this.target, up: new THREE.Vector3(0, 0, 1), fovY: kFovY });
    this.renderer.setStage(element("stage").value);
    u.light.value.copy(direction(this.lightAngles()).multiplyScalar(lightDistance));
    u.intensity.value.setScalar(Math.PI * lightDistance * lightDistance);  // a white diffuse surface in the middle has radiance 1
    u.exposure.value = 2 ** Number(element("exposure").value);
    u.skyTurn.value = this.lightAngles().turn;  // the sky's x axis stands over where the lamp would be
    u.shadows.value = element("shadows").checked;
    if (element("normals").value !== "stage") u.texelNormals.value = element("normals").value === "fitted";
    u.figureScale.value = this.scales[show] || 1;
    element("exposure-text").value = (Number(element("exposure").value) >= 0 ? "+" : "") + element("exposure").value + " stops";
    element("lamp-distance").hidden = element("light").value === "sky";
    element("distance-text").value = rounded(lightDistance, 3) + " m";
  }

  draw() {
    this.resizeForMotion();
    const begin = performance.now();
    this.settle();
    const sky = element("light").value === "sky" && element("show").value === "radiance";
    if (sky) this.drawSky(); else this.renderer.draw(element("show").value);
    this.renderer.finish();
    this.frame_ms = performance.now() - begin;
    element("speed").textContent = rounded(this.frame_ms, 3) + " ms for " + this.renderer.width + " x " + this.renderer.height + " pixels" +
      (sky ? ", " + this.renderer.passes + " of " + kSkyPasses + " samples a pixel" : "");
    this.legend(element("show").value);
  }

  // At least one more sample a pixel every time, as many as there is time for; all anew where something has changed.
  drawSky() {
    if (this.changed) this.renderer.passes = 0;
    this.changed = false;
    const begin = performance.now();
    while (this.renderer.passes < kSkyPasses) {
      this.renderer.addPass();
      this.renderer.finish();
      if (performance.now() - begin >= kSkyTime_ms) break;
    }
    this.renderer.drawMean(this.renderer.uniforms.exposure.value);
    if (this.renderer.passes < kSkyPasses) this.ask();
  }

  resizeForMotion() {
    if (!this.moving) return;
    const wanted_ms = 33;
    if (this.frame_ms > 1.2 * wanted_ms && this.slow < 4) this.slow *= Math.SQRT2;
    if (this.frame_ms < 0.4 * wanted_ms && this.slow > 1) this.slow = Math.max(1, this.slow / Math.SQRT2);
    this.resize();
    this.asked = false;
  }

  legend(show) {
    if (show === "clusters") {
      element("legend").innerHTML = page.layers[this.stage().layer].map((m, i) => `<div><span class="swatch" style="background:${css(m.colour)}"></span>material ${i}</div>`).join("");
    } else if (this.scales[show]) {
      element("legend").innerHTML = '<div class="bar" style="background:linear-gradient(90deg,rgb(59,31,97),rgb(33,145,140),rgb(252,232,36))"></div>' +
        `<div class="ends"><span>0</span><span>${kFigureUnits[show]}</span><span>${rounded(this.scales[show] * (show === "normal_sigma" ? 180 / Math.PI : 1), 3)}</span></div>` +
        (show === "residual" ? '<div><span class="swatch" style="background:rgb(89,89,89)"></span>no samples</div>' : "");
    } else {
      element("legend").innerHTML = "";
    }
  }

  pick(x, y) {
    this.moving = false;
    this.resize();
    this.settle();
    const scale = this.renderer.width / this.canvas.clientWidth;
    const column = Math.floor(x * scale), row = this.renderer.height - 1 - Math.floor(y * scale);
    const [texelX, texelY] = this.renderer.read("texel", column, row, 1, 1);
    element("texel").innerHTML = texelX < 0 ? "" : texelTable(this.renderer, texelX, texelY, this.stage());
    element("samples").hidden = texelX < 0 || !page.samples;
    if (!element("samples").hidden) element("samples").innerHTML = sampleTable(this.renderer.lumitexels.at(texelX, texelY, (texel) => this.renderer.normalOf(texel)));
    this.ask();
  }
}

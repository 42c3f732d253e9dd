// Draws the model: first the number of the nearest triangle of every pixel (rasterised), then every pixel's value (shade.glsl).
const kShow = { radiance: 0, normals: 1, clusters: 2, sigma: 3, samples: 4, residual: 5, normal_sigma: 6, texel: 7, linear: 8, figures: 9, sky: 10 };

// How radiance becomes a colour.
const kToneShader = `const vec3 kBackground = vec3(0.0052, 0.006, 0.0071);
  vec3 srgb(vec3 linear) {
    vec3 x = clamp(linear, 0.0, 1.0);
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
  }`;

// Of van der Corput: 1, 2, 3, … evenly into (0, 1).
function radicalInverse(index, base) {
  let sum = 0;
  for (let digit = 1 / base; index > 0; index = Math.floor(index / base), digit /= base) sum += digit * (index % base);
  return sum;
}

class Renderer {
  constructor(canvas, data) {
    const context = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (context === null) throw new Error("this browser has no WebGL 2");
    this.gl = new THREE.WebGLRenderer({ canvas, context });
    this.gl.extensions.get("EXT_color_buffer_float");
    this.gl.autoClear = false;
    this.data = data;
    this.camera = new THREE.PerspectiveCamera();
    this.numbers = this.target(THREE.UnsignedByteType);
    this.mesh = meshTextures(data);
    this.basis = basisTexture();
    this.atlas = atlasTextures(data);
    this.sky = new Sky(data.sky);
    this.sums = [this.target(THREE.FloatType), this.target(THREE.FloatType)];
    this.passes = 0;
    this.lumitexels = page.samples ? new Lumitexels(data) : null;
    this.triangles = this.triangleScene();
    this.screen = this.screenScene();
    this.background = this.backgroundScene();
    this.mean = this.meanScene();
    this.setSize(1, 1);
  }

  target(type) {
    const options = { type, format: THREE.RGBAFormat, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
    return new THREE.WebGLRenderTarget(1, 1, { ...options, stencilBuffer: false });
  }

  scene(geometry, material) {
    const scene = new THREE.Scene(), mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    scene.add(mesh);
    return scene;
  }

  triangleScene() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.mesh.raster, 3));
    const vertexShader = `flat varying vec3 code;
      void main() {
        int n = gl_VertexID / 3 + 1;
        code = vec3(ivec3(n & 255, (n >> 8) & 255, n >> 16)) / 255.0;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`;
    const fragmentShader = "flat varying vec3 code; void main() { gl_FragColor = vec4(code, 1.0); }";
    return this.scene(geometry, new THREE.ShaderMaterial({ vertexShader, fragmentShader, side: THREE.DoubleSide, blending: THREE.NoBlending }));
  }

  screenScene() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]), 3));
    const { triangleMap, nodeMap, nodeCount } = this.mesh, { basisMap, colourColumn } = this.basis, { normalMap, figureMap } = this.atlas.textures;
    const values = {
      triangleMap, nodeMap, nodeCount, basisMap, colourColumn, normalMap, figureMap, weightMap: null, materialMap: null, triangleNumberMap: this.numbers.texture,
      extent: new THREE.Vector4(-1, -1, 1, 1), surfaceOffset: 1e-5 * page.diagonal_m, atlasSize: new THREE.Vector2(page.atlas.width, page.atlas.height), clusterRow: 0,
      firstRow: 0, rowsPerMaterial: 0, rowCount: 0, weighted: false, texelNormals: true, shadows: true, exposure: 1, figureScale: 1,
      skyMap: this.sky.skyMap, aliasMap: this.sky.aliasMap, skySize: [page.sky.width, page.sky.height], skyTurn: 0, sumMap: null, pass: 0, jitter: new THREE.Vector2(),
      eye: new THREE.Vector3(), rightward: new THREE.Vector3(), upward: new THREE.Vector3(), forward: new THREE.Vector3(),
      pictureSize: new THREE.Vector2(), focal: 1, light: new THREE.Vector3(), intensity: new THREE.Vector3(),
    };
    this.uniforms = {};
    for (const [name, value] of Object.entries(values)) this.uniforms[name] = { value };
    this.materials = {};
    return this.scene(geometry, this.materialFor("radiance"));
  }

  // The program that draws one of kShow, made when it is first asked for.
  materialFor(show) {
    if (!this.materials[show]) {
      const defines = { SHOW: kShow[show] }, sky = show === "sky" ? shaders["sky.glsl"] : "";
      for (const family of kFamilies) defines["HAS_" + family.toUpperCase()] = this.basis.families.includes(family) ? 1 : 0;
      const vertexShader = "uniform vec4 extent; void main() { gl_Position = vec4(mix(extent.xy, extent.zw, position.xy), 0.0, 1.0); }";
      const fragmentShader = "precision highp sampler2DArray;\n" + kToneShader + shaders["brdf.glsl"] + shaders["surface.glsl"] + shaders["shade.glsl"] + sky + shaders["pixel.glsl"];
      this.materials[show] = new THREE.ShaderMaterial({ defines, vertexShader, fragmentShader, uniforms: this.uniforms, depthTest: false, depthWrite: false, blending: THREE.NoBlending });
    }
    return this.materials[show];
  }

  // What lies around the object.
  backgroundScene() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const vertexShader = "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }";
    const fragmentShader = `${kToneShader}
      uniform bool coloured;
      uniform vec4 plain;
      void main() { gl_FragColor = coloured ? vec4(srgb(kBackground), 1.0) : plain; }`;
    this.backgroundUniforms = { coloured: { value: true }, plain: { value: new THREE.Vector4() } };
    return this.scene(geometry, new THREE.ShaderMaterial({ vertexShader, fragmentShader, uniforms: this.backgroundUniforms, depthTest: false, depthWrite: false, blending: THREE.NoBlending }));
  }

  // The part of the screen that the mesh's box fills, in [-1, 1], with two pixels to spare; all of it with the box around the camera.
  setExtent() {
    const { low, size } = page.box, from = [1, 1], to = [-1, -1];
    for (let corner = 0; corner < 8; ++corner) {
      const at = new THREE.Vector3(...low.map((start, k) => start + size[k] * (corner >> k & 1)));
      const inView = at.clone().applyMatrix4(this.camera.matrixWorldInverse);
      if (inView.z > -this.camera.near) return this.uniforms.extent.value.set(-1, -1, 1, 1);
      at.project(this.camera);
      [at.x, at.y].forEach((value, k) => { from[k] = Math.min(from[k], value); to[k] = Math.max(to[k], value); });
    }
    const spare = [4 / this.width, 4 / this.height], inside = (value) => Math.max(-1, Math.min(1, value));
    return this.uniforms.extent.value.set(...from.map((value, k) => inside(value - spare[k])), ...to.map((value, k) => inside(value + spare[k])));
  }

  // The mean of the passes so far, as drawn on the screen.
  meanScene() {
    this.meanUniforms = { sumMap: { value: null }, passes: { value: 1 }, exposure: { value: 1 } };
    const vertexShader = "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }";
    const fragmentShader = `uniform highp sampler2D sumMap;
      uniform float passes, exposure;
      ${kToneShader}
      void main() {
        vec4 mean = texelFetch(sumMap, ivec2(gl_FragCoord.xy), 0) / passes;
        gl_FragColor = vec4(srgb(exposure * mean.rgb + (1.0 - mean.a) * kBackground), 1.0);
      }`;
    return this.scene(this.background.children[0].geometry, new THREE.ShaderMaterial({ vertexShader, fragmentShader, uniforms: this.meanUniforms, depthTest: false, depthWrite: false, blending: THREE.NoBlending }));
  }

  setSize(width, height) {
    this.width = width;
    this.height = height;
    this.gl.setSize(width, height, false);
    for (const target of [this.numbers, ...this.sums]) target.setSize(width, height);
    this.passes = 0;
    this.uniforms.pictureSize.value.set(width, height);
  }

  // eye, target, up: about the mesh's centre, m; fovY: rad.
  setCamera({ eye, target, up, fovY }) {
    const u = this.uniforms, forward = target.clone().sub(eye).normalize(), reach = 0.6 * page.diagonal_m;
    const right = forward.clone().cross(up).normalize();
    u.eye.value.copy(eye);
    u.forward.value.copy(forward);
    u.rightward.value.copy(right);
    u.upward.value.copy(right).cross(forward);
    u.focal.value = 0.5 * this.height / Math.tan(0.5 * fovY);
    const far = eye.length() + reach;
    Object.assign(this.camera, { fov: fovY * 180 / Math.PI, aspect: this.width / this.height, near: Math.max(eye.length() - reach, 1e-3 * far), far });
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(eye);
    this.camera.up.copy(up);
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
    this.setExtent();
  }

  // A stage of page.stages; its own normals with it.
  setStage(name) {
    const { weights, materials, ...values } = this.basis.stages[name], u = this.uniforms;
    for (const [key, value] of Object.entries(values)) u[key].value = value;
    u.weighted.value = weights !== null;
    u.weightMap.value = this.atlas.textures[weights || "weights_0"];
    u.materialMap.value = this.atlas.textures[materials];
  }

  // Of the texel; null where the mesh's serve.
  normalOf([x, y]) {
    const i = this.atlas.indexOf[y * page.atlas.width + x], normal = [0, 0, 0], codes = this.data.texel_normals;
    if (i >= 0) fromOctahedral(codes[i], codes[this.data.sigma.length + i], normal, 0);
    return normal.every((value) => value === 0) ? null : normal;
  }

  draw(show, target = null) {
    this.screen.children[0].material = this.materialFor(show);
    this.gl.setRenderTarget(this.numbers);
    this.gl.setClearColor(0x000000, 0);
    this.gl.clear();
    this.gl.render(this.triangles, this.camera);
    const plain = { texel: [-1, -1, -1, 0], linear: [-1, -1, -1, 0], figures: [-1, -1, -1, 0], sky: [0, 0, 0, 0] }[show];
    this.backgroundUniforms.coloured.value = !plain;
    if (plain) this.backgroundUniforms.plain.value.set(...plain);
    this.gl.setRenderTarget(target);
    this.gl.render(this.background, this.camera);
    this.gl.render(this.screen, this.camera);
    this.gl.setRenderTarget(null);
  }

  // One more sample of the sky's light in every pixel. Whoever changes what is seen sets `passes` to 0 first.
  addPass() {
    const u = this.uniforms, [before, after] = this.sums;
    u.pass.value = this.passes;
    u.sumMap.value = before.texture;
    u.jitter.value.set(radicalInverse(this.passes + 1, 2) - 0.5, radicalInverse(this.passes + 1, 3) - 0.5);
    // What three.js calls an offset moves the picture's window to the right and down.
    this.camera.setViewOffset(this.width, this.height, u.jitter.value.x, -u.jitter.value.y, this.width, this.height);
    this.draw("sky", after);
    this.camera.clearViewOffset();
    u.jitter.value.set(0, 0);
    this.sums = [after, before];
    ++this.passes;
  }

  drawMean(exposure) {
    this.meanUniforms.sumMap.value = this.sums[0].texture;
    this.meanUniforms.passes.value = this.passes;
    this.meanUniforms.exposure.value = exposure;
    this.gl.setRenderTarget(null);
    this.gl.render(this.mean, this.camera);
  }

  // Four floats a pixel, bottom row first: the mean radiance and the share of the passes that met the object.
  readMean() {
    const values = new Float32Array(4 * this.width * this.height);
    this.gl.readRenderTargetPixels(this.sums[0], 0, 0, this.width, this.height, values);
    return values.map((value) => value / this.passes);
  }

  // Waits until all is drawn: reading a pixel is the only thing that no driver answers early.
  finish() {
    const gl = this.gl.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  // Four floats a pixel, bottom row first; "texel": x, y, material, triangle; "linear": radiance and 1, or 0 beside the object;
  // "figures": sigma, samples, residual, sigma of the normal, -1 for none.
  read(show, x = 0, y = 0, width = this.width, height = this.height) {
    const target = this.target(THREE.FloatType), values = new Float32Array(4 * width * height);
    target.setSize(this.width, this.height);
    this.draw(show, target);
    this.gl.readRenderTargetPixels(target, x, y, width, height, values);
    target.dispose();
    return values;
  }
}

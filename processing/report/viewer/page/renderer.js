// Draws the model: first the number of the nearest triangle of every pixel (rasterised), then every pixel's value (shade.glsl).
const kShow = { radiance: 0, normals: 1, clusters: 2, sigma: 3, samples: 4, residual: 5, normal_sigma: 6, texel: 7, linear: 8, figures: 9 };

class Renderer {
  constructor(canvas, data) {
    const context = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (context === null) throw new Error("this browser has no WebGL 2");
    this.gl = new THREE.WebGLRenderer({ canvas, context });
    this.gl.extensions.get("EXT_color_buffer_float");
    this.data = data;
    this.camera = new THREE.PerspectiveCamera();
    this.numbers = this.target(THREE.UnsignedByteType);
    this.mesh = meshTextures(data);
    this.basis = basisTexture();
    this.atlas = atlasTextures(data);
    this.lumitexels = page.samples ? new Lumitexels(data) : null;
    this.triangles = this.triangleScene();
    this.screen = this.screenScene();
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
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const { triangleMap, nodeMap, nodeCount } = this.mesh, { basisMap, colourColumn } = this.basis, { normalMap, figureMap } = this.atlas.textures;
    const values = {
      triangleMap, nodeMap, nodeCount, basisMap, colourColumn, normalMap, figureMap, weightMap: null, materialMap: null, triangleNumberMap: this.numbers.texture,
      surfaceOffset: 1e-5 * page.diagonal_m, atlasSize: new THREE.Vector2(page.atlas.width, page.atlas.height), clusterRow: 0,
      firstRow: 0, rowsPerMaterial: 0, rowCount: 0, weighted: false, texelNormals: true, shadows: true, exposure: 1, figureScale: 1, show: 0,
      eye: new THREE.Vector3(), rightward: new THREE.Vector3(), upward: new THREE.Vector3(), forward: new THREE.Vector3(),
      pictureSize: new THREE.Vector2(), focal: 1, light: new THREE.Vector3(), intensity: new THREE.Vector3(),
    };
    this.uniforms = {};
    for (const [name, value] of Object.entries(values)) this.uniforms[name] = { value };
    const vertexShader = "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }";
    const fragmentShader = "precision highp sampler2DArray;\n" + shaders["brdf.glsl"] + shaders["surface.glsl"] + shaders["shade.glsl"];
    const material = new THREE.ShaderMaterial({ vertexShader, fragmentShader, uniforms: this.uniforms, depthTest: false, depthWrite: false, blending: THREE.NoBlending });
    return this.scene(geometry, material);
  }

  setSize(width, height) {
    this.width = width;
    this.height = height;
    this.gl.setSize(width, height, false);
    this.numbers.setSize(width, height);
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
    this.uniforms.show.value = kShow[show];
    this.gl.setRenderTarget(this.numbers);
    this.gl.setClearColor(0x000000, 0);
    this.gl.clear();
    this.gl.render(this.triangles, this.camera);
    this.gl.setRenderTarget(target);
    this.gl.render(this.screen, this.camera);
    this.gl.setRenderTarget(null);
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

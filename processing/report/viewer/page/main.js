// Starts the viewer. The address may end in #measure={...}: then the page draws that one view instead and writes what it drew as text,
// for comparing it with the ray tracer; with "frames" it logs how long a picture took while the camera turned once in so many.
function base64Of(values) {
  const bytes = new Uint8Array(values.buffer);
  let text = "";
  for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
  return btoa(text);
}

function aboutCentre(point) { return new THREE.Vector3(...point.map((value, k) => value - page.centre[k])); }

function frameTime(renderer, camera, frames) {
  renderer.draw("radiance");
  renderer.finish();
  const begin = performance.now();
  for (let i = 0; i < frames; ++i) {
    renderer.setCamera({ ...camera, eye: camera.eye.clone().applyAxisAngle(camera.up, 2 * Math.PI * i / frames) });
    renderer.draw("radiance");
    renderer.finish();
  }
  return (performance.now() - begin) / frames;
}

function measure(renderer, wanted) {
  const u = renderer.uniforms, camera = { eye: aboutCentre(wanted.eye), target: aboutCentre(wanted.target), up: new THREE.Vector3(...wanted.up), fovY: wanted.fov_rad };
  renderer.setSize(wanted.width, wanted.height);
  renderer.setCamera(camera);
  u.light.value.copy(aboutCentre(wanted.light));
  u.intensity.value.set(...wanted.intensity);
  const result = { radiance: {}, texel: "" };
  for (const stage of wanted.stages) {
    renderer.setStage(stage);
    result.radiance[stage] = base64Of(renderer.read("linear"));
  }
  if (wanted.samples_at) result.samples = wanted.samples_at.map(([x, y]) => renderer.lumitexels.at(x, y, (texel) => renderer.normalOf(texel)));
  if (wanted.sky_passes) {
    u.skyTurn.value = wanted.sky_turn_rad;
    renderer.passes = 0;
    result.sky = wanted.sky_passes.map((passes) => {
      while (renderer.passes < passes) renderer.addPass();
      return base64Of(renderer.readMean());
    });
  }
  if (wanted.figures) result.figures = base64Of(renderer.read("figures"));
  result.texel = base64Of(renderer.read("texel"));
  if (wanted.frames) console.log("frame_ms=" + frameTime(renderer, camera, wanted.frames) + ";");
  const place = document.createElement("pre");
  place.id = "measured";
  place.textContent = JSON.stringify(result);
  document.body.replaceChildren(place);
}

async function start() {
  const canvas = document.getElementById("picture"), data = await allChunks();
  const renderer = new Renderer(canvas, data);
  const wanted = location.hash.startsWith("#measure=") ? JSON.parse(decodeURIComponent(location.hash.slice(9))) : null;
  if (wanted !== null) return measure(renderer, wanted);
  window.viewer = new Viewer(renderer, canvas);
}

start().catch((error) => {
  const message = document.createElement("p");
  message.className = "failed";
  message.textContent = "The viewer cannot start: " + error.message;
  document.body.replaceChildren(message);
});

// What the page carries, unpacked (packed_chunks.h says how it is written).
const page = JSON.parse(document.getElementById("description").textContent);
const shaders = JSON.parse(document.getElementById("shaders").textContent);

async function chunk(name) {
  const { type, count, differences } = page.chunks[name];
  const text = atob(document.getElementById("chunk-" + name).textContent);
  const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const Kind = { u8: Uint8Array, u16: Uint16Array, f32: Float32Array }[type];
  const values = new Kind(count), bytes = new Uint8Array(values.buffer), size = Kind.BYTES_PER_ELEMENT;
  for (let b = 0; b < size; ++b) {
    for (let i = 0; i < count; ++i) bytes[i * size + b] = planes[b * count + i];
  }
  if (differences) {
    for (let i = 1; i < count; ++i) values[i] += values[i - 1];
  }
  return values;
}

async function allChunks() {
  const names = Object.keys(page.chunks), data = {};
  const values = await Promise.all(names.map(chunk));
  names.forEach((name, i) => { data[name] = values[i]; });
  return data;
}

// IEEE half precision.
function fromHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  return exponent === 0 ? sign * fraction * 2 ** -24 : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

// Writes a unit vector, or zero for the code of none; viewer_model.h.
function fromOctahedral(a, b, out, at) {
  if (a === 65535) return;
  let x = 2 * a / 65534 - 1, y = 2 * b / 65534 - 1;
  const z = 1 - Math.abs(x) - Math.abs(y), below = Math.max(0, -z);
  x -= x < 0 ? -below : below;
  y -= y < 0 ? -below : below;
  const size = Math.hypot(x, y, z);
  out[at] = x / size;
  out[at + 1] = y / size;
  out[at + 2] = z / size;
}

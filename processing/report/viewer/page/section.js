// Unpacks the viewer's page, which packed_chunks.h packed into the report, into a frame.
document.getElementById("open-viewer").addEventListener("click", async (event) => {
  event.target.disabled = true;
  const packed = Uint8Array.from(atob(document.getElementById("chunk-viewer-page").textContent), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const frame = document.createElement("iframe");
  Object.assign(frame.style, { width: "100%", height: "80vh", border: "0" });
  frame.title = "Viewer";
  frame.srcdoc = await new Response(stream).text();
  document.getElementById("viewer-frame").replaceChildren(frame);
});

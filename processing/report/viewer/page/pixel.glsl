// What is drawn at a pixel.
void main() {
  Point p;
  bool hit = pointAt(gl_FragCoord.xy, p);
  if (show == kSky) {
    gl_FragColor = skySum(p, hit);
    return;
  }
  if (!hit) {
    gl_FragColor = show == kTexel || show == kLinear || show == kFigures ? vec4(-1.0, -1.0, -1.0, 0.0) : vec4(srgb(kBackground), 1.0);
    return;
  }
  gl_FragColor = pixel(p, texelsAround(p.texcoord));
}

// What is drawn at a pixel: a program for each of renderer.js's kShow (SHOW), because software renderers compute what a branch leaves out.
void main() {
  Point p;
  bool hit = pointAt(gl_FragCoord.xy, p);
#if SHOW == 10
  gl_FragColor = skySum(p, hit);
#else
  gl_FragColor = show == kTexel || show == kLinear || show == kFigures ? vec4(-1.0, -1.0, -1.0, 0.0) : vec4(srgb(kBackground), 1.0);
  if (hit) gl_FragColor = pixel(p, texelsAround(p.texcoord));
#endif
}

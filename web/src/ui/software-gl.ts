let known: boolean | undefined;

/** Whether WebGL is drawn by the processor here, which makes every pixel dear. */
export function softwareGl(): boolean {
  if (known !== undefined) return known;
  const gl = document.createElement("canvas").getContext("webgl");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const renderer = gl && info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  known = /swiftshader|llvmpipe|software/i.test(renderer);
  return known;
}

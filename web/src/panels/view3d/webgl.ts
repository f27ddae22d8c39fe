import { create } from "zustand";

let known: { exists: boolean; isSoftware: boolean } | undefined;

function look() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const renderer = gl && info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return { exists: Boolean(gl), isSoftware: /swiftshader|llvmpipe|software/i.test(renderer) };
}

const webgl = () => {
  known ??= look();
  return known;
};

/** Whether the processor draws WebGL here, so that every pixel costs time. */
export const softwareGl = (): boolean => webgl().isSoftware;

/** Whether the 3D page has failed to get a context, although the browser gave one before. */
export const useSceneFailed = create(() => ({ failed: false }));

/** Whether this browser can draw the 3D view. */
export function useWebgl(): boolean {
  const failed = useSceneFailed((s) => s.failed);
  return webgl().exists && !failed;
}

// One colour without light, clipped as everything is: edges, and the tint of selected faces.

import { GLSL3, ShaderMaterial, type ShaderMaterialParameters } from "three";
import { shared } from "./shading.ts";

/** A material of one colour: red, green, blue and opacity as GLSL writes them. */
export function plain(colour: string, more: ShaderMaterialParameters = {}): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: `
out vec3 vPlace;
void main() {
  vPlace = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,
    fragmentShader: `
precision highp float;
uniform vec4 plane;
in vec3 vPlace;
out vec4 colour;
void main() {
  if (dot(plane.xyz, vPlace) > plane.w) discard;
  colour = vec4(${colour});
}`,
    uniforms: { ...shared },
    transparent: true,
    ...more,
  });
}

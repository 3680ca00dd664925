// The materials: lit by a lamp at the eye, coloured as the legend says, cut by the clipping plane.

import {
  AlwaysStencilFunc, DataTexture, DoubleSide, GLSL3, GreaterDepth, InvertStencilOp, NearestFilter, RGBAFormat, ShaderMaterial,
  type ShaderMaterialParameters, UnsignedByteType, Vector3, Vector4,
} from "./three";
import { rgb } from "./colours.ts";

/** What all materials share: the clipping plane (kept: xyz . p <= w) and the pixels of a step of the patterns. */
export const shared = { plane: { value: new Vector4(0, 0, 0, 1) }, ratio: { value: 1 } };

const VERTEX = `
in vec2 texel;
in vec4 sheet;
in float owner;
out vec3 vNormal;
out vec3 vPlace;
out vec2 vTexel;
flat out vec4 vSheet;
flat out float vOwner;
void main() {
  vPlace = position;
  vSheet = sheet;
  vNormal = normalMatrix * normal;
  vTexel = texel;
  vOwner = owner;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const LIGHT = `
vec3 lit(vec3 colour, vec3 normal) {
  vec3 n = normalize(normal);
  if (!gl_FrontFacing) n = -n;
  float head = clamp(n.z, 0.0, 1.0);
  float sky = 0.5 + 0.5 * dot(n, normalize(vec3(-0.35, 0.8, 0.45)));
  return colour * (0.56 + 0.28 * head + 0.2 * sky);
}`;

// Patterns 1 to 6 as in colours.ts, in pixels of the screen: the same size whatever the zoom.
const INK = `
float ink(int pattern, vec2 p) {
  float d = p.x + p.y;
  float e = p.x - p.y;
  if (pattern == 1) return step(mod(d, 8.0), 1.9);
  if (pattern == 2) { vec2 q = mod(p, 6.0) - 3.0; return step(dot(q, q), 2.6); }
  if (pattern == 3) return max(step(mod(d, 9.0), 1.5), step(mod(e, 9.0), 1.5));
  if (pattern == 4) return step(mod(p.y, 6.0), 1.6);
  if (pattern == 5) return step(mod(p.x, 6.0), 1.6);
  if (pattern == 6) return step(mod(e, 8.0), 1.9);
  return 0.0;
}`;

// The samples about a place vote with the weights of quadratic B-splines: borders run smoothly between the samples, and at each
// sample its own colour wins, for its weight there is 9/16. Where the three neighbours nearest to a place are as its own sample
// is, that has more than half of all weight: no others are asked. The few instructions are on purpose: without a graphics card
// each is compiled while one waits.
const VOTE = `
vec4 told(vec2 at) {
  return texelFetch(colours, ivec2(clamp(at, vSheet.xy, vSheet.zw)), 0);
}
float votes(vec4 of, vec2 own, vec2 f) {
  float sum = 0.0;
  for (int i = 0; i < 9; i++) {
    vec2 step = vec2(i % 3 - 1, i / 3 - 1);
    vec2 side = 0.5 + step * f;
    vec2 weight = mix(0.75 - f * f, 0.5 * side * side, step * step);
    if (told(own + step) == of) sum += weight.x * weight.y;
  }
  return sum;
}
vec4 voted(vec2 place) {
  vec2 at = clamp(place, vSheet.xy, vSheet.zw);
  vec2 own = floor(at + 0.5);
  vec2 f = at - own;
  vec2 way = vec2(f.x < 0.0 ? -1.0 : 1.0, f.y < 0.0 ? -1.0 : 1.0);
  vec4 best = told(own);
  vec4 beside = told(own + vec2(way.x, 0.0));
  vec4 below = told(own + vec2(0.0, way.y));
  vec4 across = told(own + way);
  if (beside == best && below == best && across == best) return best;
  float most = votes(best, own, f);
  if (most >= 0.5) return best;
  for (int i = 0; i < 3; i++) {
    vec4 other = i == 0 ? beside : i == 1 ? below : across;
    float sum = votes(other, own, f);
    if (sum > most) { most = sum; best = other; }
  }
  return best;
}`;

const PART = `
precision highp float;
uniform sampler2D colours;
uniform vec3 plain;
uniform vec3 fixed_;
uniform float hot;
uniform float held;
uniform vec4 plane;
uniform float ratio;
in vec3 vNormal;
in vec3 vPlace;
in vec2 vTexel;
flat in vec4 vSheet;
flat in float vOwner;
out vec4 colour;
${LIGHT}
${INK}
${VOTE}
void main() {
  if (dot(plane.xyz, vPlace) > plane.w) discard;
  vec3 base = vOwner < 0.0 ? fixed_ : plain;
  int pattern = 0;
  bool faded = false;
  if (vTexel.x >= -0.5) {
    vec4 found = voted(vTexel);
    base = found.rgb;
    pattern = int(found.a * 255.0 + 0.5);
    if (pattern == 255) { base = plain; pattern = 0; }
    // As in part.ts.
    faded = pattern >= 64;
    pattern = pattern % 64;
  }
  float dark = ink(pattern, gl_FragCoord.xy / ratio);
  base = mix(base, base * 0.42, dark);
  vec3 seen = lit(base, vNormal);
  if (faded) seen = mix(seen, lit(vec3(0.93), vNormal), 0.78);
  if (abs(vOwner - held) < 0.25) seen = mix(seen, vec3(1.0, 0.25, 0.6), 0.12);
  if (abs(vOwner - hot) < 0.25) seen = mix(seen, vec3(1.0, 0.97, 0.75), 0.5);
  colour = vec4(seen, 1.0);
}`;

/** Of no face and no fixture. */
export const NOBODY = 1e9;

export function partMaterial(check: string, fixture: string): ShaderMaterial {
  const vector = (hex: string): Vector3 => new Vector3(...rgb(hex).map((x) => x / 255));
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: PART,
    side: DoubleSide,
    uniforms: {
      ...shared,
      colours: { value: null },
      plain: { value: vector(check) },
      fixed_: { value: vector(fixture) },
      hot: { value: NOBODY },
      held: { value: NOBODY },
    },
    // A little back, so that lines on the surface are seen whole.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

const TOOL = `
precision highp float;
uniform vec3 tint;
uniform float opacity;
in vec3 vNormal;
out vec4 colour;
${LIGHT}
void main() {
  colour = vec4(lit(tint, vNormal), opacity);
}`;

const TOOL_VERTEX = `
out vec3 vNormal;
void main() {
  vNormal = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

/** One colour without light, clipped as everything is: red, green, blue and opacity as GLSL writes them. */
export function plainMaterial(colour: string, more: ShaderMaterialParameters = {}): ShaderMaterial {
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
    ...more,
  });
}

/** What is in the way, as a mask: all of it, whether something lies before it or not. */
export function maskMaterial(): ShaderMaterial {
  return plainMaterial("1.0, 1.0, 1.0, 1.0", { depthTest: false, depthWrite: false, side: DoubleSide });
}

/** A line with a bright seam along the borders of a mask, in pixels of the screen. */
export function contourMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: `
precision highp float;
uniform sampler2D mask;
uniform float ratio;
out vec4 colour;
float at(vec2 away) {
  ivec2 most = textureSize(mask, 0) - 1;
  return texelFetch(mask, clamp(ivec2(gl_FragCoord.xy + away), ivec2(0), most), 0).r;
}
bool border(float radius) {
  float sum = 0.0;
  for (int i = 0; i < 8; i++) sum += at(radius * vec2(cos(0.7854 * float(i)), sin(0.7854 * float(i))));
  return sum > 0.5 && sum < 7.5;
}
void main() {
  if (!border(2.6 * ratio)) discard;
  colour = border(1.5 * ratio) ? vec4(0.69, 0.0, 0.37, 1.0) : vec4(1.0, 1.0, 1.0, 0.85);
}`,
    uniforms: { ...shared, mask: { value: null } },
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
}

export function toolMaterial(hex: string): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: TOOL_VERTEX,
    fragmentShader: TOOL,
    uniforms: { tint: { value: new Vector3(...rgb(hex).map((x) => x / 255)) }, opacity: { value: 1 } },
  });
}

/** A tool where something lies before it. */
export function ghostMaterial(): ShaderMaterial {
  const material = toolMaterial("#ffffff");
  material.uniforms.opacity.value = 0.3;
  material.transparent = true;
  material.depthFunc = GreaterDepth;
  material.depthWrite = false;
  return material;
}

/** Draws nothing seen: it turns a bit over for each surface behind the clipping plane, for the cap. */
export function countingMaterial(): ShaderMaterial {
  return plainMaterial("0.0, 0.0, 0.0, 0.0", {
    colorWrite: false,
    depthWrite: false,
    depthTest: false,
    side: DoubleSide,
    stencilWrite: true,
    stencilFunc: AlwaysStencilFunc,
    stencilFail: InvertStencilOp,
    stencilZFail: InvertStencilOp,
    stencilZPass: InvertStencilOp,
  });
}

export function capMaterial(hex: string): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader: `
precision highp float;
uniform vec3 tint;
uniform float ratio;
out vec4 colour;
void main() {
  vec2 p = gl_FragCoord.xy / ratio;
  float line = step(mod(p.x - p.y, 7.0), 1.1);
  colour = vec4(tint * (1.0 - 0.22 * line), 1.0);
}`,
    uniforms: { ...shared, tint: { value: new Vector3(...rgb(hex).map((x) => x / 255)) } },
    side: DoubleSide,
    stencilWrite: true,
  });
}

export function atlasTexture(width: number, height: number): DataTexture {
  const texture = new DataTexture(new Uint8Array(4 * width * height), width, height, RGBAFormat, UnsignedByteType);
  texture.magFilter = texture.minFilter = NearestFilter;
  texture.generateMipmaps = false;
  return texture;
}
